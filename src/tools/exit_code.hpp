#pragma once

#include "report/results.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// Exit codes of the tools.
enum class ExitCode {
  answered = 0,
  failed = 1,
  wrong_input = 2,     ///< one line says what is wrong
  not_to_be_used = 3,  ///< there is an answer, but it must not be relied on
  interrupted = 75,    ///< by a signal or the time limit; results so far are written (EX_TEMPFAIL of sysexits.h)
};

/// Returns not_to_be_used in the states doubtful and model_invalid.
ExitCode exit_code(const Results& results);
/// Returns not_to_be_used where the last step's verdict is unexplained.
ExitCode exit_code(const Diagnosis& diagnosis);

/// One line about the exit codes for --help.
extern const char* const exit_code_help;

}  // namespace tissue_stiffness
