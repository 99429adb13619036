#pragma once

namespace tissue_stiffness {

/// Estimates a neo-Hookean block over `draws` draws of its modulus and of the noise, each filmed in full for `frames`
/// frames, and prints a table of doc/performance.md: how far modulus and tip are off, and how often the interval holds the
/// truth.
void print_draws(int draws, int cells, int across, int frames);

}  // namespace tissue_stiffness
