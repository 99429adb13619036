#include "tools/print_diagnosis.hpp"

#include <cmath>
#include <cstdio>
#include <ostream>
#include <string>

#include "report/write_diagnosis.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kShown = 8;  // candidates in the table

std::string line(const char* pattern, const std::string& name, double a, double b, double c, double d) {
  char text[200];
  std::snprintf(text, sizeof text, pattern, name.c_str(), a, b, c, d);
  std::string out = text;
  for (std::size_t at = out.find("nan"); at != std::string::npos; at = out.find("nan")) out.replace(at, 3, "  -");
  return out;
}

std::string painted(Verdict verdict, const Paint& paint) {
  const std::string name = to_string(verdict);
  if (verdict == Verdict::adequate) return paint.good(name);
  return verdict == Verdict::missing || verdict == Verdict::unfinished ? paint.warning(name) : paint.bad(name);
}

}  // namespace

void print_diagnosis(const Diagnosis& d, const Paint& paint, std::ostream& out) {
  if (!d.interrupted.empty()) {
    out << paint.warning("incomplete") << "    interrupted during: " << d.interrupted << "\n";
  }
  if (d.steps.empty()) return;
  out << paint.bold(diagnosis_sentence(d)) << "\nwhere         " << d.where << "\nwhen          " << d.when << "\n";
  out << line("error         %s%.3f mm rms: noise %.3f, beyond noise %.3f, of the mesh %.3f\n", "", 1e3 * d.metres.total,
              1e3 * d.metres.noise, 1e3 * d.metres.structured, 1e3 * d.metres.numerical);
  if (!d.force.words.empty()) out << "missing force " << d.force.words << "\n";
  out << paint.bold("candidate                 explains   held-out [mm]   probability         z") << "\n";
  for (std::size_t i = 0; i < d.candidates.size() && i < kShown; ++i) {
    const MissingEffect& c = d.candidates[i];
    out << line("%-24s %8.1f %%  %14.3f  %11.1f %%  %8.1f\n", c.effect, 100.0 * c.explained, 1e3 * c.held_out_rms_after,
                100.0 * c.probability, c.z);
  }
  out << paint.bold("model                     held-out [mm]   fitted [mm]   noise [mm]") << "\n";
  std::size_t known = 0;
  for (const DiagnosisStep& s : d.steps) {
    std::string name = s.effects.empty() ? "as given" : "";
    for (; known < s.effects.size(); ++known) name += (name.empty() ? "+ " : " + ") + s.effects[known];
    out << line("%-24s %14.3f  %12.3f  %11.3f%.0s\n", name, 1e3 * s.held_out_rms, 1e3 * s.train_rms, 1e3 * s.noise_floor,
                0.0);
    for (const auto& [parameter, value] : s.parameters) {
      if (is_young_modulus(parameter)) out << "  " << parameter << " = " << value / 1e3 << " kPa\n";
    }
  }
  out << "final         " << painted(d.final_verdict, paint) << "; " << std::lround(d.seconds) << " s\n";
}

}  // namespace tissue_stiffness
