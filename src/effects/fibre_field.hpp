#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "effects/effect.hpp"

namespace tissue_stiffness {

/// Straight line around which fibres are wound.
struct Axis {
  Eigen::Vector3d point, direction;
};

/// Returns the axis through the body's centroid along the principal axis that differs most from the other two. This is the
/// axis of a body of revolution, or the length of a bar. It is z where no axis differs clearly.
Axis principal_axis(const TetMesh& mesh);

/// Unit directions of fibres at the quadrature points. They come from the keys `direction` ([x, y, z], circumferential,
/// longitudinal or radial), `axis` and `center`, and from two angles: a = cos(tilt) (cos(angle) e1 + sin(angle) e2) +
/// sin(tilt) e3. The requested direction is e1. For directions about an axis e2 leads from circumferential to longitudinal
/// (or back) and e3 is radial, so that `angle` is the helix angle.
class FibreField {
 public:
  /// Reads the keys. Throws InputError for a direction that is zero.
  FibreField(const Value& arguments, const EffectContext& context);

  Eigen::Vector3d direction(int e, int q, double angle, double tilt) const;

  /// These return the keys for an effect's spec, and its parameters `angle` and `tilt`.
  static std::vector<std::pair<std::string, std::string>> keys();
  static std::vector<ParameterSpec> angles();
  /// Directions worth trying on a body, each as the argument `direction` and an angle [rad].
  struct Trial {
    Argument direction;
    double angle;
    bool straight;  ///< alike everywhere: a fit may turn it by `angle` and `tilt`
  };
  static constexpr double kTurn = 0.3;  ///< [rad] prior standard deviation of both angles, of fibres that a fit turns
  /// Returns an entry for the model file with fibres along a trial's direction; only a straight one may have a tilt.
  static EffectEntry entry(const std::string& effect, const Trial& trial, const Argument& angle, const Argument& tilt);
  /// Returns directions about the body's axis, two helices, and the coordinate axes that are not the body's axis.
  static std::vector<Trial> trials(const TetMesh& mesh);
  /// Returns the straight directions halfway between two or three coordinate axes. With these axes they cover the half
  /// sphere, and no direction is further than 28 degrees from one of them.
  static std::vector<Trial> oblique_trials();

 private:
  enum class Kind { fixed, circumferential, longitudinal, radial };
  Eigen::Matrix3d frame(const Eigen::Vector3d& position) const;

  const Discretisation& fem_;
  Kind kind_ = Kind::fixed;
  Eigen::Matrix3d fixed_ = Eigen::Matrix3d::Identity();
  Axis axis_;
};

/// Tension along the fibres [Pa] (second Piola-Kirchhoff) and its derivative with respect to the Green strain along them.
struct FibreTension {
  double value, slope;
};
/// Returns the Green strain (|F a|^2 - 1) / 2 along a direction.
double fibre_strain(const Eigen::Matrix3d& f, const Eigen::Vector3d& direction);
/// Adds the stress S (F a) a^T of fibres under a tension S, and its derivative (Holzapfel 2000, sec. 6.7).
void add_fibre_stress(const FibreTension& tension, const Eigen::Vector3d& direction, const Eigen::Matrix3d& f,
                      Eigen::Matrix3d& stress);
void add_fibre_tangent(const FibreTension& tension, const Eigen::Vector3d& direction, const Eigen::Matrix3d& f,
                       StressTangent& tangent);

}  // namespace tissue_stiffness
