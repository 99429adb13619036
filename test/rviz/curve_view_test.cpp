// The plots on Qt's offscreen platform, which needs no display.
#include "rviz/curve_view.hpp"

#include <gtest/gtest.h>
#include <qwt_legend.h>
#include <qwt_legend_label.h>
#include <qwt_plot_curve.h>
#include <qwt_plot_intervalcurve.h>
#include <qwt_plot_marker.h>
#include <qwt_plot_textlabel.h>

#include <QApplication>
#include <QImage>
#include <QLayout>
#include <cmath>
#include <limits>

namespace tissue_stiffness {
namespace {

const QColor kColour(0x00, 0x72, 0xb2);

class CurvePlot : public ::testing::Test {
 protected:
  void SetUp() override {
    qputenv("QT_QPA_PLATFORM", "offscreen");
    static int count = 1;
    static char name[] = "test_rviz";
    static char* arguments[] = {name, nullptr};
    static QApplication application(count, arguments);
  }
  template <typename Item>
  static std::vector<Item*> items(const CurveView& view, int kind) {
    std::vector<Item*> out;
    for (QwtPlotItem* item : view.itemList(kind)) out.push_back(static_cast<Item*>(item));
    return out;
  }
  static QwtPlotCurve* curve(const CurveView& view, const QString& name) {
    for (auto* item : items<QwtPlotCurve>(view, QwtPlotItem::Rtti_PlotCurve)) {
      if (item->title().text() == name) return item;
    }
    throw std::runtime_error("no curve " + name.toStdString());
  }
  static QStringList legend(const CurveView& view) {
    const QLayout& entries = *static_cast<const QwtLegend*>(view.legend())->contentsWidget()->layout();
    QStringList out;
    for (int i = 0; i < entries.count(); ++i) {
      out << static_cast<QwtLegendLabel*>(entries.itemAt(i)->widget())->text().text();
    }
    out.sort();
    return out;
  }
  static int pixels(CurveView& view, const QColor& colour) {
    view.resize(400, 200);
    const QImage image = view.grab().toImage();
    int out = 0;
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) out += image.pixelColor(x, y) == colour ? 1 : 0;
    }
    return out;
  }
};

LiveCurve falling() {
  LiveCurve out;
  out.add({100.0, 24.0, 3.0, 190.0});
  out.add({101.0, 14.0, 13.0, 15.0});
  out.add({102.0, 12.0, std::nan(""), std::numeric_limits<double>::infinity()});
  return out;
}

TEST_F(CurvePlot, ShowsCurveBandAndUnitsOverTheTimeOfTheRun) {
  CurveView view(kColour, "95 % interval", "", nullptr);
  view.show_curve(falling(), "Young's modulus", "E [kPa]");
  const QwtPlotCurve* line = curve(view, "Young's modulus");
  ASSERT_EQ(line->dataSize(), 3U);
  EXPECT_EQ(line->sample(1), QPointF(1.0, 14.0));
  const auto bands = items<QwtPlotIntervalCurve>(view, QwtPlotItem::Rtti_PlotIntervalCurve);
  ASSERT_EQ(bands.size(), 1U);
  EXPECT_EQ(bands[0]->sample(1).interval, QwtInterval(13.0, 15.0));
  EXPECT_EQ(bands[0]->sample(2).interval, QwtInterval(12.0, 12.0)) << "bounds that are not finite";
  EXPECT_EQ(view.axisTitle(QwtPlot::yLeft).text(), "E [kPa]");
  EXPECT_EQ(view.axisTitle(QwtPlot::xBottom).text(), "time of the run [s]");
  EXPECT_EQ(view.axisInterval(QwtPlot::xBottom), QwtInterval(0.0, 2.0));
  EXPECT_GE(view.axisInterval(QwtPlot::yLeft).maxValue(), 24.0);
  EXPECT_LT(view.axisInterval(QwtPlot::yLeft).maxValue(), 60.0) << "the band flattens the curve";
  EXPECT_EQ(legend(view), QStringList({"95 % interval", "Young's modulus"}));
  EXPECT_GT(pixels(view, kColour), 50);
}

TEST_F(CurvePlot, WaitsForFramesAndShowsNothingElse) {
  CurveView view(kColour, "", "noise alone", nullptr);
  view.show_curve(LiveCurve(), "misfit", "misfit [mm]", 0.2);
  const auto texts = items<QwtPlotTextLabel>(view, QwtPlotItem::Rtti_PlotTextLabel);
  ASSERT_EQ(texts.size(), 1U);
  EXPECT_TRUE(texts[0]->isVisible());
  EXPECT_EQ(texts[0]->text().text(), "waiting for frames");
  EXPECT_EQ(curve(view, "misfit")->dataSize(), 0U);
  EXPECT_EQ(legend(view), QStringList({"misfit"}));
  view.show_curve(falling(), "misfit", "misfit [mm]");
  EXPECT_FALSE(texts[0]->isVisible());
}

TEST_F(CurvePlot, TheLevelIsALineAcrossTheRunWhereThereIsOne) {
  CurveView view(kColour, "", "noise alone", nullptr);
  view.show_curve(falling(), "misfit", "misfit [mm]", 0.2);
  const QwtPlotCurve* floor = curve(view, "noise alone");
  ASSERT_EQ(floor->dataSize(), 2U);
  EXPECT_EQ(floor->sample(0), QPointF(0.0, 0.2));
  EXPECT_EQ(floor->sample(1), QPointF(2.0, 0.2));
  EXPECT_EQ(view.axisInterval(QwtPlot::yLeft).minValue(), 0.0) << "the level is below the values";
  EXPECT_EQ(legend(view), QStringList({"misfit", "noise alone"}));
  view.show_curve(falling(), "misfit", "misfit [mm]");
  EXPECT_EQ(floor->dataSize(), 0U);
  EXPECT_EQ(legend(view), QStringList({"misfit"}));
}

TEST_F(CurvePlot, MarksEventsOnce) {
  CurveView view(kColour, "", "", nullptr);
  LiveCurve curve = falling();
  curve.mark("+ gravity");
  for (int i = 0; i < 3; ++i) view.show_curve(curve, "E", "E [kPa]");
  const auto marks = items<QwtPlotMarker>(view, QwtPlotItem::Rtti_PlotMarker);
  ASSERT_EQ(marks.size(), 1U);
  EXPECT_EQ(marks[0]->xValue(), 2.0);
  EXPECT_EQ(marks[0]->label().text(), "+ gravity");
  EXPECT_TRUE(marks[0]->labelAlignment() & Qt::AlignLeft) << "the label leaves the plot at the right";
}

}  // namespace
}  // namespace tissue_stiffness
