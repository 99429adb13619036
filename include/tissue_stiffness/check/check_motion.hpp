#pragma once

#include "tissue_stiffness/check/motion_study.hpp"
#include "tissue_stiffness/check/setup_finding.hpp"

namespace tissue_stiffness {

/// Loads and moduli that the measured motion m contradicts, beside the predictions p(z) of a MotionStudy.
///   sign: m is fitted by the responses to each load and to everything else, each times a factor of its own, at the modulus
///   of the prior's range that fits best; a load with a negative factor that takes away more than half of what the others
///   leave of |m|^2 (a correlation below -0.71) acts the wrong way round.
///   unit: |p| at the prior's median is more than 31.6 |m|, and at its upper 2.5 % still more than |m|. The load is then in
///   mN or mPa, or, where a modulus below 1 kPa or no load predicts the motion, the modulus in kPa.
SetupFindings check_loads(const MotionStudy& study, const ModelSettings& settings);

/// Noise that the recording contradicts, of each entry of `observations`.
///   noise > rms m in every frame: the motion drowns in it;
///   noise > 10 rms (m - p) at the best modulus: ten times what a model leaves, which is more than the noise that is there;
///   noise < scatter / 10: the scatter is the level of white noise below the recording's few modes, median(s) / sqrt(k mu)
///   for the singular values s of rows over time (Gavish & Donoho 2014, eq. 11), where ten points or more have identities.
SetupFindings check_noise(const MotionStudy& study, const ModelSettings& settings, const std::vector<Frame>& frames);

/// Standard deviation of white noise in a matrix of low rank plus noise: median singular value over sqrt(k mu), k the
/// larger number of rows and columns and mu the median of the Marchenko-Pastur distribution of their ratio.
double scatter(const Eigen::MatrixXd& matrix);

/// Both, of a study of the model, where one applies. Throws InputError as MotionStudy does.
SetupFindings check_motion(const ModelSettings& settings, const TetMesh& mesh, const Recorded& recorded);

}  // namespace tissue_stiffness
