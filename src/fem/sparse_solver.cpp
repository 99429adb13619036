// The only file that uses CHOLMOD. Its supernodal part is GPL: TISSUE_STIFFNESS_CHOLMOD_SUPERNODAL=OFF avoids it.
#include "tissue_stiffness/fem/sparse_solver.hpp"

#include <cholmod.h>

#include "tissue_stiffness/fem/single_factor.hpp"
#include "tissue_stiffness/types/error.hpp"

// Trajectories run in parallel, one solver each: threads inside BLAS or CHOLMOD would only get in their way.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));
extern "C" void omp_set_max_active_levels(int) __attribute__((weak));

namespace tissue_stiffness {

namespace {

void quiet_threads() {
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  if (omp_set_max_active_levels != nullptr) omp_set_max_active_levels(0);  // CHOLMOD asks for 4 threads by name
}

}  // namespace

struct SparseSolver::Data {
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  bool numeric = false;
  mutable std::unique_ptr<const SingleFactor> single;  ///< made when it is first asked for

  Data() {
    quiet_threads();
    cholmod_start(&common);
#ifdef TISSUE_STIFFNESS_CHOLMOD_SUPERNODAL
    common.supernodal = CHOLMOD_SUPERNODAL;
#else
    common.supernodal = CHOLMOD_SIMPLICIAL;
#endif
    common.final_ll = 1;
    common.print = 0;
  }
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;
  ~Data() {
    if (factor != nullptr) cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
};

namespace {

cholmod_sparse view(const SparseMatrix& matrix) {
  cholmod_sparse v{};
  v.nrow = static_cast<std::size_t>(matrix.rows());
  v.ncol = static_cast<std::size_t>(matrix.cols());
  v.nzmax = static_cast<std::size_t>(matrix.nonZeros());
  v.p = const_cast<int*>(matrix.outerIndexPtr());
  v.i = const_cast<int*>(matrix.innerIndexPtr());
  v.x = const_cast<double*>(matrix.valuePtr());
  v.stype = -1;
  v.itype = CHOLMOD_INT;
  v.xtype = CHOLMOD_REAL;
  v.dtype = CHOLMOD_DOUBLE;
  v.sorted = 1;
  v.packed = 1;
  return v;
}

// The supernodal factor's arrays, its values in single precision.
SingleFactor::Layout layout(const cholmod_factor& factor) {
  const auto count = factor.nsuper;
  const int* rows = static_cast<const int*>(factor.s);
  const int* row_start = static_cast<const int*>(factor.pi);
  const int* value_start = static_cast<const int*>(factor.px);
  const double* values = static_cast<const double*>(factor.x);
  const int* permutation = static_cast<const int*>(factor.Perm);
  const int* first = static_cast<const int*>(factor.super);
  SingleFactor::Layout l;
  l.permutation.assign(permutation, permutation + factor.n);
  l.first.assign(first, first + count + 1);
  l.rows.assign(rows, rows + row_start[count]);
  l.row_start.assign(row_start, row_start + count + 1);
  l.value_start.assign(value_start, value_start + count + 1);
  l.values.resize(l.value_start.back());
  for (std::size_t i = 0; i < l.values.size(); ++i) l.values[i] = static_cast<float>(values[i]);
  return l;
}

}  // namespace

SparseSolver::SparseSolver() : data_(std::make_unique<Data>()) {}
SparseSolver::~SparseSolver() = default;
SparseSolver::SparseSolver(SparseSolver&&) noexcept = default;
SparseSolver& SparseSolver::operator=(SparseSolver&&) noexcept = default;

void SparseSolver::factorize(const SparseMatrix& matrix) {
  quiet_threads();  // OpenMP keeps the number for each calling thread
  cholmod_sparse a = view(matrix);
  if (data_->factor == nullptr) data_->factor = cholmod_analyze(&a, &data_->common);
  data_->numeric = false;
  data_->single = nullptr;
  if (data_->factor == nullptr || cholmod_factorize(&a, data_->factor, &data_->common) == 0) {
    throw NumericalError("sparse factorisation failed: out of memory or a pattern that changed");
  }
  if (data_->common.status == CHOLMOD_NOT_POSDEF) {
    throw NumericalError("matrix is not positive definite (column " + std::to_string(data_->factor->minor) + ")");
  }
  data_->numeric = true;
}

bool SparseSolver::ready() const {
  return data_->numeric;
}

Eigen::MatrixXd SparseSolver::solve(const Eigen::MatrixXd& b) const {
  if (!data_->numeric) throw NumericalError("solve before a successful factorisation");
  quiet_threads();
  cholmod_dense rhs{};
  rhs.nrow = static_cast<std::size_t>(b.rows());
  rhs.ncol = static_cast<std::size_t>(b.cols());
  rhs.nzmax = rhs.nrow * rhs.ncol;
  rhs.d = rhs.nrow;
  rhs.x = const_cast<double*>(b.data());
  rhs.xtype = CHOLMOD_REAL;
  rhs.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* x = cholmod_solve(CHOLMOD_A, data_->factor, &rhs, &data_->common);
  if (x == nullptr) throw NumericalError("sparse solve failed");
  Eigen::MatrixXd result = Eigen::Map<Eigen::MatrixXd>(static_cast<double*>(x->x), b.rows(), b.cols());
  cholmod_free_dense(&x, &data_->common);
  return result;
}

Eigen::MatrixXd SparseSolver::solve_roughly(const Eigen::MatrixXd& b) const {
  if (!data_->numeric || data_->factor->is_super == 0) return solve(b);
  if (data_->single == nullptr) data_->single = std::make_unique<const SingleFactor>(layout(*data_->factor));
  return data_->single->solve(b);
}

double SparseSolver::cost() const {
  constexpr double products = 8.0;  // multiplications of a dense product in the time in which a number comes from memory
  return data_->common.fl / (products * 2.0 * data_->common.lnz);
}

double SparseSolver::factor_size() const {
  return data_->common.lnz;
}

void fix_dofs(SparseMatrix& matrix, const std::vector<char>& fixed, double diagonal) {
  for (int column = 0; column < matrix.outerSize(); ++column) {
    const bool column_fixed = fixed[static_cast<std::size_t>(column)] != 0;
    for (SparseMatrix::InnerIterator it(matrix, column); it; ++it) {
      if (column_fixed || fixed[static_cast<std::size_t>(it.row())] != 0) {
        it.valueRef() = it.row() == column ? diagonal : 0.0;
      }
    }
  }
}

}  // namespace tissue_stiffness
