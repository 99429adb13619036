// rviz's own window with the shipped config: presses the panel's buttons and sees the error fall.
#include <OgreCamera.h>
#include <OgreMatrix4.h>
#include <OgreVector4.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <geometry_msgs/Point.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rviz/config.h>
#include <rviz/display.h>
#include <rviz/display_group.h>
#include <rviz/panel.h>
#include <rviz/properties/status_property.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_frame.h>
#include <rviz/visualization_manager.h>
#include <rviz/yaml_config_reader.h>
#include <tissue_stiffness/TetMesh.h>
#include <visualization_msgs/Marker.h>

#include <QApplication>
#include <QDockWidget>
#include <QElapsedTimer>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QRegularExpression>
#include <QTemporaryDir>
#include <QTimer>
#include <QTreeWidget>
#include <QtTest/QTest>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace {

constexpr float kDistanceOfConfig = 0.25F;  // m, in rviz/*.rviz
constexpr int kPatience = 300000;           // ms: on a busy machine; a free one needs a thirtieth

class PanelInRviz : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    frame_ = std::make_unique<rviz::VisualizationFrame>();
    frame_->setSplashPath("");
    frame_->initialize(QString(TISSUE_STIFFNESS_SOURCE_DIR) + "/rviz/points.rviz");
    frame_->show();
    panel_ = frame_->findChild<rviz::Panel*>("tissue_stiffness_panel");
  }
  static void TearDownTestSuite() { frame_.reset(); }

  void SetUp() override { ASSERT_NE(panel_, nullptr) << "rviz did not load the panel"; }

  template <typename Widget>
  static Widget* part(const char* name) {
    auto* found = panel_->findChild<Widget*>(name);
    if (found == nullptr) throw std::runtime_error(std::string("the panel has no ") + name);
    return found;
  }
  static std::string label(const char* name) { return part<QLabel>(name)->text().toStdString(); }
  static bool wait_for(const std::function<bool()>& condition) {
    return QTest::qWaitFor([&] { return condition(); }, kPatience);
  }
  /// A diagnosis comes as a message before its service answers, and until then a click is lost.
  static void press(const char* name) {
    auto* button = part<QPushButton>(name);
    ASSERT_TRUE(wait_for([&] { return button->isEnabled(); })) << name << " stays disabled: " << label("status");
    QTest::mouseClick(button, Qt::LeftButton);
  }
  /// The number that follows `before` in a label; -1 when there is none.
  static double number(const char* name, const QString& before) {
    const auto match = QRegularExpression(before + "([0-9.]+)").match(part<QLabel>(name)->text());
    return match.hasMatch() ? match.captured(1).toDouble() : -1.0;
  }
  static double misfit() { return number("misfit", "misfit "); }
  static QString row(int index, int column) {
    const QTreeWidgetItem* item = part<QTreeWidget>("effects")->topLevelItem(index);
    return item != nullptr ? item->text(column) : QString();
  }
  /// Until nothing has changed for two seconds.
  static void wait_for_the_end_of_the_replay() {
    ASSERT_TRUE(wait_for([] { return label("state") != "no data"; })) << "no estimate came";
    std::string last;
    QElapsedTimer still;
    still.start();
    ASSERT_TRUE(wait_for([&] {
      const std::string now = label("headline") + label("misfit");
      if (now != last) still.restart();
      last = now;
      return still.elapsed() > 2000;
    })) << "the replay did not end";
  }

  static rviz::ViewController* view() { return frame_->getManager()->getViewManager()->getCurrent(); }
  static float distance() { return view()->subProp("Distance")->getValue().toFloat(); }
  static bool subscribes_to(const std::string& topic) {
    std::vector<std::string> topics;
    ros::this_node::getSubscribedTopics(topics);
    return std::find(topics.begin(), topics.end(), topic) != topics.end();
  }
  /// How far from the middle of rviz's picture (0) to its edge (1) the farthest of these points is seen.
  static double farthest_in_picture(const std::vector<geometry_msgs::Point>& points) {
    const Ogre::Camera& camera = *view()->getCamera();
    float out = 0.0F;
    for (const geometry_msgs::Point& point : points) {
      const Ogre::Vector4 place(static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z),
                                1.0F);
      const Ogre::Vector4 seen = camera.getProjectionMatrix() * (camera.getViewMatrix() * place);
      if (seen.w <= 0.0F) return std::numeric_limits<double>::infinity();
      out = std::max({out, std::abs(seen.x / seen.w), std::abs(seen.y / seen.w)});
    }
    return out;
  }
  /// Enters a namespace into the panel, as a user does.
  static void enter_namespace(const QString& name) {
    auto* place = part<QLineEdit>("namespace");
    place->setText(name);
    QTest::keyClick(place, Qt::Key_Return);
  }
  /// What a config that is saved now holds of our panel.
  static rviz::Config saved_panel() {
    QTemporaryDir folder;
    const QString file = folder.filePath("saved.rviz");
    EXPECT_TRUE(frame_->saveDisplayConfig(file));
    rviz::Config saved;
    rviz::YamlConfigReader().readFile(saved, file);
    const rviz::Config panels = saved.mapGetChild("Panels");
    for (int i = 0; i < panels.listLength(); ++i) {
      QString type;
      panels.listChildAt(i).mapGetString("Class", &type);
      if (type == "tissue_stiffness/Stiffness") return panels.listChildAt(i);
    }
    return {};
  }
  static bool saves_whole_body() {
    bool out = false;
    EXPECT_TRUE(saved_panel().mapGetBool("Show Whole Body", &out));
    return out;
  }

  static std::unique_ptr<rviz::VisualizationFrame> frame_;
  static rviz::Panel* panel_;
};

