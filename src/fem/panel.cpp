// The inner loops of SingleFactor and of products of tall matrices, compiled for several instruction sets; the machine
// picks one at load time.
#include "tissue_stiffness/fem/panel.hpp"

#include <cstring>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define FOR_EVERY_MACHINE __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define FOR_EVERY_MACHINE
#endif

namespace tissue_stiffness {
namespace {

constexpr int kLanes = 16;
typedef double Doubles __attribute__((vector_size(kRowWidth * sizeof(double)), aligned(sizeof(double)), may_alias));
typedef float Lanes __attribute__((vector_size(kLanes * sizeof(float)), aligned(sizeof(float)), may_alias));

template <int K>
inline __attribute__((always_inline)) void subtract(int rows, const float* l, long stride, const float* c, float* t,
                                                    long t_stride) {
  const float *l0 = l, *l1 = l + stride, *l2 = l + 2 * stride, *l3 = l + 3 * stride;
  int i = 0;
  for (; i + kLanes <= rows; i += kLanes) {
    const Lanes a0 = *reinterpret_cast<const Lanes*>(l0 + i), a1 = *reinterpret_cast<const Lanes*>(l1 + i),
                a2 = *reinterpret_cast<const Lanes*>(l2 + i), a3 = *reinterpret_cast<const Lanes*>(l3 + i);
    for (int k = 0; k < K; ++k) {
      Lanes& to = *reinterpret_cast<Lanes*>(t + k * t_stride + i);
      const float* ck = c + kPanelWidth * k;
      to -= a0 * ck[0] + a1 * ck[1] + a2 * ck[2] + a3 * ck[3];
    }
  }
  for (; i < rows; ++i) {
    for (int k = 0; k < K; ++k) {
      const float* ck = c + kPanelWidth * k;
      t[k * t_stride + i] -= l0[i] * ck[0] + l1[i] * ck[1] + l2[i] * ck[2] + l3[i] * ck[3];
    }
  }
}

template <int K>
inline __attribute__((always_inline)) void dot(int rows, const float* l, long stride, const float* t, long t_stride,
                                               float* sums) {
  Lanes sum[K][kPanelWidth];
  std::memset(sum, 0, sizeof sum);
  int i = 0;
  for (; i + kLanes <= rows; i += kLanes) {
    for (int k = 0; k < K; ++k) {
      const Lanes x = *reinterpret_cast<const Lanes*>(t + k * t_stride + i);
      for (int j = 0; j < kPanelWidth; ++j) sum[k][j] += *reinterpret_cast<const Lanes*>(l + j * stride + i) * x;
    }
  }
  for (int k = 0; k < K; ++k) {
    for (int j = 0; j < kPanelWidth; ++j) {
      float whole = 0.0F;
      for (int lane = 0; lane < kLanes; ++lane) whole += sum[k][j][lane];
      for (int r = i; r < rows; ++r) whole += l[j * stride + r] * t[k * t_stride + r];
      sums[kPanelWidth * k + j] = whole;
    }
  }
}

}  // namespace

FOR_EVERY_MACHINE void panel_subtract(int rows, const float* panel, long stride, const float* coefficients, int columns,
                                      float* t, long t_stride) {
  switch (columns) {
    case 1:
      return subtract<1>(rows, panel, stride, coefficients, t, t_stride);
    case 2:
      return subtract<2>(rows, panel, stride, coefficients, t, t_stride);
    case 3:
      return subtract<3>(rows, panel, stride, coefficients, t, t_stride);
    default:
      return subtract<4>(rows, panel, stride, coefficients, t, t_stride);
  }
}

FOR_EVERY_MACHINE void panel_dot(int rows, const float* panel, long stride, const float* t, long t_stride, int columns,
                                 float* sums) {
  switch (columns) {
    case 1:
      return dot<1>(rows, panel, stride, t, t_stride, sums);
    case 2:
      return dot<2>(rows, panel, stride, t, t_stride, sums);
    case 3:
      return dot<3>(rows, panel, stride, t, t_stride, sums);
    default:
      return dot<4>(rows, panel, stride, t, t_stride, sums);
  }
}

FOR_EVERY_MACHINE void tile_product(long rows, const double* a, const double* b, double* c) {
  Doubles sum[kTileHeight];
  std::memset(sum, 0, sizeof sum);
  for (long r = 0; r < rows; ++r) {
    const Doubles right = *reinterpret_cast<const Doubles*>(b + kRowWidth * r);
    for (int i = 0; i < kTileHeight; ++i) sum[i] += a[kTileHeight * r + i] * right;
  }
  std::memcpy(c, sum, sizeof sum);
}

FOR_EVERY_MACHINE void sum_rows(int count, const double* values, const int* rows, const double* x, long columns,
                                double* y) {
  constexpr int wide = 4;
  long at = 0;
  for (; at + wide * kRowWidth <= columns; at += wide * kRowWidth) {
    Doubles sum[wide];
    std::memset(sum, 0, sizeof sum);
    for (int k = 0; k < count; ++k) {
      const double* row = x + columns * rows[k] + at;
      for (int i = 0; i < wide; ++i) sum[i] += values[k] * *reinterpret_cast<const Doubles*>(row + kRowWidth * i);
    }
    std::memcpy(y + at, sum, sizeof sum);
  }
  for (; at < columns; at += kRowWidth) {
    Doubles sum;
    std::memset(&sum, 0, sizeof sum);
    for (int k = 0; k < count; ++k) sum += values[k] * *reinterpret_cast<const Doubles*>(x + columns * rows[k] + at);
    std::memcpy(y + at, &sum, sizeof sum);
  }
}

}  // namespace tissue_stiffness
