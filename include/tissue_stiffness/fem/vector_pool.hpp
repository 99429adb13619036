#pragma once

#include <Eigen/Core>
#include <mutex>
#include <vector>

namespace tissue_stiffness {

/// Vectors for whoever needs one for a moment, so that a loop asks the heap for them only the first time. Thread safe; as
/// many stay as were ever lent at once.
class VectorPool {
 public:
  /// A vector of `size` entries, not initialised, that goes back to the pool at the end.
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
