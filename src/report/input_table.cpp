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

std::string percent(double share) {
  return short_number(100.0 * share, 2) + " %";
}

std::string shares_table(const Results& results) {
  if (results.variance.size() != results.parameters.size()) return "";
  std::string rows, head = "<tr><th>parameter</th>";
  for (const auto& source : named({})) head += "<th class=\"n\">" + source.first + "</th>";
  for (std::size_t i = 0; i < results.parameters.size(); ++i) {
    rows += "<tr><td>" + escape_html(results.parameters[i].name) + "</td>";
    for (const auto& source : named(results.variance[i])) rows += cell(percent(source.second));
    rows += "</tr>";
  }
  return "<div class=\"scroll\"><table>" + head + "</tr>" + rows + "</table></div>";
}

std::string errors_table(const Results& results) {
  std::string rows;
  for (const InputUncertainty& input : results.inputs) {
    const std::string unit = input.unit == "-" || input.unit.empty() ? "" : " " + input.unit;
    rows += "<tr><td>" + escape_html(input.input) + "</td><td>" + escape_html(input.error) + "</td>" +
            cell(short_number(input.tolerance, 3) + unit) + cell(short_number(input.mean, 3) + unit) +
            cell(short_number(input.std, 3) + unit) + cell(percent(input.modulus_std)) + "</tr>";
  }
  if (rows.empty()) return "";
  return "<div class=\"scroll\"><table><tr><th>input</th><th>error</th><th class=\"n\">tolerance</th>"
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
  return counts + "; E rests most on " + error + most->input + " (+-" + percent(most->modulus_std) + ")";
}

std::string variance_line(const VarianceShares& shares) {
  std::string text;
  for (const auto& [name, share] : named(shares)) {
    if (share < 0.005) continue;
    text += (text.empty() ? "" : ", ") + name + " " + percent(share);
  }
  return text;
}

std::string input_section(const Results& results) {
  return section(
      "inputs", "Where the interval comes from",
      "<p class=\"soft\">" + escape_html(inputs_line(results)) + ".</p>" + shares_table(results) + errors_table(results));
}

}  // namespace tissue_stiffness
