#pragma once

#include <Eigen/Core>
#include <mutex>
#include <vector>

namespace tissue_stiffness {

/// Pool of temporary vectors, so that a loop allocates memory only the first time. It is thread safe and keeps as many
/// vectors as were ever lent at the same time.
class VectorPool {
 public:
  /// A vector of `size` entries, not initialised, that returns to the pool when the loan ends.
  class Loan {
   public:
    Loan(VectorPool& pool, Eigen::Index size);
    ~Loan();
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    Eigen::VectorXd& operator*() { return vector_; }
    Eigen::VectorXd* operator->() { return &vector_; }

   private:
    VectorPool& pool_;
    Eigen::VectorXd vector_;
  };

 private:
  std::mutex busy_;
  std::vector<Eigen::VectorXd> idle_;
};

}  // namespace tissue_stiffness
