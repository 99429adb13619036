#include <cmath>

#include "report/page.hpp"
#include "report/text.hpp"
#include "report/write_results.hpp"

namespace tissue_stiffness {
namespace {

std::string cell(double value, int digits) {
  return "<td class=\"n\">" + (std::isfinite(value) ? escape_html(short_number(value, digits)) : "-") + "</td>";
}

std::string verdict(double z, bool passes) {
  if (!std::isfinite(z)) return "<td>not tested</td>";
  return std::string("<td><span class=\"badge ") + (passes ? "good\">passes" : "warn\">fails") + "</span> " +
         escape_html(test_statistic(z)) + " sd</td>";
}

std::string row(const RecordingRecord& r) {
  return "<tr><td>" + escape_html(short_path(r.name)) + "</td><td>" + (r.predicted ? "predicted" : "fitted") + "</td>" +
         cell(r.frames, 6) + cell(1e3 * r.rms_error, 3) + cell(r.rms_sigma, 3) + cell(100.0 * r.relative_error, 3) +
         verdict(r.misfit_z, r.misfit_passes) + verdict(r.agreement_z, r.agrees) + "</tr>";
}

}  // namespace

std::string recordings_table(const std::vector<RecordingRecord>& recordings) {
  if (recordings.empty()) return "";
  std::string rows;
  for (const RecordingRecord& r : recordings) rows += row(r);
  return section(
      "recordings", "Recordings of one body",
      "<div class=\"scroll\"><table class=\"stacked\"><tr><th>recording</th><th></th><th class=\"n\">frames</th><th "
      "class=\"n\">error [mm]</th><th class=\"n\">of the noise</th><th class=\"n\">% of the motion</th>"
      "<th>misfit is noise</th><th>agrees with the others</th></tr>" +
          rows + "</table></div>");
}

}  // namespace tissue_stiffness
