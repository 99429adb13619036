// Markers may stand off the surface. Each is carried by the facet nearest to it at rest, as if by a rigid pin.
#include <Eigen/Geometry>

#include "observation/closest_point.hpp"
#include "observation/named_points.hpp"
#include "observation/observation_operator.hpp"
#include "observation/surface_anchor.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/nearest_rotation.hpp"

namespace tissue_stiffness {
namespace {

struct Attachment {
  SurfaceAnchor anchor;  ///< of the foot point
  Eigen::Vector3d foot;  ///< on the rest surface [m]
  Eigen::Vector3d pin;   ///< from the foot to the marker at rest [m]
};

class MarkerOperator : public ObservationOperator {
 public:
  MarkerOperator(const Model& model, const ObservationSettings& settings)
      : mesh_(model.mesh()), topic_(settings.topic), noise_(settings.noise), finite_(model.nonlinear()) {
    for (Eigen::Index i = 0; i < settings.rest.cols(); ++i) attachments_.push_back(attach(settings.rest.col(i)));
  }

  void check(const Observation& observation) const override {
    for (Eigen::Index i = 0; i < observation.ids.size(); ++i) {
      if (observation.ids[i] < 0 || observation.ids[i] >= static_cast<int>(attachments_.size())) {
        throw InputError(topic_, "marker " + std::to_string(observation.ids[i]),
                         "0 to " + std::to_string(attachments_.size() - 1) + " (rows of `rest`)");
      }
    }
  }

  Prediction predict(const Observation& observation, const Eigen::Ref<const Eigen::VectorXd>& u) const override {
    Prediction p = predict_named_points(observation, noise_);
    for (Eigen::Index i = 0; i < observation.ids.size(); ++i) {
      const Attachment& a = attachments_[static_cast<std::size_t>(observation.ids[i])];
      p.predicted.segment<3>(3 * i) = carried(a, u);
      p.nodes.segment<3>(3 * i).setConstant(a.anchor.node);
    }
    return p;
  }

  std::vector<int> nodes(const Observation& observation) const override {
    std::vector<int> list;
    for (Eigen::Index i = 0; i < observation.ids.size(); ++i) {
      const auto tet = mesh_.tets.col(attachments_[static_cast<std::size_t>(observation.ids[i])].anchor.tet);
      list.insert(list.end(), tet.data(), tet.data() + tet.size());
    }
    return list;
  }

 private:
  Attachment attach(const Eigen::Vector3d& marker) const {
    const SurfacePoint foot = closest_surface_point(mesh_, marker);
    return {anchor_on(mesh_, foot.facet, foot.point), foot.point, marker - foot.point};
  }

  // Returns the displaced foot + R pin. For small strain the rotation is linear, R = I + skew(grad u).
  Eigen::Vector3d carried(const Attachment& a, const Eigen::Ref<const Eigen::VectorXd>& u) const {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for (Eigen::Index k = 0; k < a.anchor.shape.size(); ++k)
      gradient += u.segment<3>(3 * mesh_.tets(k, a.anchor.tet)) * a.anchor.gradient.col(k).transpose();
    Eigen::Matrix3d turn = 0.5 * (gradient - gradient.transpose()) + Eigen::Matrix3d::Identity();
    if (finite_) turn = nearest_rotation(Eigen::Matrix3d::Identity() + gradient);
    return a.foot + a.anchor.displacement(mesh_, u) + turn * a.pin;
  }

  const TetMesh& mesh_;
  std::string topic_;
  double noise_;
  bool finite_;
  std::vector<Attachment> attachments_;
};

}  // namespace

std::unique_ptr<ObservationOperator> make_marker_operator(const Model& model, const ObservationSettings& settings) {
  return std::make_unique<MarkerOperator>(model, settings);
}

}  // namespace tissue_stiffness
