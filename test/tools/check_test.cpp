// The check of a set-up on the demo's input, as it is and with one thing wrong at a time.
#include <geometry_msgs/WrenchStamped.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/PointCloud2.h>

#include <cmath>
#include <cstring>
#include <functional>

#include "outcome.hpp"
#include "workbench.hpp"

namespace tissue_stiffness {
namespace {

const std::string kDemo = std::string(TISSUE_STIFFNESS_SOURCE_DIR) + "/config/demo/";

/// What becomes of a message of the demo's recording, and when it was recorded.
struct Altered {
  std::string topic;
  ros::Time arrival;
  sensor_msgs::PointCloud2::Ptr cloud;  ///< one of both
  geometry_msgs::WrenchStamped::Ptr wrench;
  bool kept = true;
};
using Alter = std::function<void(Altered&)>;

class CheckTool : public Workbench {
 protected:
  /// The demo's recording with every message altered.
  std::string recording(const Alter& alter) const {
    const rosbag::Bag from(kDemo + "recording.bag");
    rosbag::Bag to(path("altered.bag"), rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(from)) {
      Altered now{message.getTopic(), message.getTime(), message.instantiate<sensor_msgs::PointCloud2>(),
                  message.instantiate<geometry_msgs::WrenchStamped>()};
      alter(now);
      if (!now.kept) continue;
      if (now.cloud) to.write(now.topic, now.arrival, *now.cloud);
      if (now.wrench) to.write(now.topic, now.arrival, *now.wrench);
    }
    to.close();
    return path("altered.bag");
  }

  /// The demo's model with `from` replaced, its mesh where it is.
  std::string model(const std::string& from, const std::string& to) const {
    std::ifstream stream(kDemo + "model.yaml");
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    const auto replace = [&](const std::string& old, const std::string& now) {
      EXPECT_NE(text.find(old), std::string::npos) << old;
      text.replace(text.find(old), old.size(), now);
    };
    replace(from, to);
    if (text.find("file: mesh.vtk") != std::string::npos) replace("file: mesh.vtk", "file: " + kDemo + "mesh.vtk");
    return write("altered.yaml", text);
  }

