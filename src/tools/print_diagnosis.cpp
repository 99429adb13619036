#include "tools/print_diagnosis.hpp"

#include <cmath>
#include <ostream>
#include <string>

#include "report/text.hpp"
#include "report/write_diagnosis.hpp"
#include "tools/formatted.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kShown = 8;  // candidates in the table

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
  const auto mm = [](double metres) { return fixed_number(1e3 * metres, 3); };
  out << "error         " << mm(d.metres.total) << " mm rms: noise " << mm(d.metres.noise) << ", beyond noise "
      << mm(d.metres.structured) << ", of the mesh " << mm(d.metres.numerical) << "\n";
  if (!d.force.words.empty()) out << "missing force " << d.force.words << "\n";
  out << paint.bold("candidate                 explains   held-out [mm]   probability         z") << "\n";
  for (std::size_t i = 0; i < d.candidates.size() && i < kShown; ++i) {
    const MissingEffect& c = d.candidates[i];
    print_line(out, "%-24s %8s %%  %14s  %11s %%  %8s", c.effect.c_str(), fixed_number(100.0 * c.explained, 1).c_str(),
               mm(c.held_out_rms_after).c_str(), fixed_number(100.0 * c.probability, 1).c_str(),
               fixed_number(c.z, 1).c_str());
  }
  out << paint.bold("model                     held-out [mm]   fitted [mm]   noise [mm]") << "\n";
  std::size_t known = 0;
  for (const DiagnosisStep& s : d.steps) {
    std::string name = s.effects.empty() ? "as given" : "";
    for (; known < s.effects.size(); ++known) name += (name.empty() ? "+ " : " + ") + s.effects[known];
    print_line(out, "%-24s %14s  %12s  %11s", name.c_str(), mm(s.held_out_rms).c_str(), mm(s.train_rms).c_str(),
               mm(s.noise_floor).c_str());
    for (const auto& [parameter, value] : s.parameters) {
      if (is_young_modulus(parameter)) out << "  " << parameter << " = " << value / 1e3 << " kPa\n";
    }
  }
  out << "final         " << painted(d.final_verdict, paint) << "; " << std::lround(d.seconds) << " s\n";
}

}  // namespace tissue_stiffness
