#include "diagnosis/fit_given_model.hpp"

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "diagnosis/estimate_at_last.hpp"
#include "estimation/basis_error.hpp"
#include "forward/hyper_basis.hpp"
#include "meshing/surface.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSpread = 0.1;                // prior standard deviations, of the fit's first sigma points
constexpr double kShares[] = {0.1, 0.2, 0.4};  // of the training frames

// A scan of the modulus over all frames says nothing while it is not known how the body starts. The first frames tell both,
// whatever the prior, so such a model is fitted to more and more of them.
Eigen::VectorXd starting_point(const RecordingFit& recording_fit) {
  const ParameterSpace& parameters = recording_fit.model().parameters();
  Eigen::VectorXd w = parameters.prior_mean();
  if (!recording_fit.model().starts_in_motion()) return recording_fit.scan(w);
  for (const double share : kShares) w = recording_fit.quick_fit(w, kSpread * parameters.prior_std(), share).w;
  return w;
}

// A scan of finite strain runs only what is linear in it, which may be far from the recording. The estimator runs the model
// itself, so the fit begins where the better of both is.
Eigen::VectorXd starting_point_of_finite(const RecordingFit& recording_fit) {
  const Model& model = recording_fit.model();
  const Eigen::VectorXd scanned = starting_point(recording_fit);
  std::map<std::string, double> values;
  for (const ParameterEstimate& p :
       estimate_by_filter(model.settings(), recording_fit, recording_fit.recording().training()).parameters)
    values[p.name] = p.mean;
  const Eigen::VectorXd estimated = model.parameters().coordinates(values, model.parameters().prior_mean());
  return recording_fit.cost_in_full(estimated) < recording_fit.cost_in_full(scanned) ? estimated : scanned;
}

// What the basis leaves out is no missing physics. A body that nothing damps rings in more modes than the usual basis
// holds.
FittedModel in_sufficient_basis(FittedModel fitted) {
  RecordingFit& known = *fitted.recording_fit;
  if (!known.linear() || known.model().starts_in_motion()) return fitted;
  BasisGrowth growth =
      grow_basis(*known.reduced(), false, known.whole(), fitted.fit.w, surface_nodes(known.model().mesh()));
  if (!growth.larger) return fitted;
  known.take_basis(std::move(growth.larger), growth.growths);
  return fit_recording(std::move(fitted.recording_fit), fitted.fit.w, kSpread);
}

}  // namespace

FittedModel fit_given_model(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording) {
  auto recording_fit = std::make_unique<RecordingFit>(settings, mesh, recording);
  const Model& model = recording_fit->model();
  const Eigen::VectorXd start =
      why_not_hyper_reduced(model).empty() ? starting_point_of_finite(*recording_fit) : starting_point(*recording_fit);
  return in_sufficient_basis(fit_recording(std::move(recording_fit), start, kSpread));
}

}  // namespace tissue_stiffness