  /// Exit code 2, and one line with all the words.
  ::testing::AssertionResult finds(const std::string& model, const std::string& recording,
                                   const std::vector<std::string>& words) const {
    Outcome outcome = call("check --allow-outside " + model + " " + recording);
    if (outcome.code != 2) return ::testing::AssertionFailure() << "exit code " << outcome.code << ": " << outcome.text;
    if (!outcome.text.empty() && outcome.text.back() == '\n') outcome.text.pop_back();
    return says(outcome.text, words);
  }
  ::testing::AssertionResult finds_in_bag(const Alter& alter, const std::vector<std::string>& words) const {
    return finds(kDemo + "model.yaml", recording(alter), words);
  }
  ::testing::AssertionResult finds_in_model(const std::string& from, const std::string& to,
                                            const std::vector<std::string>& words) const {
    return finds(model(from, to), kDemo + "recording.bag", words);
  }
};

void scale_points(sensor_msgs::PointCloud2& cloud, double by, double shift) {
  for (const sensor_msgs::PointField& field : cloud.fields) {
    if (field.name.size() != 1) continue;  // x, y, z
    for (std::size_t at = field.offset; at < cloud.data.size(); at += cloud.point_step) {
      if (field.datatype == sensor_msgs::PointField::FLOAT64) {
        double value;
        std::memcpy(&value, &cloud.data[at], sizeof value);
        value = by * value + shift;
        std::memcpy(&cloud.data[at], &value, sizeof value);
      } else {
        float value;
        std::memcpy(&value, &cloud.data[at], sizeof value);
        value = static_cast<float>(by * static_cast<double>(value) + shift);
        std::memcpy(&cloud.data[at], &value, sizeof value);
      }
    }
  }
}

void scale_force(geometry_msgs::Vector3& force, double by) {
  force.x *= by;
  force.y *= by;
  force.z *= by;
}

TEST_F(CheckTool, SaysNothingOfTheDemo) {
  const Outcome outcome = call("check " + kDemo + "model.yaml " + kDemo + "recording.bag");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.text, "nothing found\n");
  EXPECT_EQ(call("check --quiet " + kDemo + "model.yaml").text, "");
}

TEST_F(CheckTool, NamesAMissingTopicWithTheSimilarOne) {
  EXPECT_TRUE(finds_in_model(
      "topic: /tool/wrench", "topic: /tool/wrenches",
      {"the recording lacks the topic /tool/wrenches", "did you mean `/tool/wrench`", "geometry_msgs/WrenchStamped"}));
}

TEST_F(CheckTool, NamesATopicThatStopped) {
  const auto stop = [](Altered& now) { now.kept = !now.wrench || now.arrival.toSec() < 1700000001.0; };
  EXPECT_TRUE(finds_in_bag(stop, {"/tool/wrench stopped", "before the other topics"}));
}

TEST_F(CheckTool, NamesCloudsInMillimetres) {
  const auto millimetres = [](Altered& now) {
    if (now.cloud) scale_points(*now.cloud, 1e3, 0.0);
  };
  EXPECT_TRUE(finds_in_bag(millimetres, {"/tissue/vertices", "if the cloud is in mm"}));
}

TEST_F(CheckTool, NamesAMeshInMillimetresBeforeItIsFilled) {
  const std::string surface = std::string(TISSUE_STIFFNESS_TEST_DATA) + "/meshing/cube.obj";
  const std::string mesh = "file: " + surface + ", scale: 100, max_edge_length: 0.01";
  EXPECT_TRUE(finds(model("file: mesh.vtk", mesh), "", {"mesh.scale (100)", "is in mm", "scale: 0.1"}));
}

TEST_F(CheckTool, NamesAFirstFrameOffTheMesh) {
  const auto shift = [](Altered& now) {
    if (now.cloud) scale_points(*now.cloud, 1.0, 0.02);
  };
  EXPECT_TRUE(finds_in_bag(shift, {"/tissue/vertices", "34.", "off the mesh", "a shift of [-"}));
}

TEST_F(CheckTool, NamesAForceOfTheWrongSign) {
  const auto turn = [](Altered& now) {
    if (now.wrench) scale_force(now.wrench->wrench.force, -1.0);
  };
  EXPECT_TRUE(finds_in_bag(turn, {"/tool/wrench", "runs against the force", "scale: -1"}));
}

TEST_F(CheckTool, NamesAForceInMillinewton) {
  const auto millinewton = [](Altered& now) {
    if (now.wrench) scale_force(now.wrench->wrench.force, 1e3);
  };
  EXPECT_TRUE(finds_in_bag(millinewton, {"/tool/wrench", "mN", "scale: 0.001"}));
}

TEST_F(CheckTool, NamesClocksThatAreApart) {
  const auto late = [](Altered& now) {
    if (now.wrench) now.wrench->header.stamp += ros::Duration(100.0);
  };
  EXPECT_TRUE(finds_in_bag(late, {"/tool/wrench", "share no instant", "clocks"}));
  const auto ahead = [](Altered& now) {
    if (now.wrench) now.wrench->header.stamp += ros::Duration(1.0);
  };
  EXPECT_TRUE(finds_in_bag(ahead, {"/tool/wrench", "1 s ahead", "clocks"}));
}

TEST_F(CheckTool, NamesAPriorInKilopascal) {
  EXPECT_TRUE(finds_in_model("prior: 24e3", "prior: 24", {"young_modulus", "24 Pa", "kPa"}));
}

TEST_F(CheckTool, NamesADensityInGramsPerCubicCentimetre) {
  EXPECT_TRUE(finds_in_model("density: 1060", "density: 1.06", {"density", "g/cm^3", "write 1060"}));
}

TEST_F(CheckTool, NamesANoiseLargerThanTheMotionOrTenTimesOff) {
  EXPECT_TRUE(finds_in_model("noise: 1e-4", "noise: 0.1", {"noise", "larger than the motion"}));
  EXPECT_TRUE(finds_in_model("noise: 1e-4", "noise: 1e-6", {"noise", "scatter"}));
}

TEST_F(CheckTool, NamesABodyThatNothingHolds) {
  EXPECT_TRUE(finds_in_model("  - fixed: {region: table}\n", "", {"nothing holds the body"}));
}

TEST_F(CheckTool, NamesAFrameThatNoTransformJoins) {
  const auto turn = [](Altered& now) {
    if (now.wrench) now.wrench->header.frame_id = "force_sensor";
  };
  EXPECT_TRUE(finds_in_bag(turn, {"/tool/wrench", "no transform", "`force_sensor`"}));
}

TEST_F(CheckTool, SaysTheSameBeforeAnEstimateAndADiagnosis) {
  const std::string wrong =
      model("noise: 1e-4", "noise: 0.1") + " " + kDemo + "recording.bag --quiet --allow-outside --output " + path("out");
  for (const std::string tool : {"estimate", "diagnose"}) {
    const Outcome outcome = call(tool + " " + wrong);
    EXPECT_NE(outcome.text.find(tool + ": warning: "), std::string::npos) << outcome.text;
    EXPECT_NE(outcome.text.find("larger than the motion"), std::string::npos) << outcome.text;
  }
}

}  // namespace
}  // namespace tissue_stiffness
