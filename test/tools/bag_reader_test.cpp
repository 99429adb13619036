#include "tools/bag_reader.hpp"

#include <geometry_msgs/WrenchStamped.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdint>
#include <map>
#include <vector>

#include "tissue_stiffness/types/error.hpp"
#include "tools/recording_writer.hpp"
#include "workbench.hpp"

namespace {

/// Calls itself a cloud, and ends after four bytes.
struct BrokenCloud {};

}  // namespace

namespace ros {
namespace message_traits {
template <>
struct IsMessage<BrokenCloud> : TrueType {};
template <>
struct DataType<BrokenCloud> : DataType<sensor_msgs::PointCloud2> {
  static const char* value(const BrokenCloud&) { return DataType<sensor_msgs::PointCloud2>::value(); }
};
template <>
struct MD5Sum<BrokenCloud> : MD5Sum<sensor_msgs::PointCloud2> {
  static const char* value(const BrokenCloud&) { return MD5Sum<sensor_msgs::PointCloud2>::value(); }
};
template <>
struct Definition<BrokenCloud> : Definition<sensor_msgs::PointCloud2> {
  static const char* value(const BrokenCloud&) { return Definition<sensor_msgs::PointCloud2>::value(); }
};
}  // namespace message_traits
namespace serialization {
template <>
struct Serializer<BrokenCloud> {
  template <typename Stream>
  static void write(Stream& stream, const BrokenCloud&) {
    stream.next(std::uint32_t{7});
  }
  static std::uint32_t serializedLength(const BrokenCloud&) { return 4; }
};
}  // namespace serialization
}  // namespace ros

namespace tissue_stiffness {
namespace {

const ros::Time kStart(1000, 0);

ros::Time at(double seconds) {
  return kStart + ros::Duration(seconds);
}

class BagReaderTest : public Workbench {
 protected:
  void SetUp() override {
    Workbench::SetUp();
    settings_ = load_model(write_model("model.yaml", "{prior: 4e5, factor: 3}", vertices()));
  }

  static void write_vertex(RecordingWriter& writer, double seconds, double x,
                           const std::string& topic = "/tissue/vertices") {
    writer.write_cloud(topic, at(seconds), Eigen::Vector3d(x, 0, 0), Eigen::VectorXi::Constant(1, 3), "vertex");
  }

  BagReader open() const { return BagReader(path("recording.bag"), settings_); }

