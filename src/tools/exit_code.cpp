#include "tools/exit_code.hpp"

namespace tissue_stiffness {

ExitCode exit_code(const Results& results) {
  if (!results.interrupted.empty()) return ExitCode::interrupted;
  const bool refused = results.state == EstimateState::doubtful || results.state == EstimateState::model_invalid;
  return refused ? ExitCode::not_to_be_used : ExitCode::answered;
}

ExitCode exit_code(const Diagnosis& diagnosis) {
  if (!diagnosis.interrupted.empty()) return ExitCode::interrupted;
  return diagnosis.final_verdict == Verdict::unexplained ? ExitCode::not_to_be_used : ExitCode::answered;
}

const char* const exit_code_help =
    "Exit codes: 0 answered; 2 wrong input; 3 answered, but not to be used (state doubtful or model_invalid, verdict "
    "unexplained); 75 interrupted (SIGINT, SIGTERM, --time-limit), what is known by then is written as complete: false.";

}  // namespace tissue_stiffness
