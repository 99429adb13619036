#include "report/input_table.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "report/page.hpp"
#include "report/text.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTold = 0.01;  // of E: a smaller effect of an input is not worth a word

std::vector<std::pair<std::string, double>> named(const VarianceShares& shares) {
  return {{"noise", shares.noise},
          {"mesh", shares.mesh},
          {"loads and poses", shares.loads},
          {"constants", shares.constants},
          {"model", shares.model}};
}

std::string cell(const std::string& text) {
  return "<td class=\"n\">" + escape_html(text) + "</td>";
}

std::string shares_table(const Results& results) {
  if (results.variance.size() != results.parameters.size()) return "";
  std::string rows, head = "<tr><th>parameter</th>";
  for (const auto& source : named({})) head += "<th class=\"n\">" + source.first + "</th>";
  for (std::size_t i = 0; i < results.parameters.size(); ++i) {
    rows += "<tr><td>" + escape_html(results.parameters[i].name) + "</td>";
    for (const auto& source : named(results.variance[i])) rows += cell(percentage(source.second, 2));
    rows += "</tr>";
  }
  return "<div class=\"scroll\"><table class=\"stacked\">" + head + "</tr>" + rows + "</table></div>";
}

std::string errors_table(const Results& results) {
  std::string rows;
  for (const InputUncertainty& input : results.inputs) {
    const ShownUnit unit = shown_unit(std::max(std::abs(input.mean), std::abs(input.tolerance)), input.unit);
    const auto number = [&](double value) {
      return cell(short_number(unit.scale * value, 3) + (unit.name.empty() ? "" : " " + unit.name));
    };
    rows += "<tr><td>" + escape_html(input.input) + "</td><td>" + escape_html(input.error) + "</td>" +
            number(input.tolerance) + number(input.mean) + number(input.std) + cell(percentage(input.modulus_std, 2)) +
            "</tr>";
  }
  if (rows.empty()) return "";
  return "<div class=\"scroll\"><table class=\"stacked\"><tr><th>input</th><th>error</th><th class=\"n\">tolerance</th>"
         "<th class=\"n\">found</th><th class=\"n\">left</th><th class=\"n\">moves E by</th></tr>" +
         rows + "</table></div>";
}

}  // namespace

std::string inputs_line(const Results& results) {
  if (results.inputs.empty()) return "every load, pose and constant is taken as exact";
  const auto most =
      std::max_element(results.inputs.begin(), results.inputs.end(),
                       [](const InputUncertainty& a, const InputUncertainty& b) { return a.modulus_std < b.modulus_std; });
  const std::string counts =
      "the interval counts " + std::to_string(results.inputs.size()) + " errors of loads, poses and constants";
  if (!(most->modulus_std >= kTold)) return counts;
  const std::string error = most->error == "value" ? "" : "the " + most->error + " of ";
  return counts + "; E rests most on " + error + most->input + " (+-" + percentage(most->modulus_std, 2) + ")";
}

std::string variance_line(const VarianceShares& shares) {
  std::string text;
  for (const auto& [name, share] : named(shares)) {
    if (share < 0.005) continue;
    text += (text.empty() ? "" : ", ") + name + " " + percentage(share, 2);
  }
  return text;
}

std::string input_section(const Results& results) {
  return section("inputs", "Where the interval comes from",
                 "<p class=\"soft\">" + escape_html(capitalised(inputs_line(results))) + ".</p>" + shares_table(results) +
                     errors_table(results));
}

}  // namespace tissue_stiffness
