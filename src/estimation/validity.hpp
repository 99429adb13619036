#pragma once

#include "tissue_stiffness/types/misfit.hpp"

namespace tissue_stiffness {

/// Validity tells whether the model explains what it is compared with, over the last second or so of frames. A model is
/// invalid when its error is well above noise and a good part of the motion. Then no value of its parameters is right.
class Validity {
 public:
  void add(const Misfit& misfit);
  bool invalid() const;
  void reset() { *this = {}; }

 private:
  double sigmas_ = 0.0, error_ = 0.0, motion_ = 0.0;  ///< smoothed mean squares: error over sigma, error, motion [m]
  int frames_ = 0;
};

}  // namespace tissue_stiffness
