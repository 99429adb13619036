// Several recordings on the command line, and what comes out for each.
#include "tools/estimate_jointly.hpp"

#include <nlohmann/json.hpp>

#include "outcome.hpp"
#include "report/read_results.hpp"
#include "workbench.hpp"

namespace tissue_stiffness {
namespace {

std::string listed(const std::vector<RecordingFile>& files) {
  std::string out;
  for (const RecordingFile& file : files) out += file.model + ":" + file.recording + " ";
  return out;
}

TEST(PairFiles, GivesEachRecordingTheModelBeforeIt) {
  EXPECT_EQ(listed(pair_files({"1.bag", "2.bag"}, "a.yaml", false)), "a.yaml:1.bag a.yaml:2.bag ");
  EXPECT_EQ(listed(pair_files({"1.bag", "b.yml", "2.bag", "3.bag"}, "a.yaml", false)),
            "a.yaml:1.bag b.yml:2.bag b.yml:3.bag ");
  EXPECT_EQ(listed(pair_files({}, "a.yaml", true)), "");
  EXPECT_TRUE(pair_files({"1.bag"}, "a.yaml", true).front().predicted);
  EXPECT_THROW(pair_files({"1.bag", "b.yaml"}, "a.yaml", false), InputError);
  EXPECT_THROW(pair_files({"b.yaml", "c.yaml", "1.bag"}, "a.yaml", false), InputError);
}

class EstimateJointly : public Workbench {
 protected:
  // Films a bar of 400 kPa, and writes the model that estimates it.
  void film(const std::string& name, const std::string& modulus = "4e5") {
    const std::string gravity = name == "a" ? "[0, 0, -9.81]" : name == "b" ? "[0, 9.81, 0]" : "[0, 6, -8]";
    const auto model = [&](const std::string& file, const std::string& young_modulus, const std::string& more) {
      return write_bar(file, young_modulus, "", "- gravity: {acceleration: " + gravity + "}\n", vertices() + more);
    };
    model(name + "_scene.yaml", modulus, "simulation: {duration: 0.3, rate: 60, step: 0.001}\n");
    const Outcome simulated =
        call("simulate " + path(name + "_scene.yaml") + " --output " + path(name + ".bag") + " --quiet");
    ASSERT_EQ(simulated.code, 0) << simulated.text;
    model(name + ".yaml", "{prior: 8e5, factor: 3}", "");
  }
  std::string files(const std::string& name) const { return path(name + ".yaml") + " " + path(name + ".bag") + " "; }
  nlohmann::json results() const { return nlohmann::json::parse(read("out/results.json")); }
};

TEST_F(EstimateJointly, FitsTogetherAndForetells) {
  for (const std::string name : {"a", "b", "c"}) film(name);
  film("other", "5e5");
  const Outcome outcome = call("estimate " + files("a") + files("b") + "--predict " + files("c") + path("other.bag") +
                               " --output " + path("out"));
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  for (const std::string word : {"c.bag", "predicted", "fitted"})
    EXPECT_NE(outcome.text.find(word), std::string::npos) << outcome.text;
  const nlohmann::json all = results();
  const auto& interval = all["parameters"]["elasticity.young_modulus"]["interval95"];
  EXPECT_LT(interval[0], 4e5);
  EXPECT_GT(interval[1], 4e5);
  ASSERT_EQ(all["recordings"].size(), 4u);
  EXPECT_EQ(all["frames"], all["recordings"][0]["frames"].get<int>() + all["recordings"][1]["frames"].get<int>());
  EXPECT_TRUE(all["recordings"][0]["alone"]["parameters"].contains("elasticity.young_modulus"));
  const auto &same = all["recordings"][2], &other = all["recordings"][3];
  EXPECT_NEAR(same["rms_sigma"].get<double>(), 1.0, 0.3);
  EXPECT_TRUE(same["agreement"]["passes"].get<bool>()) << same.dump();
  EXPECT_FALSE(other["agreement"]["passes"].get<bool>()) << other.dump();
  EXPECT_NE(read("out/report.html").find("Recordings of one body"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path("out/estimates.csv")));
  EXPECT_THROW(read_results(path("out")), InputError);  // its models may differ
}

TEST_F(EstimateJointly, ListsWhatEachHasForItself) {
  for (const std::string name : {"a", "b"}) film(name);
  const std::string both = "estimate " + files("a") + files("b") + "--output " + path("out") + " --quiet";
  ASSERT_EQ(call(both + " --own elasticity").code, 0);
  const nlohmann::json all = results();
  EXPECT_TRUE(all["parameters"].empty());
  for (const auto& recording : all["recordings"]) EXPECT_TRUE(recording["parameters"].contains("elasticity.young_modulus"));
  const Outcome refused = call(both + " --own traction");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.text.find("--own: found traction"), std::string::npos) << refused.text;
}

TEST_F(EstimateJointly, RefusesWhatItDoesNotDo) {
  film("a");
  const std::string model = read("a.yaml");
  const auto refused = [&](const std::string& more, const std::string& word) {
    write("a.yaml", model + more);
    const Outcome outcome = call("estimate " + files("a") + path("a.bag") + " --output " + path("out"));
    EXPECT_EQ(outcome.code, 2) << outcome.text;
    EXPECT_NE(outcome.text.find(word), std::string::npos) << outcome.text;
  };
  refused("estimator: paper\n", "estimator: found paper");
  refused("map: {cells: 4, length: 0.05, factor: 2}\n", "map: found a map");
  EXPECT_EQ(call("estimate " + path("a.yaml") + " --output " + path("out")).code, 2);
}

TEST_F(EstimateJointly, ReadsCsvFilesInOneStep) {
  write_model("model.yaml", "{prior: 4e5, factor: 3}", vertices());
  std::string rows = "time,vertex,x,y,z\n";
  for (int k = 0; k < 12; ++k)
    rows += std::to_string(0.02 * k) + ",3,0,0,0\n" + std::to_string(0.02 * k) + ",4,0.1,0.02,0\n";
  write("points.csv", rows);
  const std::string command = "estimate " + path("model.yaml") + " --output " + path("out") + " --data /tissue/vertices=";
  const int code = call(command + path("points.csv")).code;
  EXPECT_TRUE(code == 0 || code == 3) << code;
  EXPECT_EQ(results()["frames"].get<int>() + static_cast<int>(results()["skipped"].size()), 12);
  EXPECT_TRUE(std::filesystem::exists(path("out/recording.bag")));
  const Outcome missing = call(command + path("none.csv"));
  EXPECT_EQ(missing.code, 2);
  EXPECT_NE(missing.text.find("none.csv"), std::string::npos) << missing.text;
}

}  // namespace
}  // namespace tissue_stiffness