/// A surface far from the origin and larger than the demo's body, in the model's frame.
visualization_msgs::Marker large_body() {
  visualization_msgs::Marker out;
  out.header.frame_id = "model";
  for (int i = 0; i < 9; ++i) {
    geometry_msgs::Point point;
    point.x = 5.0 + (i % 2);
    point.y = -3.0 + (i / 2 % 2);
    point.z = 0.5 * (i / 4 % 2);
    out.points.push_back(point);
  }
  return out;
}

std::unique_ptr<rviz::VisualizationFrame> PanelInRviz::frame_;
rviz::Panel* PanelInRviz::panel_ = nullptr;

TEST_F(PanelInRviz, T1_ShowsTheEstimateOfTheRun) {
  wait_for_the_end_of_the_replay();
  EXPECT_NE(label("headline").find("kPa"), std::string::npos) << label("headline");
  EXPECT_NE(label("interval").find("95 %"), std::string::npos) << label("interval");
  EXPECT_GT(misfit(), 0.0) << label("misfit");
  EXPECT_EQ(label("verdict"), "not diagnosed yet");
  EXPECT_FALSE(part<QPushButton>("add")->isEnabled());
  EXPECT_FALSE(part<QPushButton>("remove")->isEnabled());
}

void expect_no_errors(rviz::VisualizationFrame& frame) {
  rviz::DisplayGroup* displays = frame.getManager()->getRootDisplayGroup();
  ASSERT_GE(displays->numDisplays(), 4);
  for (int i = 0; i < displays->numDisplays(); ++i) {
    rviz::Display* display = displays->getDisplayAt(i);
    const auto* status = dynamic_cast<rviz::StatusProperty*>(display->childAt(0));
    if (!display->isEnabled() || status == nullptr) continue;
    EXPECT_NE(status->getLevel(), rviz::StatusProperty::Error) << display->getNameStd();
  }
}

