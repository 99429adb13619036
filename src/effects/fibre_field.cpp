#include "effects/fibre_field.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kStandsOut = 0.1;  // of the mean moment: how much an axis must differ from the others

// Completes e1 to an orthonormal basis.
Eigen::Matrix3d complete(const Eigen::Vector3d& e1) {
  Eigen::Index across = 0;
  e1.cwiseAbs().minCoeff(&across);
  Eigen::Matrix3d frame;
  frame.col(0) = e1;
  frame.col(1) = (Eigen::Vector3d::Unit(across) - e1[across] * e1).normalized();
  frame.col(2) = frame.col(0).cross(frame.col(1));
  return frame;
}

Eigen::Vector3d direction_from(const Value& value) {
  const Eigen::Vector3d v = value.as_vector3("-");
  if (!(v.norm() > 0.0)) throw InputError(value.path(), value.shown(), "a vector that is not zero");
  return v.normalized();
}

}  // namespace

Axis principal_axis(const TetMesh& mesh) {
  Eigen::VectorXd volume(mesh.tet_count());
  Eigen::Matrix3Xd centre(3, mesh.tet_count());
  for (int t = 0; t < mesh.tet_count(); ++t) {
    Eigen::Matrix<double, 3, 4> x;
    for (int k = 0; k < 4; ++k) x.col(k) = mesh.nodes.col(mesh.tets(k, t));
    volume[t] = (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).dot(x.col(3) - x.col(0)) / 6.0;
    centre.col(t) = x.rowwise().mean();
  }
  Axis axis{centre * volume / volume.sum(), Eigen::Vector3d::UnitZ()};
  const Eigen::Matrix3Xd arm = centre.colwise() - axis.point;
  const Eigen::Matrix3d moments = arm * volume.asDiagonal() * arm.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(moments);
  const Eigen::Vector3d& m = eigen.eigenvalues();  // ascending
  const bool longest = m[2] - m[1] > m[1] - m[0];
  const double gap = longest ? m[2] - m[1] : m[1] - m[0];
  if (gap > kStandsOut * m.mean()) axis.direction = eigen.eigenvectors().col(longest ? 2 : 0);
  Eigen::Index main = 0;
  axis.direction.cwiseAbs().maxCoeff(&main);
  if (axis.direction[main] < 0.0) axis.direction = -axis.direction;
  return axis;
}

FibreField::FibreField(const Value& arguments, const EffectContext& context)
    : fem_(context.fem), axis_(principal_axis(context.mesh)) {
  const Value& direction = arguments.at("direction");
  if (direction.type() == Value::Type::list) {
    fixed_ = complete(direction_from(direction));
    return;
  }
  const std::string kind = direction.as_choice({"circumferential", "longitudinal", "radial"});
  kind_ = kind == "radial" ? Kind::radial : kind == "longitudinal" ? Kind::longitudinal : Kind::circumferential;
  if (arguments.has("axis")) axis_.direction = direction_from(arguments.at("axis"));
  if (arguments.has("center")) axis_.point = arguments.at("center").as_vector3("m");
}

Eigen::Matrix3d FibreField::frame(const Eigen::Vector3d& position) const {
  if (kind_ == Kind::fixed) return fixed_;
  const Eigen::Vector3d& along = axis_.direction;
  Eigen::Vector3d out = position - axis_.point;
  out -= along.dot(out) * along;
  const Eigen::Vector3d radial =
      out.norm() > 0.0 ? Eigen::Vector3d(out.normalized()) : Eigen::Vector3d(complete(along).col(1));
  const Eigen::Vector3d around = along.cross(radial);
  Eigen::Matrix3d frame;
  if (kind_ == Kind::circumferential) frame << around, along, radial;
  if (kind_ == Kind::longitudinal) frame << along, around, radial;
  if (kind_ == Kind::radial) frame << radial, around, along;
  return frame;
}

Eigen::Vector3d FibreField::direction(int e, int q, double angle, double tilt) const {
  return frame(fem_.position(e, q)) *
         Eigen::Vector3d(std::cos(tilt) * std::cos(angle), std::cos(tilt) * std::sin(angle), std::sin(tilt));
}

std::vector<std::pair<std::string, std::string>> FibreField::keys() {
  return {{"direction", "[x, y, z] | circumferential | longitudinal | radial"},
          {"axis", "[x, y, z] that the last three refer to; without it the body's principal axis, z where none stands out"},
          {"center", "[x, y, z] on the axis [m]; without it the body's centroid"}};
}

std::vector<ParameterSpec> FibreField::angles() {
  return {{"angle", "phi", "rad", -4.0, 4.0, ParameterSpec::Default::optional, 0.0, NAN, 1},
          {"tilt", "psi", "rad", -4.0, 4.0, ParameterSpec::Default::optional, 0.0, NAN, 1}};
}

EffectEntry FibreField::entry(const std::string& effect, const Trial& trial, const Argument& angle, const Argument& tilt) {
  EffectEntry out{effect, {{"direction", trial.direction}, {"angle", angle}}};
  if (trial.straight) out.arguments.emplace_back("tilt", tilt);
  return out;
}

std::vector<FibreField::Trial> FibreField::trials(const TetMesh& mesh) {
  const Eigen::Vector3d axis = principal_axis(mesh).direction;
  std::vector<Trial> list{{"circumferential", 0.0, false}, {"longitudinal", 0.0, false}, {"radial", 0.0, false}};
  for (const double angle : {-M_PI / 4.0, M_PI / 4.0}) list.push_back({"circumferential", angle, false});
  for (int i = 0; i < 3; ++i) {
    if (std::abs(axis[i]) < 0.95) list.push_back({Eigen::Vector3d(Eigen::Vector3d::Unit(i)), 0.0, true});
  }
  return list;
}

std::vector<FibreField::Trial> FibreField::oblique_trials() {
  std::vector<Trial> list;
  for (const double x : {0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      for (const double z : {-1.0, 0.0, 1.0}) {
        const bool first = x > 0.0 || y > 0.0;  // the opposite direction is the same fibre
        if (first && std::abs(x) + std::abs(y) + std::abs(z) > 1.5) list.push_back({Eigen::Vector3d(x, y, z), 0.0, true});
      }
    }
  }
  return list;
}

}  // namespace tissue_stiffness
