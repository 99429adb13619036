#include "fem/invariants.hpp"

#include <Eigen/LU>
#include <cmath>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

using Nine = Eigen::Matrix<double, 9, 1>;

Eigen::Map<const Nine> flat(const Eigen::Matrix3d& a) {
  return Eigen::Map<const Nine>(a.data());
}

}  // namespace

StressTangent outer(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return flat(a) * flat(b).transpose();
}

Invariant first_invariant(const Eigen::Matrix3d& f, Derivatives order) {
  Invariant out;
  out.degree = 2.0;
  out.value = f.squaredNorm();
  out.gradient = 2.0 * f;
  if (order == Derivatives::second) out.hessian = 2.0 * StressTangent::Identity();
  return out;
}

Invariant second_invariant(const Eigen::Matrix3d& f, Derivatives order) {
  const Eigen::Matrix3d right = f.transpose() * f;
  const double trace = right.trace();
  Invariant out;
  out.degree = 4.0;
  out.value = 0.5 * (trace * trace - right.squaredNorm());
  out.gradient = 2.0 * (trace * f - f * right);
  if (order == Derivatives::first) return out;
  const Eigen::Matrix3d left = f * f.transpose();
  out.hessian = 4.0 * outer(f, f);
  for (int l = 0; l < 3; ++l) {
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j) {
        out.hessian(k + 3 * j, k + 3 * l) -= 2.0 * right(l, j);
        for (int i = 0; i < 3; ++i) out.hessian(i + 3 * j, k + 3 * l) -= 2.0 * f(i, l) * f(k, j);
      }
      for (int i = 0; i < 3; ++i) out.hessian(i + 3 * l, k + 3 * l) -= 2.0 * left(i, k);
    }
  }
  out.hessian.diagonal().array() += 2.0 * trace;
  return out;
}

Invariant fibre_invariant(const Eigen::Matrix3d& f, const Eigen::Vector3d& direction, Derivatives order) {
  const Eigen::Vector3d stretched = f * direction;
  Invariant out;
  out.degree = 2.0;
  out.value = stretched.squaredNorm();
  out.gradient = 2.0 * stretched * direction.transpose();
  if (order == Derivatives::first) return out;
  out.hessian.setZero();
  for (int l = 0; l < 3; ++l) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) out.hessian(i + 3 * j, i + 3 * l) = 2.0 * direction[j] * direction[l];
    }
  }
  return out;
}

Invariant isochoric(const Invariant& of, const Eigen::Matrix3d& f, Derivatives order) {
  const double volume = f.determinant();
  if (!(volume > 0.0)) throw NumericalError("a sampled point turned inside out");
  const double power = -of.degree / 3.0, scale = std::pow(volume, power);
  const Eigen::Matrix3d h = f.inverse().transpose();  // d ln J / dF
  Invariant out;
  out.degree = 0.0;
  out.value = scale * of.value;
  out.gradient = scale * (of.gradient + power * of.value * h);
  if (order == Derivatives::first) return out;
  out.hessian = of.hessian + power * (outer(of.gradient, h) + outer(h, of.gradient) + power * of.value * outer(h, h));
  for (int l = 0; l < 3; ++l) {
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) out.hessian(i + 3 * j, k + 3 * l) -= power * of.value * h(k, j) * h(i, l);
      }
    }
  }
  out.hessian *= scale;
  return out;
}

}  // namespace tissue_stiffness
