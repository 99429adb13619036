// These are the inner loops of SingleFactor and of products of tall matrices, compiled for several instruction sets. The
// machine selects one at load time.
#include "fem/panel.hpp"

#include <cstring>

namespace tissue_stiffness {
namespace {

namespace any_machine {
constexpr int kBytes = 16, kRegisters = 16;
#include "panel_kernels.inc"
}  // namespace any_machine

// The clone attribute is no alternative: the compiler splits vectors into the narrowest registers before it clones a
// function.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#pragma GCC push_options
#pragma GCC target("avx2,fma")
namespace avx2 {
constexpr int kBytes = 32, kRegisters = 16;
#include "panel_kernels.inc"
}  // namespace avx2
#pragma GCC pop_options

#pragma GCC push_options
#pragma GCC target("avx512f")
namespace avx512 {
constexpr int kBytes = 64, kRegisters = 32;
#include "panel_kernels.inc"
}  // namespace avx512
#pragma GCC pop_options
#define HAS_WIDE_REGISTERS
#endif

const PanelKernels kernels = panel_kernels().front();

}  // namespace

std::vector<PanelKernels> panel_kernels() {
  std::vector<PanelKernels> out;
#ifdef HAS_WIDE_REGISTERS
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f")) out.push_back(avx512::kernels("avx512f"));
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) out.push_back(avx2::kernels("avx2"));
#endif
  out.push_back(any_machine::kernels("any"));
  return out;
}

void panel_subtract(int rows, const float* panel, long stride, const float* coefficients, int columns, float* t,
                    long t_stride) {
  kernels.panel_subtract(rows, panel, stride, coefficients, columns, t, t_stride);
}

void panel_dot(int rows, const float* panel, long stride, const float* t, long t_stride, int columns, float* sums) {
  kernels.panel_dot(rows, panel, stride, t, t_stride, columns, sums);
}

void tile_product(long rows, const double* a, const double* b, double* c) {
  kernels.tile_product(rows, a, b, c);
}

void sum_rows(int count, const double* values, const int* rows, const double* x, long columns, double* y) {
  kernels.sum_rows(count, values, rows, x, columns, y);
}

void sum_blocks(int count, const float* blocks, const int* nodes, const float* x, long columns, float* y) {
  kernels.sum_blocks(count, blocks, nodes, x, columns, y);
}

}  // namespace tissue_stiffness
