#pragma once

#include <vector>

namespace tissue_stiffness {

/// Number of right-hand sides for which a panel is read once.
constexpr int kPanelColumns = 4;
/// Number of the factor's columns that a kernel processes at once.
constexpr int kPanelWidth = 4;

/// Computes t(:, k) -= panel coefficients(:, k). `panel` is rows x kPanelWidth with a stride of `stride` floats, `t` is
/// rows x columns with a stride of `t_stride`. `coefficients` is kPanelWidth x columns, column by column.
void panel_subtract(int rows, const float* panel, long stride, const float* coefficients, int columns, float* t,
                    long t_stride);

/// Computes sums(:, k) = panel^T t(:, k), kPanelWidth x columns.
void panel_dot(int rows, const float* panel, long stride, const float* t, long t_stride, int columns, float* sums);

/// Number of doubles of a row that a kernel processes at once, and columns of the left factor with them. The registers hold
/// as many.
constexpr int kRowWidth = 8;
constexpr int kTileHeight = 6;

/// Computes c = a^T b of packed a (rows x kTileHeight) and b (rows x kRowWidth). All three are stored row by row.
void tile_product(long rows, const double* a, const double* b, double* c);

/// Computes y = sum over k < count of values[k] times row rows[k] of x. The rows have `columns` doubles, a multiple of
/// kRowWidth.
void sum_rows(int count, const double* values, const int* rows, const double* x, long columns, double* y);

/// Number of floats of a row that a kernel processes at once.
constexpr int kFloatWidth = 16;

/// Computes y = sum over k < count of block k (3 x 3, row by row) times rows 3 nodes[k] to 3 nodes[k] + 2 of x. The rows
/// have `columns` floats, a multiple of kFloatWidth.
void sum_blocks(int count, const float* blocks, const int* nodes, const float* x, long columns, float* y);

/// Versions of the functions above for one instruction set.
struct PanelKernels {
  const char* instructions;
  decltype(&tissue_stiffness::panel_subtract) panel_subtract;
  decltype(&tissue_stiffness::panel_dot) panel_dot;
  decltype(&tissue_stiffness::tile_product) tile_product;
  decltype(&tissue_stiffness::sum_rows) sum_rows;
  decltype(&tissue_stiffness::sum_blocks) sum_blocks;
};

/// Returns the versions that this machine can run, the fastest first. The functions above use the fastest.
std::vector<PanelKernels> panel_kernels();

}  // namespace tissue_stiffness