TEST_F(PanelInRviz, T1_TheBodyIsInView) {
  const auto mesh = ros::topic::waitForMessage<tissue_stiffness::TetMesh>("/mesh", ros::Duration(60));
  ASSERT_TRUE(mesh);
  ASSERT_TRUE(wait_for([] { return distance() != kDistanceOfConfig; })) << "the view did not turn to the surface";
  EXPECT_LT(farthest_in_picture(mesh->nodes), 1.0);
  EXPECT_GT(farthest_in_picture(mesh->nodes), 0.3) << "the body is small in the picture";
}

TEST_F(PanelInRviz, T2_NoDisplayOfTheConfigIsInError) {
  expect_no_errors(*frame_);
}

TEST_F(PanelInRviz, T3_DiagnoseNamesTheHiddenEffectAndNeverBlocksTheWindow) {
  QElapsedTimer pressed, beat;
  qint64 longest = 0;
  QTimer timer;
  QObject::connect(&timer, &QTimer::timeout, [&] { longest = std::max(longest, beat.restart()); });
  beat.start();
  timer.start(10);
  ASSERT_TRUE(wait_for([] { return part<QPushButton>("diagnose")->isEnabled(); })) << label("status");
  pressed.start();
  press("diagnose");
  EXPECT_LT(pressed.elapsed(), 500) << "the button waited";
  EXPECT_FALSE(part<QPushButton>("diagnose")->isEnabled());
  EXPECT_NE(label("status").find("searching"), std::string::npos) << label("status");
  ASSERT_TRUE(wait_for([] { return part<QPushButton>("diagnose")->isEnabled(); })) << label("status");
  std::printf("the answer took %lld ms, the window's longest pause was %lld ms\n",
              static_cast<long long>(pressed.elapsed()), static_cast<long long>(longest));
  if (pressed.elapsed() > 4000) {
    EXPECT_LT(longest, pressed.elapsed() / 2) << "the window stood still";
  }
  ASSERT_TRUE(wait_for([] { return label("verdict") == "found"; })) << label("verdict") << ": " << label("status");
  EXPECT_EQ(row(0, 0), "viscoelasticity");
  EXPECT_TRUE(row(0, 1).contains("%")) << row(0, 1).toStdString();
  EXPECT_TRUE(row(0, 3).contains("→")) << row(0, 3).toStdString();
  EXPECT_FALSE(label("summary").empty());
}

TEST_F(PanelInRviz, T4_AddLetsTheErrorFall) {
  const double before = misfit();
  ASSERT_TRUE(part<QPushButton>("add")->isEnabled());
  press("add");
  ASSERT_TRUE(wait_for([&] { return misfit() < before / 3.0; })) << label("misfit") << ", " << label("status");
  std::printf("misfit %.3f mm before, %.3f mm after, E = %s\n", before, misfit(), label("headline").c_str());
  EXPECT_NEAR(number("headline", ""), 12.0, 0.6) << label("headline");
  ASSERT_TRUE(wait_for([] { return row(0, 0) == "✓ viscoelasticity"; }));
  EXPECT_TRUE(part<QPushButton>("remove")->isEnabled());
  press("diagnose");
  ASSERT_TRUE(wait_for([] { return label("verdict") == "nothing"; })) << label("verdict") << ": " << label("status");
}

TEST_F(PanelInRviz, T5_RemoveBringsItBack) {
  const double low = misfit();
  press("remove");
  ASSERT_TRUE(wait_for([&] { return misfit() > 3.0 * low; })) << label("misfit") << ", " << label("status");
  ASSERT_TRUE(wait_for([] { return label("verdict") == "changed since the last diagnosis"; })) << label("verdict");
  EXPECT_FALSE(part<QPushButton>("remove")->isEnabled());
}

TEST_F(PanelInRviz, T6_ResetAnswers) {
  press("reset");
  ASSERT_TRUE(wait_for([] { return part<QPushButton>("reset")->isEnabled(); }));
  EXPECT_EQ(label("status"), "the next frame starts from the prior");
}

