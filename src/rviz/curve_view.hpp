#pragma once

#include <QColor>
#include <QString>
#include <QWidget>
#include <limits>

#include "rviz/live_curve.hpp"

class QPainter;

namespace tissue_stiffness {

/// Draws a live curve with its interval, round axis values and marked events, in the colours of the window's palette.
class CurveView : public QWidget {
 public:
  /// `title`: text above the curve; the unit is added.
  CurveView(QString title, QColor colour, QWidget* parent);

  /// `floor`: a level that is drawn as a dashed line; NaN for none.
  void show_curve(const LiveCurve& curve, const QString& unit, double floor = std::numeric_limits<double>::quiet_NaN());
  QSize sizeHint() const override { return {320, 130}; }
  QSize minimumSizeHint() const override { return {160, 90}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  struct Axes;
  void draw_axes(QPainter& painter, const Axes& axes) const;
  void draw_curve(QPainter& painter, const Axes& axes) const;
  void draw_events(QPainter& painter, const Axes& axes) const;

  QString title_, unit_;
  QColor colour_;
  LiveCurve curve_;
  double floor_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace tissue_stiffness
