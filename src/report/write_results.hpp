#pragma once

#include <string>

#include "report/results.hpp"
#include "types/replay.hpp"

namespace tissue_stiffness {

/// Returns `results.json`: complete, interrupted_during (if it is not complete), model and recording (their files),
/// model_text (content of the model file), mesh.{nodes,tetrahedra},
/// parameters.{effect.parameter}.{unit,mean,std,interval95}, identifiable.{...}.{verdict,reason}, state, map (if there is
/// one).{levels[].{patches,mean_square,log_evidence,kept},
/// patches[].{center,young_modulus,interval95,identified},identified,mesh_error}, frames (used), skipped[].{time,reason},
/// rms_error [m], noise_rms [m], relative_error, nis.{mean_per_dof,p_value}, seconds_per_frame.{median,p99}. Of several
/// recordings there is recordings[].{recording,predicted,frames,parameters (its own),rms_error,noise_rms,rms_sigma,
/// relative_error,alone.{state,parameters},misfit.{z,passes},agreement.{z,dof,passes}}. A number that does not exist is
/// null. Everything except seconds_per_frame depends only on the input.
std::string results_json(const Results& results);

/// Returns `estimates.csv` (RFC 4180): a header with units, then one row for each frame. A number that does not exist is an
/// empty field. The text depends only on the input.
std::string estimates_csv(const Results& results);

/// Returns `report.html`, one page that needs no network. It suits light and dark displays, from a phone to paper. Its text
/// is complete without scripts, which draw and animate.
std::string report_html(const Results& results, const Showing& showing);

/// Returns the report's table of several recordings; empty when there is one.
std::string recordings_table(const std::vector<RecordingRecord>& recordings);

/// Writes the three files, but no `estimates.csv` of several recordings, each completely or not at all, with results.json
/// last. Makes the folder when it is missing. Throws InputError when a file cannot be written.
void write_results(const Results& results, const Showing& showing, const std::string& directory);

/// Makes the folder when it is missing. Throws InputError when that is not possible.
void make_folder(const std::string& directory);

/// Writes the text as write_file does.
void write_text(const std::string& file, const std::string& text);

}  // namespace tissue_stiffness
