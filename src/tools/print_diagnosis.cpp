#include "tools/print_diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "report/text.hpp"
#include "report/write_diagnosis.hpp"
#include "tools/formatted.hpp"
#include "tools/lengths.hpp"
#include "types/plain_number.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kShown = 8;  // candidates in the table

std::string painted(Verdict verdict, const Paint& paint) {
  const std::string name = to_string(verdict);
  if (verdict == Verdict::adequate) return paint.good(name);
  return verdict == Verdict::missing || verdict == Verdict::unfinished ? paint.warning(name) : paint.bad(name);
}

void print_error(const ErrorParts& metres, std::ostream& out) {
  const Lengths length({metres.total, metres.noise, metres.structured, metres.numerical});
  out << "error         " << length(metres.total) << " " << length.unit() << " rms: noise " << length(metres.noise)
      << ", beyond noise " << length(metres.structured) << ", of the mesh " << length(metres.numerical) << "\n";
}

void print_candidates(const std::vector<MissingEffect>& candidates, const Paint& paint, std::ostream& out) {
  const std::size_t count = std::min(candidates.size(), kShown);
  std::vector<double> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back(candidates[i].held_out_rms_after);
  const Lengths held_out(all);
  out << paint.bold("candidate                 explains " + right_aligned("held-out [" + held_out.unit() + "]", 15) +
                    "   probability         z")
      << "\n";
  for (std::size_t i = 0; i < count; ++i) {
    const MissingEffect& c = candidates[i];
    print_line(out, "%-24s %8s %%  %14s  %11s %%  %8s", c.effect.c_str(), fixed_number(100.0 * c.explained, 1).c_str(),
               held_out(c.held_out_rms_after).c_str(), fixed_number(100.0 * c.probability, 1).c_str(),
               fixed_number(c.z, 1).c_str());
  }
}

void print_steps(const std::vector<DiagnosisStep>& steps, const Paint& paint, std::ostream& out) {
  std::vector<double> all;
  for (const DiagnosisStep& s : steps) all.insert(all.end(), {s.held_out_rms, s.train_rms, s.noise_floor});
  const Lengths length(all);
  const std::string unit = " [" + length.unit() + "]";
  out << paint.bold("model                    " + right_aligned("held-out" + unit, 14) +
                    right_aligned("fitted" + unit, 14) + right_aligned("noise" + unit, 13))
      << "\n";
  std::size_t known = 0;
  for (const DiagnosisStep& s : steps) {
    std::string name = s.effects.empty() ? "as given" : "";
    for (; known < s.effects.size(); ++known) name += (name.empty() ? "+ " : " + ") + s.effects[known];
    print_line(out, "%-24s %14s  %12s  %11s", name.c_str(), length(s.held_out_rms).c_str(), length(s.train_rms).c_str(),
               length(s.noise_floor).c_str());
    for (const auto& [parameter, value] : s.parameters) {
      if (is_young_modulus(parameter)) out << "  " << parameter << " = " << with_unit(value, "Pa", 4) << "\n";
    }
  }
}

}  // namespace

void print_diagnosis(const Diagnosis& d, const Paint& paint, std::ostream& out) {
  if (!d.interrupted.empty()) {
    out << paint.warning("incomplete") << "    interrupted during: " << d.interrupted << "\n";
  }
  if (d.steps.empty()) return;
  out << paint.bold(diagnosis_sentence(d)) << "\nwhere         " << d.where << "\nwhen          " << d.when << "\n";
  print_error(d.metres, out);
  if (!d.force.words.empty()) out << "missing force " << d.force.words << "\n";
  print_candidates(d.candidates, paint, out);
  print_steps(d.steps, paint, out);
  out << "final         " << painted(d.final_verdict, paint) << "; " << std::lround(d.seconds) << " s\n";
}

}  // namespace tissue_stiffness
