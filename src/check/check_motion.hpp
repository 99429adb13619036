#pragma once

#include "check/motion_study.hpp"
#include "check/setup_finding.hpp"

namespace tissue_stiffness {

/// Finds loads and moduli that contradict the measured motion m, given the predictions p(z) of a MotionStudy.
/// * sign: m is fitted by the responses to each load and to everything else, each with its own factor. The modulus is that
///   of the prior's range that fits best. A load acts in the wrong direction if its factor is negative and removes more
///   than half of what the others leave of |m|^2 (a correlation below -0.71).
/// * unit: |p| at the prior's median is more than 31.6 |m|, and at its upper 2.5 % still more than |m|. The load is then in
///   mN or mPa. The modulus is in kPa instead where it is below 1 kPa or no load predicts the motion.
SetupFindings check_loads(const MotionStudy& study, const ModelSettings& settings);

/// Finds entries of `observations` whose noise contradicts the recording.
/// * noise > rms m in every frame: the motion is hidden in the noise.
/// * noise > 10 rms (m - p) at the best modulus: it is ten times what a model leaves, which is more than the actual noise.
/// * noise < scatter / 10: the scatter is the level of white noise below the recording's few modes. It is median(s) /
///   sqrt(k mu) for the singular values s of rows over time (Gavish & Donoho 2014, eq. 11), where ten points or more have
///   identities.
SetupFindings check_noise(const MotionStudy& study, const ModelSettings& settings, const std::vector<Frame>& frames);

/// Returns the standard deviation of white noise in a matrix of low rank plus noise. It is the median singular value over
/// sqrt(k mu), where k is the larger number of rows and columns and mu the median of the Marchenko-Pastur distribution of
/// their ratio.
double scatter(const Eigen::MatrixXd& matrix);

/// Makes a MotionStudy, where one applies, and runs check_loads. It runs check_noise if the loads are right. Throws
/// InputError as MotionStudy does.
SetupFindings check_motion(const ModelSettings& settings, const TetMesh& mesh, const Recorded& recorded);

}  // namespace tissue_stiffness