  ModelSettings settings_;
};

TEST_F(BagReaderTest, GivesFramesInTheOrderOfTheirStamps) {
  {  // recorded in the wrong order
    rosbag::Bag bag(path("recording.bag"), rosbag::bagmode::Write);
    for (const int k : {0, 2, 1, 3}) {
      sensor_msgs::PointCloud2 cloud;
      {
        RecordingWriter writer(path("one.bag"));
        write_vertex(writer, 0.1 * k, k);
        writer.close();
      }
      rosbag::Bag one(path("one.bag"));
      rosbag::View view(one);
      cloud = *view.begin()->instantiate<sensor_msgs::PointCloud2>();
      static double record_time = 0.0;
      bag.write("/tissue/vertices", at(record_time += 0.01), cloud);
    }
  }
  BagReader reader = open();
  EXPECT_DOUBLE_EQ(reader.first_stamp(), 1000.0);
  EXPECT_EQ(reader.frame_count(), 4U);
  for (int k = 0; k < 4; ++k) {
    const auto instant = reader.next();
    ASSERT_TRUE(instant);
    EXPECT_NEAR(instant->frame.time, 1000.0 + 0.1 * k, 1e-6);
    ASSERT_EQ(instant->frame.observations.size(), 1U);
    EXPECT_EQ(instant->frame.observations[0].ids[0], 3);
    EXPECT_NEAR(instant->frame.observations[0].points(0, 0), k, 1e-6);
  }
  EXPECT_FALSE(reader.next());
}

TEST_F(BagReaderTest, MergesObservationsOfOneStampAndLeavesOutWhatIsFarBack) {
  settings_ = load_model(
      write_model("two.yaml", "{prior: 4e5, factor: 3}", vertices() + "- vertices: {topic: /other, noise: 1e-3}\n"));
  {
    RecordingWriter writer(path("recording.bag"));
    write_vertex(writer, 0.0, 1.0);
    write_vertex(writer, 0.0, 2.0, "/other");
    for (int k = 1; k < 10; ++k) write_vertex(writer, 0.2 * k, 1.0);
    writer.close();
  }
  {
    rosbag::Bag bag(path("recording.bag"), rosbag::bagmode::Append);
    RecordingWriter writer(path("one.bag"));
    write_vertex(writer, 0.1, 1.0);
    writer.close();
    rosbag::Bag one(path("one.bag"));
    rosbag::View view(one);
    bag.write("/tissue/vertices", at(5.0), *view.begin()->instantiate<sensor_msgs::PointCloud2>());
  }
  BagReader reader = open();
  const auto first = reader.next();
  ASSERT_TRUE(first);
  ASSERT_EQ(first->frame.observations.size(), 2U);
  EXPECT_EQ(first->frame.observations[1].source, 1);
  int frames = 1;
  while (reader.next()) ++frames;
  EXPECT_EQ(frames, 10);
  EXPECT_EQ(reader.late(), 0);
  EXPECT_EQ(reader.broken_stamps(), 1);  // the only one that far back
}

TEST_F(BagReaderTest, LeavesOutBrokenStampsAndFollowsAPause) {
  std::vector<double> stamps, good;
  for (int k = 0; k < 20; ++k) stamps.push_back(0.1 * k);
  for (int k = 0; k < 5; ++k) stamps.push_back(100.0 + 0.1 * k);  // a pause: several messages agree
  good = stamps;
  stamps.insert(stamps.begin() + 15, -1.0);
  stamps.insert(stamps.begin() + 10, 3600.0);
  stamps.push_back(7200.0);
  {
    RecordingWriter writer(path("recording.bag"));
    for (const double stamp : stamps) write_vertex(writer, stamp, 1.0);
    writer.close();
  }
  {  // the writer's order of records is that of the stamps
    rosbag::Bag sorted(path("recording.bag")), bag(path("as_it_came.bag"), rosbag::bagmode::Write);
    rosbag::View view(sorted);
    std::map<ros::Time, sensor_msgs::PointCloud2ConstPtr> clouds;
    for (const rosbag::MessageInstance& message : view) {
      const auto cloud = message.instantiate<sensor_msgs::PointCloud2>();
      clouds[cloud->header.stamp] = cloud;
    }
    double record_time = 0.0;
    for (const double stamp : stamps) bag.write("/tissue/vertices", at(record_time += 0.01), *clouds.at(at(stamp)));
  }
  BagReader reader(path("as_it_came.bag"), settings_);
  EXPECT_DOUBLE_EQ(reader.first_stamp(), 1000.0);
  std::vector<double> read;
  while (const auto instant = reader.next()) read.push_back(instant->frame.time - 1000.0);
  ASSERT_EQ(read.size(), good.size());
  for (std::size_t k = 0; k < good.size(); ++k) EXPECT_NEAR(read[k], good[k], 1e-6);
  EXPECT_EQ(reader.broken_stamps(), 3);
  EXPECT_EQ(reader.last_broken_stamp(), "/tissue/vertices: 7099.6 s ahead");
}

TEST_F(BagReaderTest, TurnsAWrenchIntoTheModelFrame) {
  settings_ = load_model(write("model.yaml", read("model.yaml")
                                                 .replace(read("model.yaml").find("observations"), 0,
                                                          "- traction: {region: clamp, topic: /tool}\n")));
  {
    RecordingWriter writer(path("recording.bag"));
    Eigen::Isometry3d quarter(Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ()));
    writer.write_pose("tool_tip", at(0.0), quarter);
    write_vertex(writer, 0.0, 1.0);
    writer.close();
  }
  rosbag::Bag bag(path("recording.bag"), rosbag::bagmode::Append);
  geometry_msgs::WrenchStamped wrench;
  wrench.header.stamp = at(0.0);
  wrench.header.frame_id = "/tool_tip";
  wrench.wrench.force.x = 2.0;
  bag.write("/tool", at(0.0), wrench);
  bag.close();
  BagReader reader = open();
  const auto instant = reader.next();
  ASSERT_TRUE(instant);
  ASSERT_EQ(instant->loads.size(), 1U);
  EXPECT_EQ(instant->loads[0].topic, "/tool");
  EXPECT_TRUE(instant->loads[0].value.head<3>().isApprox(Eigen::Vector3d(0, 2, 0), 1e-12));
}

TEST_F(BagReaderTest, SkipsAFrameWhoseSensorHasNoPose) {
  rosbag::Bag bag(path("recording.bag"), rosbag::bagmode::Write);
  {
    RecordingWriter writer(path("one.bag"));
    write_vertex(writer, 0.0, 1.0);
    writer.close();
  }
  rosbag::Bag one(path("one.bag"));
  rosbag::View view(one);
  sensor_msgs::PointCloud2 cloud = *view.begin()->instantiate<sensor_msgs::PointCloud2>();
  cloud.header.frame_id = "unknown_sensor";
  bag.write("/tissue/vertices", at(0.0), cloud);
  bag.close();
  BagReader reader = open();
  const auto instant = reader.next();
  ASSERT_TRUE(instant);
  EXPECT_TRUE(instant->frame.observations.empty());
  EXPECT_TRUE(says(instant->reason, {"unknown_sensor", "model"}));
}

TEST_F(BagReaderTest, FollowsASensorThatMoves) {
  {
    RecordingWriter writer(path("one.bag"));
    for (int i = 0; i < 20; ++i) write_vertex(writer, 0.05 * i, 1.0);
    writer.close();
  }
  {
    rosbag::Bag one(path("one.bag")), bag(path("recording.bag"), rosbag::bagmode::Write);
    int number = 0;
    for (const rosbag::MessageInstance& message : rosbag::View(one)) {
      tf2_msgs::TFMessage poses;
      poses.transforms.resize(2);  // another frame's beside it, as on a real robot
      for (geometry_msgs::TransformStamped& pose : poses.transforms) {
        pose.header.stamp = at(0.05 * number);
        pose.header.frame_id = "model";
        pose.child_frame_id = &pose == &poses.transforms[0] ? "the_probe_at_the_end_of_the_arm" : "arm";
        pose.transform.rotation.w = 1.0;
        pose.transform.translation.x = 0.01 * number;
      }
      sensor_msgs::PointCloud2 cloud = *message.instantiate<sensor_msgs::PointCloud2>();
      cloud.header.frame_id = "the_probe_at_the_end_of_the_arm";
      bag.write("/tf", at(0.05 * number), poses);
      bag.write("/tissue/vertices", at(0.05 * number++), cloud);
    }
  }
  BagReader reader = open();
  for (int i = 0; i < 20; ++i) {
    const auto instant = reader.next();
    ASSERT_TRUE(instant);
    ASSERT_EQ(instant->frame.observations.size(), 1U) << instant->reason;
    EXPECT_NEAR(instant->frame.observations[0].points(0, 0), 1.0 + 0.01 * i, 1e-6);
  }
}

TEST_F(BagReaderTest, RefusesWhatIsNoBag) {
  EXPECT_TRUE(says(input_error([&] { open(); }), {"recording.bag", "no readable file"}));
  write("recording.bag", "mesh: {file: mesh.vtk}\n");
  EXPECT_TRUE(says(input_error([&] { open(); }), {"recording.bag", "a rosbag"}));
  write("recording.bag", "");
  EXPECT_TRUE(says(input_error([&] { open(); }), {"recording.bag", "a rosbag"}));
}

TEST_F(BagReaderTest, RefusesABagWithoutItsEnd) {
  {
    RecordingWriter writer(path("recording.bag"));
    for (int k = 0; k < 100; ++k) write_vertex(writer, 0.1 * k, 1.0);
    writer.close();
  }
  const std::string whole = read("recording.bag");
  write("recording.bag", whole.substr(0, whole.size() / 2));
  EXPECT_TRUE(says(input_error([&] { open(); }), {"recording.bag"}));
}

TEST_F(BagReaderTest, NamesTheTopicsThatWouldFit) {
  {
    RecordingWriter writer(path("recording.bag"));
    write_vertex(writer, 0.0, 1.0, "/elsewhere/vertices");
    writer.close();
  }
  EXPECT_TRUE(says(input_error([&] { open(); }), {"/tissue/vertices", "found nothing", "/elsewhere/vertices"}));
}

TEST_F(BagReaderTest, RefusesATopicOfAnotherType) {
  rosbag::Bag bag(path("recording.bag"), rosbag::bagmode::Write);
  bag.write("/tissue/vertices", at(0.0), std_msgs::String());
  bag.close();
  EXPECT_TRUE(says(input_error([&] { open(); }), {"/tissue/vertices", "std_msgs/String", "sensor_msgs/PointCloud2"}));
}

TEST_F(BagReaderTest, NamesTheTopicOfABrokenMessage) {
  rosbag::Bag bag(path("recording.bag"), rosbag::bagmode::Write);
  bag.write("/tissue/vertices", at(0.0), BrokenCloud());
  bag.close();
  EXPECT_TRUE(
      says(input_error([&] { open(); }), {"recording.bag: topic /tissue/vertices", "a broken message", "PointCloud2"}));
}

TEST_F(BagReaderTest, RefusesVerticesThatTheMeshDoesNotHave) {
  {
    RecordingWriter writer(path("recording.bag"));
    write_vertex(writer, 0.0, 1.0);
    writer.close();
  }
  BagReader reader = open();
  TetMesh mesh;
  mesh.corner_count = 3;
  reader.set_mesh(mesh);
  EXPECT_TRUE(says(input_error([&] { reader.next(); }), {"/tissue/vertices", "vertex", "found 3", "0 to 2"}));
}

}  // namespace
}  // namespace tissue_stiffness
