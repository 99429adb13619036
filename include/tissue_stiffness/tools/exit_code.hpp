#pragma once

#include "tissue_stiffness/report/results.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// What a tool tells the shell.
enum class ExitCode {
  answered = 0,
  failed = 1,
  wrong_input = 2,     ///< one line says what is wrong
  not_to_be_used = 3,  ///< answered, but nobody should rely on it
  interrupted = 75,    ///< by a signal or the time limit; what was known is written (EX_TEMPFAIL of sysexits.h)
};

/// not_to_be_used in the states doubtful and model_invalid.
ExitCode exit_code(const Results& results);
/// not_to_be_used where the last step's verdict is unexplained.
ExitCode exit_code(const Diagnosis& diagnosis);

/// A line about them for --help.
extern const char* const exit_code_help;

}  // namespace tissue_stiffness
