#pragma once

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

}  // namespace tissue_stiffness
