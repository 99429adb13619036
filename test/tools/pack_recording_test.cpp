#include "tools/pack_recording.hpp"

#include "tissue_stiffness/types/error.hpp"
#include "tools/bag_reader.hpp"
#include "workbench.hpp"

namespace tissue_stiffness {
namespace {

class PackRecording : public Workbench {
 protected:
  void SetUp() override {
    Workbench::SetUp();
    write_model("model.yaml", "{prior: 4e5, factor: 3}", vertices());
    std::string model = read("model.yaml");
    model.insert(model.find("observations"), "- traction: {region: clamp, topic: /tool}\n");
    settings_ = load_model(write("model.yaml", model));
    write("points.csv", "time,vertex,x,y,z\n2.0,0,1,2,3\n2.0,5,4,5,6\n2.1,0,1.5,2,3\n2.1,5,4.5,5,6\n2.2,5,7,8,9\n");
    write("force.csv", "# from the arm\n1.95;0.1;0.2;0.3\n2.05;0.1;0.2;0.4;0;0;0.5\n2.3;0;0;0\n");
  }

  std::vector<PackedSummary> pack(double scale = 1.0) {
    return pack_recording(settings_, {{{"/tissue/vertices", path("points.csv")}, {"/tool", path("force.csv")}}, {}, scale},
                          path("packed.bag"));
  }
  std::string refused(const std::string& name, const std::string& content) {
    write(name, content);
    try {
      pack();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  ModelSettings settings_;
};

TEST_F(PackRecording, WritesWhatTheToolsRead) {
  const std::vector<PackedSummary> summaries = pack(0.001);
  ASSERT_EQ(summaries.size(), 2U);
  EXPECT_EQ(summaries[0].messages, 3U);
  EXPECT_NEAR(summaries[0].duration, 0.2, 1e-9);
  EXPECT_EQ(summaries[1].messages, 3U);
  BagReader reader(path("packed.bag"), settings_);
  std::vector<Frame> frames;
  std::vector<LoadSample> loads;
  while (auto instant = reader.next()) {
    frames.push_back(instant->frame);
    loads.insert(loads.end(), instant->loads.begin(), instant->loads.end());
  }
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_NEAR(frames[0].time, 1000.05, 1e-6);  // the first force is the earliest message
  EXPECT_NEAR(frames[2].time - frames[0].time, 0.2, 1e-6);
  const Observation& second = frames[1].observations.at(0);
  ASSERT_EQ(second.ids.size(), 2);
  EXPECT_EQ(second.ids[1], 5);
  EXPECT_NEAR((second.points.col(1) - 1e-3 * Eigen::Vector3d(4.5, 5, 6)).norm(), 0.0, 1e-9);
  EXPECT_EQ(frames[2].observations.at(0).ids.size(), 1);
  ASSERT_EQ(loads.size(), 3U);
  EXPECT_EQ(loads[1].topic, "/tool");
  EXPECT_NEAR(loads[1].value[2], 0.4, 1e-12);  // no length: it is not scaled
  EXPECT_NEAR(loads[1].value[5], 0.5, 1e-12);
}

TEST_F(PackRecording, NamesFileAndLineOfWhatDoesNotFit) {
  EXPECT_TRUE(says(refused("points.csv", "0,0,1,2\n"), {"points.csv:1", "time [s], number, x, y, z"}));
  EXPECT_TRUE(says(refused("points.csv", "t,v,x,y,z\n0,1.5,1,2,3\n"), {"points.csv:2", "1.5", "whole number"}));
  EXPECT_TRUE(says(refused("points.csv", "t,v,x,y,z\n0,1,nan,2,3\n"), {"points.csv:2"}));
  EXPECT_TRUE(says(refused("points.csv", "t,v,x,y,z\n"), {"points.csv", "no rows"}));
}

TEST_F(PackRecording, NamesATopicThatTheModelDoesNotHave) {
  try {
    pack_recording(settings_, {{{"/other", path("points.csv")}}, {}, 1.0}, path("packed.bag"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(says(error.what(), {"--data /other", "/tissue/vertices, /tool"}));
  }
  EXPECT_THROW(read_packed_topic("/tool"), InputError);
  EXPECT_THROW(read_packed_topic("=force.csv"), InputError);
  EXPECT_EQ(read_packed_topic("/tool=a=b.csv").file, "a=b.csv");
}

}  // namespace
}  // namespace tissue_stiffness
