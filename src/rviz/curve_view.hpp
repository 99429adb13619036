#pragma once

#include <qwt_plot.h>

#include <QColor>
#include <QString>
#include <limits>

#include "rviz/live_curve.hpp"

class QwtPlotCurve;
class QwtPlotIntervalCurve;
class QwtPlotTextLabel;

namespace tissue_stiffness {

/// Plots a live curve with its interval, its newest point, a level and marked events over the time of the run. A legend
/// names what is shown. Text and background have the colours of the window's palette.
class CurveView : public QwtPlot {
 public:
  /// `interval`, `floor`: names of the interval and of the level in the legend; empty: the curve has none.
  CurveView(const QColor& colour, const QString& interval, const QString& floor, QWidget* parent);

  /// `name`: of the curve, in the legend. `axis`: title of the vertical axis, with the unit of the values.
  /// `floor`: a level that is drawn as a dashed line; NaN for none.
  void show_curve(const LiveCurve& curve, const QString& name, const QString& axis,
                  double floor = std::numeric_limits<double>::quiet_NaN());
  QSize sizeHint() const override { return {320, 170}; }
  QSize minimumSizeHint() const override { return {160, 120}; }

 private:
  void scale_axes(const LiveCurve& curve, double floor);
  void mark_events(const LiveCurve& curve);

  // The plot owns what is attached to it.
  QwtPlotIntervalCurve* band_;
  QwtPlotCurve *floor_, *line_, *newest_;
  QwtPlotTextLabel* waiting_;
};

}  // namespace tissue_stiffness
