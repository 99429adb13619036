#include <cmath>
#include <nlohmann/json.hpp>

#include "report/write_diagnosis.hpp"

namespace tissue_stiffness {
namespace {

using nlohmann::json;

json number(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

json numbers(const std::map<std::string, double>& values) {
  json out = json::object();
  for (const auto& [name, value] : values) out[name] = number(value);
  return out;
}

json candidate_json(const MissingEffect& c) {
  json confusable = json::array();
  for (const auto& other : c.confusable_with)
    confusable.push_back({{"effect", other.effect}, {"cosine", number(other.cosine)}});
  return {{"effect", c.effect},
          {"entry", c.entry},
          {"parameters", numbers(c.parameters)},
          {"log_bayes_factor", number(c.log_bayes_factor)},
          {"p_value", number(c.p_value)},
          {"size", number(c.size)},
          {"explained", number(c.explained)},
          {"probability", number(c.probability)},
          {"z", number(c.z)},
          {"held_out_rms_before", number(c.held_out_rms_before)},
          {"held_out_rms_after", number(c.held_out_rms_after)},
          {"confusable_with", confusable}};
}

json numbers(const std::vector<double>& values) {
  json out = json::array();
  for (const double value : values) out.push_back(number(value));
  return out;
}

json parts_json(const ErrorParts& parts) {
  return {{"total", number(parts.total)},
          {"noise", number(parts.noise)},
          {"numerical", number(parts.numerical)},
          {"structured", number(parts.structured)}};
}

json residual_json(const ResidualViews& r) {
  return {
      {"time", numbers(r.time)},           {"frame_rms", numbers(r.frame_rms)}, {"nodes", r.nodes},
      {"node_rms", numbers(r.node_rms)},   {"amplitude", numbers(r.amplitude)}, {"amplitude_rms", numbers(r.amplitude_rms)},
      {"frequency", numbers(r.frequency)}, {"power", numbers(r.power)},         {"phase", numbers(r.phase)},
      {"phase_rms", numbers(r.phase_rms)}};
}

json belief_json(const BeliefMap& b) {
  json centres = json::array(), probability = json::array();
  for (Eigen::Index p = 0; p < b.centres.cols(); ++p) {
    centres.push_back({number(b.centres(0, p)), number(b.centres(1, p)), number(b.centres(2, p))});
    probability.push_back({number(b.probability(p, 0)), number(b.probability(p, 1)), number(b.probability(p, 2))});
  }
  return {{"nodes", b.nodes}, {"parts", b.parts}, {"centres", centres}, {"probability", probability}};
}

json force_json(const MissingForce& f) {
  if (f.time.empty()) return nullptr;
  json total = json::array();
  for (const Eigen::Vector3d& v : f.total) total.push_back({number(v.x()), number(v.y()), number(v.z())});
  Eigen::VectorXd square = Eigen::VectorXd::Zero(f.places.cols());
  for (const Eigen::Matrix3Xd& at : f.at_nodes) square += at.colwise().squaredNorm().transpose();
  const Eigen::VectorXd rms = (square / static_cast<double>(f.at_nodes.size())).cwiseSqrt();
  return {{"words", f.words},
          {"parameters", numbers(f.parameters)},
          {"explained", number(f.explained)},
          {"follows", numbers(f.follows)},
          {"time", numbers(f.time)},
          {"total", total},
          {"nodes", f.nodes},
          {"node_rms", numbers(std::vector<double>(rms.data(), rms.data() + rms.size()))}};
}

json rival_json(const RivalExplanation& rival) {
  return {{"effect", rival.effect},
          {"probability", number(rival.probability)},
          {"modulus_ratio", numbers(rival.modulus_ratio)}};
}

}  // namespace

std::string diagnosis_json(const Diagnosis& d) {
  json final = {{"verdict", to_string(d.final_verdict)}, {"effects", d.final_effects}};
  if (d.estimate.state != EstimateState::no_data) final["state"] = to_string(d.estimate.state);
  for (const ParameterEstimate& p : d.estimate.parameters) {
    final["parameters"][p.name] = {
        {"unit", p.unit}, {"mean", number(p.mean)}, {"interval95", {number(p.lower95), number(p.upper95)}}};
  }
  for (const std::vector<RivalExplanation>& addition : d.rivals) {
    for (const RivalExplanation& rival : addition) final["rivals"].push_back(rival_json(rival));
  }
  for (const RivalExplanation& trace : d.traces) final["traces"].push_back(rival_json(trace));
  json candidates = json::array(), steps = json::array();
  for (const MissingEffect& c : d.candidates) candidates.push_back(candidate_json(c));
  for (const DiagnosisStep& s : d.steps) {
    steps.push_back({{"effects", s.effects},
                     {"parameters", numbers(s.parameters)},
                     {"train_rms", number(s.train_rms)},
                     {"held_out_rms", number(s.held_out_rms)},
                     {"log_bayes_factor", number(s.log_bayes_factor)},
                     {"noise_floor", number(s.noise_floor)}});
  }
  json root = {{"complete", d.interrupted.empty()},
               {"verdict", to_string(d.verdict)},
               {"set", d.set},
               {"probability_adequate", number(d.adequate)},
               {"none_of_these", number(d.none_of_these)},
               {"z", number(d.z)},
               {"best",
                {{"effects", d.best.effects},
                 {"explained", number(d.best.explained)},
                 {"held_out_rms", number(d.best.held_out_rms)}}},
               {"candidates", candidates},
               {"where", d.where},
               {"when", d.when},
               {"how_much", {{"metres", parts_json(d.metres)}, {"sigmas", parts_json(d.sigmas)}}},
               {"residual", residual_json(d.residual)},
               {"valid", {{"given", belief_json(d.valid_given)}, {"final", belief_json(d.valid_final)}}},
               {"missing_force", force_json(d.force)},
               {"steps", steps},
               {"next_experiment", d.next_experiment},
               {"final", final},
               {"seconds", number(d.seconds)}};
  if (!d.left_out.empty()) root["left_out"] = d.left_out;
  if (!d.failure.empty()) root["failure"] = d.failure;
  if (!d.interrupted.empty()) root["interrupted_during"] = d.interrupted;
  return root.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace tissue_stiffness
