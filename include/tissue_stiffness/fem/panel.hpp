#pragma once

#include <vector>

namespace tissue_stiffness {

/// Columns of right-hand sides that one reading of a panel serves.
constexpr int kPanelColumns = 4;
/// Columns of the factor that a kernel takes at once.
constexpr int kPanelWidth = 4;

/// t(:, k) -= panel coefficients(:, k): panel is rows x kPanelWidth with a stride of `stride` floats, t rows x columns with
/// a stride of `t_stride`; coefficients kPanelWidth x columns, column by column.
void panel_subtract(int rows, const float* panel, long stride, const float* coefficients, int columns, float* t,
                    long t_stride);

/// sums(:, k) = panel^T t(:, k), kPanelWidth x columns.
void panel_dot(int rows, const float* panel, long stride, const float* t, long t_stride, int columns, float* sums);

/// Doubles of a row that a kernel takes at once, and columns of the left factor that go with them: what registers hold.
constexpr int kRowWidth = 8;
constexpr int kTileHeight = 6;

/// c = a^T b of packed a (rows x kTileHeight) and b (rows x kRowWidth), all row by row.
void tile_product(long rows, const double* a, const double* b, double* c);

/// y = sum over k < count of values[k] times row rows[k] of x, rows of `columns` doubles each, a multiple of kRowWidth.
void sum_rows(int count, const double* values, const int* rows, const double* x, long columns, double* y);

/// Floats of a row that a kernel takes at once.
constexpr int kFloatWidth = 16;

/// y = sum over k < count of block k (3 x 3, row by row) times rows 3 nodes[k] to 3 nodes[k] + 2 of x; rows of `columns`
/// floats each, a multiple of kFloatWidth.
void sum_blocks(int count, const float* blocks, const int* nodes, const float* x, long columns, float* y);

/// The functions above for one instruction set.
struct PanelKernels {
  const char* instructions;
  decltype(&tissue_stiffness::panel_subtract) panel_subtract;
  decltype(&tissue_stiffness::panel_dot) panel_dot;
  decltype(&tissue_stiffness::tile_product) tile_product;
  decltype(&tissue_stiffness::sum_rows) sum_rows;
  decltype(&tissue_stiffness::sum_blocks) sum_blocks;
};

/// Those that this machine can run, the fastest first, which the functions above are.
std::vector<PanelKernels> panel_kernels();

}  // namespace tissue_stiffness
