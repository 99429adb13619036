#include <algorithm>
#include <cmath>
#include <ostream>
#include <vector>

#include "report/input_table.hpp"
#include "report/page.hpp"
#include "report/text.hpp"
#include "tools/estimate_recording.hpp"
#include "tools/formatted.hpp"
#include "tools/lengths.hpp"
#include "types/plain_number.hpp"

namespace tissue_stiffness {
namespace {

double quantile(std::vector<double> values, double p) {
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(p * static_cast<double>(values.size())) - 1.0;
  return values[static_cast<std::size_t>(std::max(0.0, rank))];
}

std::string painted(EstimateState state, const Paint& paint) {
  const std::string name = to_string(state);
  if (state == EstimateState::converged) return paint.good(name);
  if (state == EstimateState::model_invalid) return paint.bad(name);
  return paint.warning(name);
}

void print_parameters(const Results& results, const Paint& paint, std::ostream& out) {
  out << paint.bold(
             formatted("%-32s %12s  %-28s %-5s %s", "parameter", "estimate", "95 % interval", "unit", "identifiable"))
      << "\n";
  for (const ParameterEstimate& p : results.parameters) {
    const ShownUnit unit = shown_unit(p.mean, p.unit);
    const ShownEstimate shown = shown_estimate(p, unit.scale);
    const std::string interval = shown.lower + " .. " + shown.upper;
    const auto verdict = results.identifiable.find(p.name);
    print_line(out, "%-32s %12s  %-28s %-5s %s", p.name.c_str(), shown.mean.c_str(), interval.c_str(), unit.name.c_str(),
               verdict == results.identifiable.end() ? "-" : verdict->second.verdict.c_str());
  }
}

void print_map(const StiffnessMap& map, std::ostream& out) {
  const auto count = static_cast<int>(map.patches.size());
  if (!map.explains()) {
    print_line(out, "map           %d patches, none to be used: the map leaves an error of %.2g of the noise", count,
               map.misfit);
  } else {
    print_line(out, "map           %d patches, %d identified, the others at their prior", count, map.identified());
  }
  for (const StiffnessPatch& patch : map.patches) {
    if (!patch.identified) continue;
    const ShownUnit unit = shown_unit(patch.young_modulus, "Pa");
    const double spread = unit.scale * patch.std * patch.young_modulus;
    const auto shown = [&](double modulus) { return rounded(unit.scale * modulus, spread); };
    print_line(out, "  at %-21s  %s %s, 95 %%: %s .. %s", (position_in_millimetres(patch.center) + " mm").c_str(),
               shown(patch.young_modulus).c_str(), unit.name.c_str(), shown(patch.lower95).c_str(),
               shown(patch.upper95).c_str());
  }
}

void print_recordings(const std::vector<RecordingRecord>& recordings, const Paint& paint, std::ostream& out) {
  std::vector<double> errors;
  errors.reserve(recordings.size());
  for (const RecordingRecord& r : recordings) errors.push_back(r.rms_error);
  const Lengths length(errors);
  const std::string error = right_aligned("error [" + length.unit() + "]", 11);
  out << paint.bold(formatted("%-32s %-10s %7s %s %9s %10s  %s", "recording", "", "frames", error.c_str(), "of noise",
                              "misfit", "agreement"))
      << "\n";
  const auto verdict = [](double z, bool passes) {
    return std::isfinite(z) ? short_number(z, 2) + (passes ? " sd" : " sd!") : std::string("-");
  };
  for (const RecordingRecord& r : recordings) {
    print_line(out, "%-32s %-10s %7d %11s %9s %10s  %s", short_path(r.name).c_str(), r.predicted ? "predicted" : "fitted",
               r.frames, length(r.rms_error).c_str(), short_number(r.rms_sigma, 3).c_str(),
               verdict(r.misfit_z, r.misfit_passes).c_str(), verdict(r.agreement_z, r.agrees).c_str());
    for (const ParameterEstimate& p : r.own) {
      const ShownUnit unit = shown_unit(std::max(std::abs(p.mean), 1.96 * p.std), p.unit);
      print_line(out, "  %-30s %s -+ %s %s", p.name.c_str(), short_number(unit.scale * p.mean, 4).c_str(),
                 short_number(unit.scale * 1.96 * p.std, 2).c_str(), unit.name.c_str());
    }
  }
}

void print_stages(const EstimationRun& run, const Paint& paint, std::ostream& out) {
  out << paint.bold(formatted("%-12s %12s %12s %12s", "stage", "median [ms]", "p99 [ms]", "total [s]")) << "\n";
  for (const char* stage : {"segment", "predict", "observe", "update", "reprocess", "studies"}) {
    const auto samples = run.stage_samples.find(stage);
    if (samples == run.stage_samples.end()) continue;
    double sum = 0.0;
    for (const double seconds : samples->second) sum += seconds;
    print_line(out, "%-12s %12.3f %12.3f %12.3f", stage, 1e3 * quantile(samples->second, 0.5),
               1e3 * quantile(samples->second, 0.99), sum);
  }
}

}  // namespace

void print_summary(const EstimationRun& run, const Paint& paint, std::ostream& out) {
  const Results& results = run.results;
  if (!results.interrupted.empty()) {
    out << paint.warning("incomplete") << "    interrupted during: " << results.interrupted << "\n";
  }
  if (results.frames.empty() && results.recordings.empty()) return;
  print_parameters(results, paint, out);
  for (std::size_t i = 0; i < results.variance.size() && i < results.parameters.size(); ++i) {
    const std::string name = results.variance.size() > 1 ? results.parameters[i].name + ": " : "";
    out << "variance from " << name << variance_line(results.variance[i]) << "\n";
  }
  out << "inputs        " << inputs_line(results) << "\n";
  out << "state         " << painted(results.state, paint) << ": " << results.state_reason << "\n";
  if (results.recordings.empty()) {
    print_line(out, "frames        %d used, %d skipped, %d late messages; %.3g frames/s", results.used(), results.skipped(),
               run.late, static_cast<double>(results.frames.size()) / run.seconds);
  }
  if (run.broken_stamps > 0) {
    out << paint.warning("left out") << "      " << run.broken_stamps << " messages with broken stamps; the last one is on "
        << run.last_broken_stamp << "\n";
  }
  if (std::isfinite(results.rms_error)) {  // forces alone have none
    print_line(out, "rms error     %s, %.3g of the noise; %.3g %% of the motion",
               with_unit(results.rms_error, "m", 4).c_str(), results.rms_error / results.noise_rms,
               100.0 * results.relative_error);
  }
  if (!results.recordings.empty()) return print_recordings(results.recordings, paint, out);
  print_line(out, "NIS           %.3g a degree of freedom, p = %.2g", results.nis_mean_per_dof, results.nis_p_value);
  if (results.map) print_map(*results.map, out);
  print_stages(run, paint, out);
}

}  // namespace tissue_stiffness
