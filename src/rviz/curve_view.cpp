#include "rviz/curve_view.hpp"

#include <QFontMetrics>
#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <cmath>

namespace tissue_stiffness {

/// Mapping from data to positions in the widget.
struct CurveView::Axes {
  QRectF plot;
  LiveCurve::Range times, values;

  double x(double time) const { return plot.left() + (time - times.low) / (times.high - times.low) * plot.width(); }
  double y(double value) const { return plot.bottom() - (value - values.low) / (values.high - values.low) * plot.height(); }
  QPointF at(double time, double value) const { return {x(time), std::clamp(y(value), plot.top(), plot.bottom())}; }
};

CurveView::CurveView(QString title, QColor colour, QWidget* parent)
    : QWidget(parent), title_(std::move(title)), colour_(std::move(colour)) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

void CurveView::show_curve(const LiveCurve& curve, const QString& unit, double floor) {
  curve_ = curve;
  unit_ = unit;
  floor_ = floor;
  update();
}

void CurveView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  QFont small = font();
  small.setPointSizeF(std::max(7.0, 0.85 * small.pointSizeF()));
  painter.setFont(small);
  const QFontMetrics metrics(small);
  const double line = metrics.height();
  const double left = metrics.horizontalAdvance("0000.0");
  Axes axes{QRectF(left, line + 6, width() - left - 10, height() - 2 * line - 12), curve_.times(), curve_.values()};
  const bool near_floor = floor_ < axes.values.low && axes.values.low > 0.0;
  if (near_floor) axes.values.low = 0.0;
  const double room = 0.06 * (axes.values.high - axes.values.low);
  axes.values.high += room;
  if (!near_floor) axes.values.low -= room;
  painter.setPen(palette().color(QPalette::WindowText));
  painter.drawText(QRectF(4, 0, width() - 8, line), Qt::AlignLeft, unit_.isEmpty() ? title_ : title_ + " [" + unit_ + "]");
  painter.fillRect(axes.plot, palette().color(QPalette::Base));
  if (curve_.points().empty()) {
    painter.setPen(palette().color(QPalette::Disabled, QPalette::WindowText));
    painter.drawText(axes.plot, Qt::AlignCenter, "waiting for frames");
    return;
  }
  draw_axes(painter, axes);
  painter.setClipRect(axes.plot.adjusted(0, -2, 6, 2));
  draw_curve(painter, axes);
  draw_events(painter, axes);
}

void CurveView::draw_axes(QPainter& painter, const Axes& axes) const {
  const double line = painter.fontMetrics().height();
  const QColor text = palette().color(QPalette::WindowText);
  QColor grid = text;
  grid.setAlphaF(0.15);
  for (const double value : axis_ticks(axes.values, std::max(2, static_cast<int>(axes.plot.height() / (1.6 * line))))) {
    painter.setPen(grid);
    painter.drawLine(QPointF(axes.plot.left(), axes.y(value)), QPointF(axes.plot.right(), axes.y(value)));
    painter.setPen(text);
    painter.drawText(QRectF(0, axes.y(value) - 0.5 * line, axes.plot.left() - 4, line), Qt::AlignRight | Qt::AlignVCenter,
                     QString::number(std::abs(value) < 1e-12 ? 0.0 : value, 'g', 4));
  }
  const LiveCurve::Range since_start{0.0, axes.times.high - axes.times.low};
  for (const double time : axis_ticks(since_start, std::max(2, static_cast<int>(axes.plot.width() / 60.0)))) {
    const double x = axes.x(axes.times.low + time);
    painter.setPen(grid);
    painter.drawLine(QPointF(x, axes.plot.top()), QPointF(x, axes.plot.bottom()));
    painter.setPen(text);
    painter.drawText(QRectF(std::min(x - 30, width() - 62.0), axes.plot.bottom() + 2, 60, line), Qt::AlignCenter,
                     QString::number(time, 'g', 4) + " s");
  }
}

void CurveView::draw_curve(QPainter& painter, const Axes& axes) const {
  const std::vector<LiveCurve::Point>& points = curve_.points();
  QPainterPath path;
  QPolygonF band;
  for (const LiveCurve::Point& point : points) {
    const QPointF at = axes.at(point.time, point.value);
    if (band.isEmpty()) {
      path.moveTo(at);
    } else {
      path.lineTo(at);
    }
    band << axes.at(point.time, std::isfinite(point.upper) ? point.upper : point.value);
  }
  for (auto point = points.rbegin(); point != points.rend(); ++point) {
    band << axes.at(point->time, std::isfinite(point->lower) ? point->lower : point->value);
  }
  QColor light = colour_;
  light.setAlphaF(0.25);
  painter.setPen(Qt::NoPen);
  painter.setBrush(light);
  painter.drawPolygon(band);
  if (std::isfinite(floor_) && floor_ < axes.values.high) {
    painter.setPen(QPen(palette().color(QPalette::WindowText), 1, Qt::DashLine));
    painter.drawLine(QPointF(axes.plot.left(), axes.y(floor_)), QPointF(axes.plot.right(), axes.y(floor_)));
  }
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(colour_, 2));
  painter.drawPath(path);
  painter.setPen(Qt::NoPen);
  painter.setBrush(colour_);
  painter.drawEllipse(axes.at(points.back().time, points.back().value), 4, 4);
}

void CurveView::draw_events(QPainter& painter, const Axes& axes) const {
  const double line = painter.fontMetrics().height();
  const QColor text = palette().color(QPalette::WindowText);
  for (const LiveCurve::Event& event : curve_.events()) {
    const double x = axes.x(event.time);
    painter.setPen(QPen(text, 1, Qt::DotLine));
    painter.drawLine(QPointF(x, axes.plot.top()), QPointF(x, axes.plot.bottom()));
    painter.setPen(text);
    const QString label = QString::fromStdString(event.text);
    const double room = painter.fontMetrics().horizontalAdvance(label) + 6.0;
    const bool to_the_left = x + room > axes.plot.right();
    painter.drawText(QRectF(to_the_left ? x - room : x + 4, axes.plot.top(), room, line), Qt::AlignLeft, label);
  }
}

}  // namespace tissue_stiffness
