#include <cmath>
#include <nlohmann/json.hpp>

#include "report/input_table.hpp"
#include "report/write_results.hpp"

namespace tissue_stiffness {
namespace {

using nlohmann::json;

json number(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

json parameter_json(const ParameterEstimate& p) {
  return {{"unit", p.unit},
          {"mean", number(p.mean)},
          {"std", number(p.std)},
          {"interval95", json::array({number(p.lower95), number(p.upper95)})}};
}

json shares_json(const VarianceShares& s) {
  return {{"noise", number(s.noise)},
          {"mesh", number(s.mesh)},
          {"loads", number(s.loads)},
          {"constants", number(s.constants)},
          {"model", number(s.model)}};
}

json inputs_json(const std::vector<InputUncertainty>& inputs) {
  json out = json::array();
  for (const InputUncertainty& i : inputs) {
    out.push_back({{"input", i.input},
                   {"error", i.error},
                   {"unit", i.unit},
                   {"tolerance", number(i.tolerance)},
                   {"found", number(i.mean)},
                   {"left", number(i.std)},
                   {"modulus_std", number(i.modulus_std)}});
  }
  return out;
}

json recordings_json(const std::vector<RecordingRecord>& recordings) {
  const auto parameters = [](const std::vector<ParameterEstimate>& all) {
    json out = json::object();
    for (const ParameterEstimate& p : all) out[p.name] = parameter_json(p);
    return out;
  };
  json out = json::array();
  for (const RecordingRecord& r : recordings) {
    json one = {{"recording", r.name},
                {"predicted", r.predicted},
                {"frames", r.frames},
                {"parameters", parameters(r.own)},
                {"rms_error", number(r.rms_error)},
                {"noise_rms", number(r.noise_rms)},
                {"rms_sigma", number(r.rms_sigma)},
                {"relative_error", number(r.relative_error)}};
    if (!r.predicted) one["alone"] = {{"state", to_string(r.state_alone)}, {"parameters", parameters(r.alone)}};
    if (std::isfinite(r.misfit_z)) one["misfit"] = {{"z", r.misfit_z}, {"passes", r.misfit_passes}};
    if (std::isfinite(r.agreement_z))
      one["agreement"] = {{"z", r.agreement_z}, {"dof", r.agreement_dof}, {"passes", r.agrees}};
    out.push_back(one);
  }
  return out;
}

json map_json(const StiffnessMap& map) {
  json levels = json::array(), patches = json::array();
  for (const StiffnessLevel& level : map.levels) {
    levels.push_back({{"patches", level.patches},
                      {"mean_square", number(level.mean_square)},
                      {"log_evidence", number(level.log_evidence)},
                      {"kept", level.kept}});
  }
  for (const StiffnessPatch& patch : map.patches) {
    patches.push_back({{"center", {patch.center.x(), patch.center.y(), patch.center.z()}},
                       {"young_modulus", number(patch.young_modulus)},
                       {"interval95", {number(patch.lower95), number(patch.upper95)}},
                       {"identified", patch.identified}});
  }
  return {{"levels", levels},
          {"patches", patches},
          {"identified", map.identified()},
          {"misfit", number(map.misfit)},
          {"mesh_error", map.mesh_error.empty() ? "assessed" : "not assessed: " + map.mesh_error}};
}

}  // namespace

std::string results_json(const Results& results) {
  json parameters = json::object(), identifiable = json::object(), versions = json::object();
  for (std::size_t i = 0; i < results.parameters.size(); ++i) {
    const ParameterEstimate& p = results.parameters[i];
    parameters[p.name] = parameter_json(p);
    if (i < results.variance.size()) parameters[p.name]["variance_from"] = shares_json(results.variance[i]);
  }
  for (const auto& [name, record] : results.identifiable) {
    identifiable[name] = {{"verdict", record.verdict}, {"reason", record.reason}};
  }
  for (const auto& [name, version] : results.versions) versions[name] = version;
  json skipped = json::array();
  for (const FrameRecord& frame : results.frames) {
    if (!frame.used) skipped.push_back({{"time", number(frame.time)}, {"reason", frame.reason}});
  }
  json root = {
      {"complete", results.interrupted.empty()},
      {"model", results.model},
      {"model_text", results.model_text},
      {"mesh", {{"nodes", results.nodes}, {"tetrahedra", results.tetrahedra}}},
      {"recording", results.recording},
      {"state", to_string(results.state)},
      {"state_reason", results.state_reason},
      {"parameters", parameters},
      {"inputs", inputs_json(results.inputs)},
      {"inputs_summary", inputs_line(results)},
      {"identifiable", identifiable},
      {"frames", results.used()},
      {"skipped", skipped},
      {"rms_error", number(results.rms_error)},
      {"noise_rms", number(results.noise_rms)},
      {"relative_error", number(results.relative_error)},
      {"basis_error", number(results.basis_error)},
      {"nis", {{"mean_per_dof", number(results.nis_mean_per_dof)}, {"p_value", number(results.nis_p_value)}}},
      {"seconds_per_frame",
       {{"median", number(results.frame_seconds_quantile(0.5))}, {"p99", number(results.frame_seconds_quantile(0.99))}}},
      {"versions", versions},
  };
  if (!results.interrupted.empty()) root["interrupted_during"] = results.interrupted;
  if (!results.recordings.empty()) root["recordings"] = recordings_json(results.recordings);
  if (results.map) root["map"] = map_json(*results.map);
  return root.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace tissue_stiffness
