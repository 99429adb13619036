#pragma once

#include <string>

#include "tissue_stiffness/report/results.hpp"
#include "tissue_stiffness/types/replay.hpp"

namespace tissue_stiffness {

/// `results.json`: complete, interrupted_during (where it is not),
/// parameters.{effect.parameter}.{unit,mean,std,interval95}, identifiable.{...}.{verdict,reason}, state, map (where there
/// is one).{levels[].{patches,mean_square,log_evidence,kept},
/// patches[].{center,young_modulus,interval95,identified},identified,mesh_error}, frames (used), skipped[].{time,reason},
/// rms_error [m], noise_rms [m], relative_error, nis.{mean_per_dof,p_value}, seconds_per_frame.{median,p99}. A number that
/// does not exist is null. Everything but seconds_per_frame is the same for the same input.
std::string results_json(const Results& results);

/// `estimates.csv` (RFC 4180): a header with units, then one row a frame. A number that does not exist is an empty field.
/// The same for the same input.
std::string estimates_csv(const Results& results);

/// `report.html`: one page that needs no network; light and dark, from phone to paper. What it says holds without scripts,
/// which draw and move.
std::string report_html(const Results& results, const Showing& showing);

/// Makes the folder when it is missing and writes the three files, each whole, results.json last. Throws InputError when
/// one cannot be written.
void write_results(const Results& results, const Showing& showing, const std::string& directory);

/// Makes the folder when it is missing. Throws InputError when it cannot.
void make_folder(const std::string& directory);

/// As write_file does.
void write_text(const std::string& file, const std::string& text);

}  // namespace tissue_stiffness
