#pragma once

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "report/results.hpp"
#include "types/replay.hpp"

namespace tissue_stiffness {

inline ParameterEstimate young(double mean, double std) {
  return {"elasticity.young_modulus", "Pa", mean, std, mean - 1.96 * std, mean + 1.96 * std};
}

/// A run that settles on 412 kPa, with a few frames lost.
inline Results example(int frames) {
  Results results;
  results.model = "model.yaml";
  results.recording = "recording.bag";
  results.state = EstimateState::converged;
  for (int i = 0; i < frames; ++i) {
    FrameRecord frame;
    frame.time = 1500000000.0 + 0.02 * i;
    if (i % 17 == 9) {
      frame.used = false;
      frame.reason = i % 2 ? "no contour: contrast, \"too low\" & <dark>" : "late";
    } else {
      const double std = 3e5 / (1.0 + 0.5 * i);
      frame.misfit_rms = 3e-4 * (1.0 + 0.2 * std::sin(i) + 3.0 * std::exp(-0.3 * i));
      frame.misfit_sigma = frame.misfit_rms / 3e-4;
      frame.nis = 100.0 + 10.0 * std::sin(2.0 * i);
      frame.dof = 100;
      frame.outliers = i % 3;
      results.frame_seconds.push_back(0.001 * (1 + i % 7));
      frame.parameters = {young(4.12e5 + 2e5 * std::exp(-0.2 * i), std),
                          {"mass_damping.alpha", "1/s", 2.0, std::numeric_limits<double>::quiet_NaN(), 1.0, 3.0}};
    }
    frame.state = i < 20 ? EstimateState::converging : EstimateState::converged;
    results.frames.push_back(frame);
  }
  results.parameters = {young(4.1234e5, 2.1e3), {"mass_damping.alpha", "1/s", 2.0, 0.5, 1.2, 3.1}};
  results.identifiable = {{"elasticity.young_modulus", {"absolute", "gravity is known"}},
                          {"mass_damping.alpha", {"ratio_only", "only its product with <density> matters"}}};
  results.nodes = 12;
  results.tetrahedra = 5;
  results.rms_error = 3.1e-4;
  results.noise_rms = 3e-4;
  results.relative_error = 0.021;
  results.nis_mean_per_dof = 1.02;
  results.nis_p_value = 0.4;
  results.stage_seconds = {{"predict", 1.5}, {"observe", 0.3}, {"update", 0.02}};
  results.description = {"reduced basis of 24 vectors", "step 0.005 s"};
  results.model_text = "mesh: {file: mesh.vtk}  # <b>&\"quoted\"</b>\neffects:\n- inertia: {density: 1060}\n";
  results.command_line = "estimate model.yaml recording.bag --output out";
  results.versions = {{"tissue_stiffness", "0.1.0"}, {"Eigen", "3.4.0"}};
  return results;
}

/// Two triangles over three frames, one point tracked, one outline with its picture.
inline Showing example_showing() {
  Replay replay;
  replay.name = "<the> estimate";
  replay.time = {0.0, 0.5, 1.0};
  replay.rms = {1e-4, 2e-4, std::numeric_limits<double>::quiet_NaN()};
  ReplayTrack track{"vertex 2", "m", {"x", "y", "z"}, Eigen::MatrixXd(3, 3), Eigen::MatrixXd(3, 3)};
  track.measured << 0.0, 0.01, std::numeric_limits<double>::quiet_NaN(), 1.0, 1.0, 1.0, -0.002, 0.002, 0.001;
  track.predicted = track.measured;
  replay.tracks = {track};
  replay.surface.rest.resize(3, 4);
  replay.surface.rest << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  replay.surface.triangles.resize(3, 2);
  replay.surface.triangles << 0, 0, 1, 2, 2, 3;
  replay.surface.frames = {0, 2};
  replay.surface.displacement.assign(2, Eigen::Matrix3Xd::Constant(3, 4, 0.25));
  replay.surface.error.assign(2, Eigen::VectorXd::Constant(4, 2e-4));
  replay.surface.error[1][3] = std::numeric_limits<double>::quiet_NaN();
  replay.surface.sigmas.assign(2, Eigen::VectorXd::Constant(4, 2.0));
  ReplayOutline outline{0, 0.5, 64, 48, Eigen::Matrix2Xd(2, 3), true, Eigen::Matrix4Xd(4, 1)};
  outline.measured << 1.0, 2.04, std::numeric_limits<double>::quiet_NaN(), 4.0, 5.0, 6.0;
  outline.predicted << 1.0, 2.0, 3.0, 4.0;
  replay.outlines = {outline};
  return {1500000000.0, {replay}, {{0, 1500000000.5, "jpeg"}}};
}

/// What the page's script reads.
inline nlohmann::json data_of(const std::string& page) {
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = page.find(open) + open.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

/// The page without its libraries and licences, which are not ours to judge.
inline std::string own_part(const std::string& page) {
  return page.substr(0, page.find("id=\"made\""));
}

}  // namespace tissue_stiffness
