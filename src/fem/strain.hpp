#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "fem/discretisation.hpp"

namespace tissue_stiffness {

/// Small strain or stress in orthonormal components (Mandel): xx, yy, zz, sqrt(2) xy, sqrt(2) yz, sqrt(2) xz. So stress .
/// strain is the work.
using Strain = Eigen::Matrix<double, 6, 1>;

/// Returns d d^T of a direction d.
Strain strain_of(const Eigen::Vector3d& direction);

/// R with D = R R^T, with up to six columns; it has none where D is zero.
using StrainFactor = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>;

/// Returns R of the isotropic D = lambda m m^T + 2 mu I, m = (1, 1, 1, 0, 0, 0). 3 lambda + 2 mu must not be negative.
StrainFactor isotropic_factor(double lambda, double mu);

/// These fields return a value at quadrature point q of element e.
using StrainFactorField = std::function<StrainFactor(int e, int q)>;
using StressField = std::function<Strain(int e, int q)>;

/// Strains of nodal fields (columns of u, 3n) at all quadrature points. There are six rows for each point, and the points
/// of an element are together.
using StrainRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
StrainRows strains(const Discretisation& fem, const Eigen::MatrixXd& u);
/// Returns the strain of one field at one point.
Strain strain_at(const Discretisation& fem, const Eigen::VectorXd& u, int e, int q);

/// Computes Green's strain E = (F^T F - I) / 2 of a displacement u (3n) at all quadrature points, six numbers for each, and
/// its rate sym(F^T F') at the velocity v.
void green_strains(const Discretisation& fem, const Eigen::VectorXd& u, Eigen::Ref<Eigen::VectorXd> strains);
void green_strain_rates(const Discretisation& fem, const Eigen::VectorXd& u, const Eigen::VectorXd& v,
                        Eigen::Ref<Eigen::VectorXd> rates);
/// Returns the number of entries of these.
inline Eigen::Index strain_count(const Discretisation& fem) {
  return static_cast<Eigen::Index>(6) * fem.points_per_element() * fem.element_count();
}
/// Returns the components of a symmetric tensor, and the tensor of components.
Strain to_strain(const Eigen::Matrix3d& tensor);
Eigen::Matrix3d to_tensor(const Strain& strain);

/// Adds int B^T R R^T B dV [N/m], in the pattern of the mesh.
void add_strain_stiffness(const Discretisation& fem, const StrainFactorField& factor, double scale, SparseMatrix& k);

/// Returns int B^T R R^T B u dV, with a column for each column of u.
Eigen::MatrixXd apply_strain_stiffness(const Discretisation& fem, const StrainFactorField& factor,
                                       const StrainRows& strains);

/// Returns E^T (int R R^T dV) E for the strains E of a basis. This is the stiffness above in that basis.
Eigen::MatrixXd project_strain_stiffness(const Discretisation& fem, const StrainFactorField& factor,
                                         const StrainRows& strains);

/// Subtracts int B^T s dV [N], the internal force of the stress field s.
void add_stress_force(const Discretisation& fem, const StressField& stress, Eigen::VectorXd& force);

}  // namespace tissue_stiffness
