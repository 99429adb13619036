#include "report/text.hpp"
#include "report/write_results.hpp"
#include "types/csv.hpp"

namespace tissue_stiffness {
namespace {

std::string header(const std::vector<ParameterEstimate>& parameters) {
  std::string line = "time [s],used,state";
  for (const ParameterEstimate& p : parameters) {
    for (const std::string part : {"mean", "std", "lower95", "upper95"}) {
      line += "," + csv_field(p.name + "." + part + " [" + p.unit + "]");
    }
  }
  return line + ",misfit_rms [m],misfit_rms [sigma],nis [-],nis_dof [-],outliers [-],reason,state_reason";
}

std::string row(const FrameRecord& frame, std::size_t parameter_count) {
  std::string line = exact_number(frame.time) + (frame.used ? ",1," : ",0,") + to_string(frame.state);
  for (std::size_t i = 0; i < parameter_count; ++i) {
    if (i >= frame.parameters.size()) {
      line += ",,,,";
      continue;
    }
    const ParameterEstimate& p = frame.parameters[i];
    for (const double value : {p.mean, p.std, p.lower95, p.upper95}) line += "," + exact_number(value);
  }
  for (const double value : {frame.misfit_rms, frame.misfit_sigma, frame.nis}) line += "," + exact_number(value);
  return line + "," + std::to_string(frame.dof) + "," + std::to_string(frame.outliers) + "," + csv_field(frame.reason) +
         "," + csv_field(frame.state_reason);
}

}  // namespace

std::string estimates_csv(const Results& results) {
  std::string text = header(results.parameters) + "\n";
  for (const FrameRecord& frame : results.frames) text += row(frame, results.parameters.size()) + "\n";
  return text;
}

}  // namespace tissue_stiffness
