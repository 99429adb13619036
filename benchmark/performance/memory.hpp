#pragma once

namespace tissue_stiffness {

/// Gives freed memory back and forgets the peak so far.
void forget_peak_memory();
/// Largest resident size of this process since then [MB].
double peak_memory();
/// What all cores together read from memory [GB/s]: the best of five sums over 512 MB.
double memory_bandwidth();

}  // namespace tissue_stiffness
