// How a run's end is told: what is kept when it is interrupted, and the exit codes.
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "report/write_results.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/estimate_recording.hpp"
#include "tools/exit_code.hpp"
#include "tools/simulate_scene.hpp"
#include "workbench.hpp"

namespace tissue_stiffness {
namespace {

TEST(StopRequest, IsMadeAtOnceOrByATimeLimit) {
  StopRequest at_once, late, soon;
  EXPECT_NO_THROW(at_once.check());
  at_once.stop();
  EXPECT_THROW(at_once.check(), Interrupted);
  late.end_after(1e6);
  EXPECT_FALSE(late.stopped());
  soon.end_after(0.01);
  const auto begin = std::chrono::steady_clock::now();
  while (!soon.stopped()) std::this_thread::yield();
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(9));
  EXPECT_THROW(soon.check(), Interrupted);
}

TEST(ExitCode, OfEveryState) {
  Results results;
  for (const auto& [state, code] : {std::pair{EstimateState::no_data, ExitCode::answered},
                                    {EstimateState::converging, ExitCode::answered},
                                    {EstimateState::converged, ExitCode::answered},
                                    {EstimateState::doubtful, ExitCode::not_to_be_used},
                                    {EstimateState::drifting, ExitCode::answered},
                                    {EstimateState::stale, ExitCode::answered},
                                    {EstimateState::model_invalid, ExitCode::not_to_be_used}}) {
    results.state = state;
    EXPECT_EQ(exit_code(results), code) << to_string(state);
  }
  results.interrupted = "frame 2 of 3";
  EXPECT_EQ(exit_code(results), ExitCode::interrupted);
}

TEST(ExitCode, OfEveryVerdict) {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::unexplained;  // of the given model; what counts is what became of it
  for (const auto& [verdict, code] : {std::pair{Verdict::adequate, ExitCode::answered},
                                      {Verdict::missing, ExitCode::answered},
                                      {Verdict::numerics, ExitCode::answered},
                                      {Verdict::unexplained, ExitCode::not_to_be_used}}) {
    diagnosis.final_verdict = verdict;
    EXPECT_EQ(exit_code(diagnosis), code) << to_string(verdict);
  }
  diagnosis.interrupted = "refit with added_mass";
  EXPECT_EQ(exit_code(diagnosis), ExitCode::interrupted);
}

TEST(ExitCode, IsWhatTheDocumentsSay) {
  EXPECT_EQ(static_cast<int>(ExitCode::answered), 0);
  EXPECT_EQ(static_cast<int>(ExitCode::wrong_input), 2);
  EXPECT_EQ(static_cast<int>(ExitCode::not_to_be_used), 3);
  EXPECT_EQ(static_cast<int>(ExitCode::interrupted), 75);
}

class InterruptedEstimate : public Workbench {
 protected:
  void SetUp() override {
    Workbench::SetUp();
    const std::string scene =
        write_model("scene.yaml", "4e5", vertices(), "simulation: {duration: 0.2, rate: 60, step: 0.001}\n");
    simulate_scene(load_scene(scene), path("recording.bag"), [](std::size_t, std::size_t) {});
    model_ = write_model("model.yaml", "{prior: 8e5, factor: 3}", vertices());
  }

  /// Interrupted after so many frames.
  EstimationRun run(std::size_t frames) {
    StopRequest stop;
    if (frames == 0) stop.stop();
    return estimate_recording(
        load_model(model_), path("recording.bag"), 0,
        [&](std::size_t done, std::size_t) {
          if (done == frames) stop.stop();
        },
        stop);
  }

  std::string model_;
};

TEST_F(InterruptedEstimate, IsThatOfTheFramesSoFar) {
  const Results results = run(5).results;
  EXPECT_EQ(results.interrupted, "frame 6 of 12");
  EXPECT_EQ(results.frames.size(), 5U);
  ASSERT_EQ(results.parameters.size(), 1U);
  EXPECT_EQ(results.parameters[0].mean, results.frames.back().parameters.at(0).mean);
  EXPECT_TRUE(std::isnan(results.rms_error)) << "no run more when time is up";
  const auto root = nlohmann::json::parse(results_json(results));
  EXPECT_EQ(root.at("complete"), false);
  EXPECT_EQ(root.at("interrupted_during"), "frame 6 of 12");
}

TEST_F(InterruptedEstimate, OrOfThePrior) {
  const Results results = run(0).results;
  EXPECT_EQ(results.interrupted, "frame 1 of 12");
  EXPECT_EQ(results.state, EstimateState::no_data);
  EXPECT_NO_THROW(nlohmann::json::parse(results_json(results)));
}

TEST_F(InterruptedEstimate, AfterTheLastFrameLacksTheRunsAtTheEnd) {
  const Results results = run(12).results;
  EXPECT_FALSE(results.interrupted.empty());
  EXPECT_EQ(results.frames.size(), 12U);
  const Results whole = run(99).results;
  EXPECT_EQ(nlohmann::json::parse(results_json(whole)).at("complete"), true);
  EXPECT_EQ(whole.parameters[0].mean, results.parameters.at(0).mean);
}

}  // namespace
}  // namespace tissue_stiffness
