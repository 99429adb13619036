#include "report/difference_table.hpp"

#include <vector>

#include "report/text.hpp"
#include "settings/model_difference.hpp"

namespace tissue_stiffness {
namespace {

std::string cell(const std::string& value, const std::string& kind) {
  return value.empty() ? "<td class=\"soft\">not there</td>"
                       : "<td><" + kind + ">" + escape_html(value) + "</" + kind + "></td>";
}

}  // namespace

std::string difference_table(const NamedModel& before, const NamedModel& after) {
  const std::vector<EntryDifference> all = model_difference(before.text, after.text, {before.name, after.name});
  if (all.empty()) return "<p>" + escape_html(after.name) + " says the same as " + escape_html(before.name) + ".</p>";
  std::string rows;
  for (const EntryDifference& d : all)
    rows +=
        "<tr><td><code>" + escape_html(d.entry) + "</code></td>" + cell(d.before, "del") + cell(d.after, "ins") + "</tr>";
  return "<div class=\"scroll\"><table class=\"difference stacked\"><thead><tr><th>entry</th><th>" +
         escape_html(before.name) + "</th><th>" + escape_html(after.name) + "</th></tr></thead><tbody>" + rows +
         "</tbody></table></div>";
}

}  // namespace tissue_stiffness
