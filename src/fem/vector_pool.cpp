#include "fem/vector_pool.hpp"

#include <utility>

namespace tissue_stiffness {

VectorPool::Loan::Loan(VectorPool& pool, Eigen::Index size) : pool_(pool) {
  {
    const std::lock_guard<std::mutex> lock(pool_.busy_);
    if (!pool_.idle_.empty()) {
      vector_.swap(pool_.idle_.back());
      pool_.idle_.pop_back();
    }
  }
  vector_.resize(size);
}

VectorPool::Loan::~Loan() {
  const std::lock_guard<std::mutex> lock(pool_.busy_);
  pool_.idle_.push_back(std::move(vector_));
}

}  // namespace tissue_stiffness
