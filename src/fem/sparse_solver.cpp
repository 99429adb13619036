// This is the only file that uses CHOLMOD. Its supernodal part is GPL; TISSUE_STIFFNESS_CHOLMOD_SUPERNODAL=OFF avoids it.
#include "fem/sparse_solver.hpp"

#include <cholmod.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <mutex>
#include <thread>

#include "fem/single_factor.hpp"
#include "tissue_stiffness/types/error.hpp"

// Trajectories run in parallel with one solver each, so threads inside BLAS or CHOLMOD would only disturb them. Everything
// else waits for a large factor, which uses all cores.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));
extern "C" void omp_set_max_active_levels(int) __attribute__((weak));

namespace tissue_stiffness {

namespace {

constexpr double kWorthThreads = 1e10;          // operations of a factorisation
constexpr Eigen::Index kConverted = 64 * 1024;  // values that are worth a task

void take_threads(int count) {
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(count);
  if (omp_set_max_active_levels != nullptr) omp_set_max_active_levels(0);  // CHOLMOD asks for 4 threads by name
}

}  // namespace

struct SparseSolver::Data {
  static constexpr std::size_t kLarge = 6000;
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  bool numeric = false;
  std::unique_ptr<const SingleFactor> single;  ///< made when it is first asked for
  std::mutex busy;                             ///< CHOLMOD's workspace is one for all solves
  SingleFactor::Workspace workspace;

  Data() {
    take_threads(1);
    cholmod_start(&common);
#ifdef TISSUE_STIFFNESS_CHOLMOD_SUPERNODAL
    common.supernodal = CHOLMOD_SUPERNODAL;
#else
    common.supernodal = CHOLMOD_SIMPLICIAL;
#endif
    common.final_ll = 1;
    common.print = 0;
  }
  // Orders the graph of nodes, a ninth of the matrix, by nested dissection. Small matrices are left to CHOLMOD's own
  // choice.
  cholmod_factor* analyse(cholmod_sparse& a) {
    static std::mutex one_at_a_time;  // METIS draws from the C library's random numbers, which it seeds at each call
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    if (a.nrow % 3 != 0 || a.nrow < kLarge) return cholmod_analyze(&a, &common);
    std::vector<int> order = node_order(a);
    if (order.empty()) return cholmod_analyze(&a, &common);
    const int methods = common.nmethods;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_GIVEN;
    cholmod_factor* result = cholmod_analyze_p(&a, order.data(), nullptr, 0, &common);
    common.nmethods = methods;
    return result;
  }
  std::vector<int> node_order(const cholmod_sparse& a);
  const SingleFactor& single_factor();
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

// Copies the supernodal factor's arrays, with its values in single precision.
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
  l.values.resize(static_cast<Eigen::Index>(l.value_start.back()));
  tbb::this_task_arena::isolate([&] {  // a lock is held: no work of others meanwhile
    tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, l.values.size(), kConverted), [&](const auto& part) {
      for (Eigen::Index i = part.begin(); i < part.end(); ++i) l.values[i] = static_cast<float>(values[i]);
    });
  });
  return l;
}

}  // namespace

// Returns an empty order when METIS fails.
std::vector<int> SparseSolver::Data::node_order(const cholmod_sparse& a) {
  const auto nodes = static_cast<int>(a.nrow / 3);
  const int *starts = static_cast<const int*>(a.p), *rows = static_cast<const int*>(a.i);
  std::vector<int> outer{0}, inner, last(static_cast<std::size_t>(nodes), -1);
  for (int node = 0; node < nodes; ++node) {
    for (int k = starts[3 * node]; k < starts[3 * node + 3]; ++k) {
      const int other = rows[k] / 3;
      if (other < node || last[static_cast<std::size_t>(other)] == node) continue;
      last[static_cast<std::size_t>(other)] = node;
      inner.push_back(other);
    }
    outer.push_back(static_cast<int>(inner.size()));
  }
  cholmod_sparse graph{};
  graph.nrow = graph.ncol = static_cast<std::size_t>(nodes);
  graph.nzmax = inner.size();
  graph.p = outer.data();
  graph.i = inner.data();
  graph.stype = -1;
  graph.itype = CHOLMOD_INT;
  graph.xtype = CHOLMOD_PATTERN;
  graph.dtype = CHOLMOD_DOUBLE;
  graph.packed = 1;
  std::vector<int> order(static_cast<std::size_t>(nodes)), all;
  if (cholmod_metis(&graph, nullptr, 0, 1, order.data(), &common) == 0) return {};
  for (const int node : order) {
    for (int c = 0; c < 3; ++c) all.push_back(3 * node + c);
  }
  return all;
}

const SingleFactor& SparseSolver::Data::single_factor() {
  const std::lock_guard<std::mutex> lock(busy);
  if (single == nullptr) single = std::make_unique<const SingleFactor>(layout(*factor));
  return *single;
}

SparseSolver::SparseSolver() : data_(std::make_unique<Data>()) {}
SparseSolver::~SparseSolver() = default;
SparseSolver::SparseSolver(SparseSolver&&) noexcept = default;
SparseSolver& SparseSolver::operator=(SparseSolver&&) noexcept = default;

void SparseSolver::factorize(const SparseMatrix& matrix) {
  cholmod_sparse a = view(matrix);
  if (data_->factor == nullptr) data_->factor = data_->analyse(a);
  data_->numeric = false;
  data_->single = nullptr;
  const bool large = data_->common.fl > kWorthThreads;
  if (large) take_threads(static_cast<int>(std::thread::hardware_concurrency()));
  const bool failed = data_->factor == nullptr || cholmod_factorize(&a, data_->factor, &data_->common) == 0;
  if (large) take_threads(1);
  if (failed) throw NumericalError("sparse factorisation failed: out of memory or a pattern that changed");
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
  cholmod_dense rhs{};
  rhs.nrow = static_cast<std::size_t>(b.rows());
  rhs.ncol = static_cast<std::size_t>(b.cols());
  rhs.nzmax = rhs.nrow * rhs.ncol;
  rhs.d = rhs.nrow;
  rhs.x = const_cast<double*>(b.data());
  rhs.xtype = CHOLMOD_REAL;
  rhs.dtype = CHOLMOD_DOUBLE;
  const std::lock_guard<std::mutex> lock(data_->busy);
  cholmod_dense* x = cholmod_solve(CHOLMOD_A, data_->factor, &rhs, &data_->common);
  if (x == nullptr) throw NumericalError("sparse solve failed");
  Eigen::MatrixXd result = Eigen::Map<Eigen::MatrixXd>(static_cast<double*>(x->x), b.rows(), b.cols());
  cholmod_free_dense(&x, &data_->common);
  return result;
}

Eigen::MatrixXd SparseSolver::solve_roughly(const Eigen::MatrixXd& b) const {
  if (!data_->numeric || data_->factor->is_super == 0) return solve(b);
  Eigen::MatrixXd x = b;
  SingleFactor::Workspace workspace;
  data_->single_factor().solve(x, workspace);
  return x;
}

void SparseSolver::solve_roughly_in_place(Eigen::Ref<Eigen::MatrixXd> x) {
  if (!data_->numeric || data_->factor->is_super == 0) {
    x = solve(x);
  } else {
    data_->single_factor().solve(x, data_->workspace);
  }
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
