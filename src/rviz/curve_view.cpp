#include "rviz/curve_view.hpp"

#include <qwt_legend.h>
#include <qwt_plot_canvas.h>
#include <qwt_plot_curve.h>
#include <qwt_plot_grid.h>
#include <qwt_plot_intervalcurve.h>
#include <qwt_plot_marker.h>
#include <qwt_plot_textlabel.h>
#include <qwt_scale_draw.h>
#include <qwt_symbol.h>
#include <qwt_text.h>

#include <QFontMetrics>
#include <algorithm>
#include <cmath>

namespace tissue_stiffness {
namespace {

constexpr double kRoom = 0.06;  // of the values' span, above and below them
constexpr int kNewestPixels = 8, kLegendPixels = 16;

QFont small_font(const QFont& font) {
  QFont out = font;
  out.setPointSizeF(std::max(7.0, 0.85 * out.pointSizeF()));
  return out;
}

QwtText label(const QString& text, const QFont& font, const QColor& colour) {
  QwtText out(text);
  out.setFont(font);
  out.setColor(colour);
  return out;
}

QColor with_alpha(QColor colour, double alpha) {
  colour.setAlphaF(alpha);
  return colour;
}

void name_in_legend(QwtPlotItem& item, bool named) {
  item.setItemAttribute(QwtPlotItem::Legend, named);
  item.plot()->updateLegend(&item);  // which Qwt 6.1 leaves out where an item leaves the legend
}

QwtPlotCurve* attach_line(QwtPlot* plot, const QPen& pen) {
  auto* out = new QwtPlotCurve;
  out->setPen(pen);
  out->setRenderHint(QwtPlotItem::RenderAntialiased);
  out->setLegendAttribute(QwtPlotCurve::LegendShowLine);
  out->setLegendIconSize({kLegendPixels, kNewestPixels});
  out->attach(plot);
  return out;
}

QwtPlotIntervalCurve* attach_band(QwtPlot* plot, const QString& name, const QColor& colour) {
  auto* out = new QwtPlotIntervalCurve(name);
  out->setStyle(QwtPlotIntervalCurve::Tube);
  out->setPen(QPen(Qt::NoPen));
  out->setBrush(with_alpha(colour, 0.3));
  out->setLegendIconSize({kLegendPixels, kNewestPixels});
  out->attach(plot);
  name_in_legend(*out, !name.isEmpty());
  return out;
}

}  // namespace

CurveView::CurveView(const QColor& colour, const QString& interval, const QString& floor, QWidget* parent)
    : QwtPlot(parent) {
  const QColor text = palette().color(QPalette::Text);
  setFont(small_font(font()));
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setCanvasBackground(palette().brush(QPalette::Base));
  static_cast<QwtPlotCanvas*>(canvas())->setFrameStyle(QFrame::NoFrame);
  insertLegend(new QwtLegend, QwtPlot::TopLegend);
  for (const int axis : {QwtPlot::xBottom, QwtPlot::yLeft}) {
    setAxisFont(axis, font());
    setAxisMaxMinor(axis, 0);
  }
  axisScaleDraw(QwtPlot::yLeft)->setMinimumExtent(QFontMetrics(font()).horizontalAdvance("0000.00"));
  setAxisTitle(QwtPlot::xBottom, label("time of the run [s]", font(), palette().color(QPalette::WindowText)));
  setAxisMaxMajor(QwtPlot::yLeft, 5);
  auto* grid = new QwtPlotGrid;
  grid->setPen(with_alpha(text, 0.15), 1.0);
  grid->attach(this);
  band_ = attach_band(this, interval, colour);
  floor_ = attach_line(this, QPen(text, 1.5, Qt::DashLine));
  floor_->setTitle(floor);
  line_ = attach_line(this, QPen(colour, 2.0));
  newest_ = attach_line(this, QPen(Qt::NoPen));
  newest_->setSymbol(new QwtSymbol(QwtSymbol::Ellipse, colour, QPen(colour), QSize(kNewestPixels, kNewestPixels)));
  name_in_legend(*newest_, false);
  waiting_ = new QwtPlotTextLabel;
  waiting_->setText(label("waiting for frames", font(), palette().color(QPalette::Disabled, QPalette::Text)));
  waiting_->attach(this);
}

void CurveView::show_curve(const LiveCurve& curve, const QString& name, const QString& axis, double floor) {
  const double start = curve.times().low;
  QVector<QPointF> values;
  QVector<QwtIntervalSample> intervals;
  for (const LiveCurve::Point& point : curve.points()) {
    const double time = point.time - start;
    values.append({time, point.value});
    intervals.append({time, std::isfinite(point.lower) ? point.lower : point.value,
                      std::isfinite(point.upper) ? point.upper : point.value});
  }
  line_->setTitle(name);
  line_->setSamples(values);
  newest_->setSamples(values.mid(values.size() - 1));
  band_->setSamples(intervals);
  waiting_->setVisible(values.isEmpty());
  const bool has_floor = std::isfinite(floor) && !values.isEmpty();
  name_in_legend(*floor_, has_floor);
  floor_->setSamples(has_floor ? QVector<QPointF>{{0.0, floor}, {curve.times().high - start, floor}} : QVector<QPointF>());
  setAxisTitle(QwtPlot::yLeft, label(axis, font(), palette().color(QPalette::WindowText)));
  mark_events(curve);
  scale_axes(curve, floor);
  replot();
}

void CurveView::scale_axes(const LiveCurve& curve, double floor) {
  LiveCurve::Range values = curve.values();
  const bool near_floor = floor < values.low && values.low > 0.0;
  if (near_floor) values.low = 0.0;
  const double room = kRoom * (values.high - values.low);
  setAxisScale(QwtPlot::yLeft, near_floor ? values.low : values.low - room, values.high + room);
  setAxisScale(QwtPlot::xBottom, 0.0, curve.times().high - curve.times().low);
}

void CurveView::mark_events(const LiveCurve& curve) {
  detachItems(QwtPlotItem::Rtti_PlotMarker);
  const LiveCurve::Range times = curve.times();
  const QColor text = palette().color(QPalette::Text);
  for (const LiveCurve::Event& event : curve.events()) {
    auto* mark = new QwtPlotMarker;
    mark->setLineStyle(QwtPlotMarker::VLine);
    mark->setLinePen(text, 1.0, Qt::DotLine);
    mark->setXValue(event.time - times.low);
    mark->setLabel(label(QString::fromStdString(event.text), font(), text));
    const bool in_right_half = event.time > 0.5 * (times.low + times.high);
    mark->setLabelAlignment(Qt::AlignTop | (in_right_half ? Qt::AlignLeft : Qt::AlignRight));
    mark->attach(this);
  }
}

}  // namespace tissue_stiffness
