// What a reduced basis leaves out of the motion of a body that rings is no missing physics.
#include <gtest/gtest.h>

#include "diagnosis/fit_given_model.hpp"
#include "diagnosis/screening.hpp"
#include "estimation/basis_error.hpp"
#include "filmed_bar.hpp"
#include "meshing/surface.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kPrecise = 2e-7;  // [m], so that the usual vectors are too few

struct Released {
  ModelSettings settings = box_settings(bar_under_gravity("{prior: 20.0e3, factor: 3}"));
  TetMesh mesh = bar_mesh(6, 2, 2);
  Recording recording;

  Released() {
    settings.mesh.discretisation_error = false;
    settings.observations.front().noise = kPrecise;
    const Experiment truth(settings, mesh, {kTruth});
    recording.frames = see_all(truth, truth.film(0.0, kFilmed, 50), kPrecise, 4);
  }
};

double sigmas(const RecordingFit& fit, const Eigen::VectorXd& w, const TetMesh& mesh) {
  return basis_error(*fit.reduced(), fit.whole(), w, surface_nodes(mesh)).sigmas;
}

TEST(Diagnose, TakesAsManyVectorsAsABodyThatRingsNeeds) {
  const Released released;
  const RecordingFit usual(released.settings, released.mesh, released.recording);
  const FittedModel fitted = fit_given_model(released.settings, released.mesh, released.recording);
  ASSERT_GT(sigmas(usual, fitted.fit.w, released.mesh), kBasisShare) << "the usual vectors are enough here";
  EXPECT_GT(fitted.recording_fit->growths(), 0);
  EXPECT_LT(sigmas(*fitted.recording_fit, fitted.fit.w, released.mesh), sigmas(usual, fitted.fit.w, released.mesh));
}

TEST(Diagnose, GivesTheHypothesesTheVectorsOfTheGivenModel) {
  const Released released;
  const FittedModel fitted = fit_given_model(released.settings, released.mesh, released.recording);
  const RecordingFit extended(fitted.recording_fit->model().settings(), *fitted.recording_fit);
  EXPECT_EQ(extended.growths(), fitted.recording_fit->growths());
  EXPECT_EQ(extended.reduced()->basis().cols(), fitted.recording_fit->reduced()->basis().cols());
}

}  // namespace
}  // namespace tissue_stiffness
