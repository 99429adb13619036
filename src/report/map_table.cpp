#include "report/map_table.hpp"

#include <algorithm>

#include "report/page.hpp"
#include "report/text.hpp"

namespace tissue_stiffness {
namespace {

std::string words(const StiffnessMap& map) {
  const std::size_t count = map.patches.size();
  const auto identified = static_cast<std::size_t>(map.identified());
  std::string text = std::to_string(identified) + " of the body's " + std::to_string(count) + " parts are identified";
  if (!map.explains()) {
    return text + ": the map leaves an error of " + short_number(map.misfit, 2) +
           " times the noise. What it lacks is not the modulus alone, or changes within the parts.";
  }
  text += identified < count ? "; of the others the recording says nothing: they stay at their prior. " : ". ";
  const auto divided = std::count_if(map.levels.begin(), map.levels.end(), [](const auto& level) { return level.kept; });
  if (divided == 1) text += "The recording does not ask for more than one modulus. ";
  return text + "Intervals hold the noise" +
         (map.mesh_error.empty() ? " and the error of the mesh." : ", not the error of the mesh: " + map.mesh_error + ".");
}

std::string row(const StiffnessPatch& patch, bool explained) {
  const ShownUnit unit = shown_unit(patch.young_modulus, "Pa");
  const double spread = unit.scale * patch.std * patch.young_modulus;
  const auto cell = [](const std::string& text) { return "<td class=\"n\">" + escape_html(text) + "</td>"; };
  std::string place;
  for (const double x : {patch.center.x(), patch.center.y(), patch.center.z()}) place += cell(short_number(1e3 * x, 3));
  return "<tr>" + place + cell(rounded(unit.scale * patch.young_modulus, spread)) +
         cell(rounded(unit.scale * patch.lower95, spread)) + cell(rounded(unit.scale * patch.upper95, spread)) + "<td>" +
         escape_html(unit.name) + "</td><td>" +
         (patch.identified ? "<span class=\"badge good\">identified</span>"
          : explained      ? "<span class=\"badge warn\">at its prior</span>"
                           : "<span class=\"badge bad\">not to be used</span>") +
         "</td></tr>";
}

}  // namespace

std::string map_table(const StiffnessMap& map) {
  std::vector<StiffnessPatch> patches = map.patches;
  std::stable_sort(patches.begin(), patches.end(), [](const StiffnessPatch& a, const StiffnessPatch& b) {
    return a.identified != b.identified ? a.identified : a.young_modulus < b.young_modulus;
  });
  std::string rows;
  for (const StiffnessPatch& patch : patches) rows += row(patch, map.explains());
  return section(
      "map", "Stiffness from place to place",
      "<p>" + escape_html(words(map)) +
          "</p><div class=\"scroll\"><table><tr><th class=\"n\">x [mm]</th><th class=\"n\">y</th><th class=\"n\">z</th>"
          "<th class=\"n\">E</th><th class=\"n\">95 % from</th><th class=\"n\">to</th><th>unit</th><th></th></tr>" +
          rows + "</table></div>");
}

}  // namespace tissue_stiffness