TEST_F(PanelInRviz, T6_TheLegendFollowsTheLimitOfTheColours) {
  ASSERT_TRUE(wait_for([] { return label("colour_limit") == "3 sigma"; })) << label("colour_limit");
  dynamic_reconfigure::Reconfigure change;
  change.request.config.doubles.resize(1);
  change.request.config.doubles[0].name = "colour_limit";
  change.request.config.doubles[0].value = 7.5;
  ASSERT_TRUE(ros::service::call("/estimator_node/set_parameters", change));
  ASSERT_TRUE(wait_for([] { return label("colour_limit") == "7.5 sigma"; })) << label("colour_limit");
}

TEST_F(PanelInRviz, T7_TheNamespaceIsUsedAndSaved) {
  enter_namespace("/nowhere");
  EXPECT_EQ(label("headline"), "-") << "what another estimator said is still shown";
  press("diagnose");
  ASSERT_TRUE(wait_for([] { return part<QPushButton>("diagnose")->isEnabled(); }));
  EXPECT_NE(label("status").find("no service /nowhere/diagnose"), std::string::npos) << label("status");
  QString node_namespace;
  EXPECT_TRUE(saved_panel().mapGetString("Namespace", &node_namespace));
  EXPECT_EQ(node_namespace, "/nowhere");
  enter_namespace("");
  EXPECT_TRUE(wait_for([] { return label("headline") != "-"; })) << "the latched estimate did not come";
}

TEST_F(PanelInRviz, T8_TheViewGoesToAnyBodyUntilTheUserMovesIt) {
  EXPECT_TRUE(saves_whole_body());
  ros::NodeHandle node("/elsewhere");
  ros::Publisher bodies = node.advertise<visualization_msgs::Marker>("tracked_surface", 1, true);
  const visualization_msgs::Marker body = large_body();
  bodies.publish(body);
  EXPECT_GT(farthest_in_picture(body.points), 1.0) << "the view of the demo's body shows this one, too";
  enter_namespace("/elsewhere");
  ASSERT_TRUE(wait_for([&] { return farthest_in_picture(body.points) < 1.0; })) << "the body is out of view";
  EXPECT_GT(farthest_in_picture(body.points), 0.3) << "the body is small in the picture";
  EXPECT_TRUE(saves_whole_body());
  EXPECT_TRUE(wait_for([] { return !subscribes_to("/elsewhere/tracked_surface"); })) << "a body is still waited for";

  view()->subProp("Yaw")->setValue(2.0);
  EXPECT_FALSE(saves_whole_body()) << "the view is the user's now";
  enter_namespace("/other");
  EXPECT_FALSE(subscribes_to("/other/tracked_surface")) << "a surface would move the user's view";
  enter_namespace("");
}

TEST_F(PanelInRviz, T9_TheConfigWithImagesHasThePanelAndBothOutlines) {
  frame_->loadDisplayConfig(QString(TISSUE_STIFFNESS_SOURCE_DIR) + "/rviz/tissue_stiffness.rviz");
  panel_ = frame_->findChild<rviz::Panel*>("tissue_stiffness_panel");
  ASSERT_NE(panel_, nullptr);
  ASSERT_TRUE(wait_for([] { return label("headline") != "-"; })) << "the latched estimate did not come";
  expect_no_errors(*frame_);
  const auto docks = frame_->findChildren<QDockWidget*>();
  EXPECT_TRUE(std::any_of(docks.begin(), docks.end(), [](const QDockWidget* dock) {
    return dock->windowTitle().startsWith("Outlines") && dock->isVisible();
  })) << "the image is not shown";
}

TEST_F(PanelInRviz, T10_ClosesDuringADiagnosis) {
  press("diagnose");
  QTest::qWait(100);
  QElapsedTimer closing;
  closing.start();
  frame_.reset();
  panel_ = nullptr;
  EXPECT_LT(closing.elapsed(), 20000);
  frame_ = nullptr;
}

}  // namespace

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  QApplication application(argc, argv);
  ros::init(argc, argv, "rviz_panel_test", ros::init_options::NoSigintHandler);
  return RUN_ALL_TESTS();
}
