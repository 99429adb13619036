#include "report/failure.hpp"

#include <cmath>

#include "report/effect_words.hpp"
#include "report/page.hpp"
#include "report/text.hpp"
#include "types/plain_number.hpp"

namespace tissue_stiffness {
namespace {

std::string part(const std::string& name, double metres, double sigmas) {
  return "<div><dt>" + name + "</dt><dd>" + millimetres(metres) + "<small>" + escape_html(short_number(sigmas, 3)) +
         " sigma</small></dd></div>";
}

std::string paragraph(const std::string& title, const std::string& text) {
  return "<p><b>" + title + ":</b> " + escape_html(text) + ".</p>";
}

std::string force_paragraph(const MissingForce& force) {
  if (force.time.empty()) return "";
  return paragraph("Missing force", force.words + ". With the best fit of E, " + shown_moduli(force.parameters) +
                                        ", it explains " + percentage(force.explained, 3) + " of the squared error");
}

std::string belief_rows(const BeliefMap& b) {
  std::string rows;
  for (Eigen::Index p = 0; p < b.centres.cols(); ++p) {
    rows += "<tr><td>" + position_in_millimetres(b.centres.col(p)) + "</td>";
    for (Eigen::Index third = 0; third < 3; ++third) {
      const double valid = b.probability(p, third);
      rows += "<td class=\"n\" style=\"background:rgba(213,94,0," + short_number(0.6 * (1.0 - valid), 2) + ")\">" +
              escape_html(percentage(valid, 2)) + "</td>";
    }
    rows += "</tr>";
  }
  return rows;
}

std::string belief_table(const std::string& model, const BeliefMap& b) {
  if (b.nodes.empty()) return "";
  return "<table><caption>" + escape_html(model) +
         "</caption><tr><th>part around [mm]</th><th class=\"n\">first third</th><th class=\"n\">second</th><th "
         "class=\"n\">last</th></tr>" +
         belief_rows(b) + "</table>";
}

}  // namespace

std::string failure(const Diagnosis& d) {
  if (d.steps.empty()) return "";
  const ErrorParts &m = d.metres, &s = d.sigmas;
  return section("fails", "Where and when the given model fails",
                 "<dl class=\"facts\">" + part("Error, rms", m.total, s.total) + part("of it noise", m.noise, s.noise) +
                     part("beyond noise", m.structured, s.structured) + part("of the mesh", m.numerical, s.numerical) +
                     "</dl>" + paragraph("Where", d.where) + paragraph("When", d.when) + force_paragraph(d.force) +
                     chart_place("residual-time") + "<div class=\"grid\">" + chart_place("residual-node") +
                     chart_place("residual-amplitude") + chart_place("residual-frequency") + chart_place("residual-phase") +
                     "</div>");
}

std::string validity(const Diagnosis& d) {
  if (d.valid_given.nodes.empty()) return "";
  const std::string last =
      d.final_effects.empty() ? "" : belief_table("With " + effect_list(d.final_effects), d.valid_final);
  return section("valid", "",
                 "<details><summary>Where and when the model is valid</summary><p>This is the probability that a part's "
                 "error, in a third of the recording, is noise or the mesh's.</p><div class=\"scroll grid\">" +
                     belief_table("The given model", d.valid_given) + last + "</div></details>");
}

}  // namespace tissue_stiffness
