// The tool that writes an estimated model for other programs, from what `estimate` left.
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "outcome.hpp"
#include "tools/estimated_model.hpp"
#include "workbench.hpp"

namespace tissue_stiffness {
namespace {

class Export : public Workbench {
 protected:
  /// Films a bar that a force of 0.3 N pulls up from 0.15 s on, and half of it from 0.3 s on, and estimates it.
  void estimate(const std::string& more = "", const std::string& effects = "") {
    const std::string regions = ", tip: {box: {min: [0.0999, -1, -1], max: [1, 1, 1]}}";
    const std::string pull = "- traction: {region: tip, topic: /tool/wrench}\n";
    const std::string scene =
        write_bar("scene.yaml", "4e5", regions, pull,
                  vertices() +
                      "simulation: {duration: 0.4, rate: 50, step: 0.001, loads: {/tool/wrench: {rate: "
                      "200, terms: [{direction: [0, 0, 1], steps: {times: [0.15, 0.3], values: [0.3, "
                      "0.15]}}]}}}\n");
    ASSERT_EQ(call("simulate " + scene + " --output " + path("r.bag") + " --quiet").text, "");
    const std::string model =
        write_bar("model.yaml", "{prior: 5e5, factor: 2}", regions, pull + effects, vertices() + more);
    const Outcome outcome = call("estimate " + model + " " + path("r.bag") + " --quiet --output " + path("out"));
    ASSERT_TRUE(outcome.code == 0 || outcome.code == 3) << outcome.text;
  }

  nlohmann::json results() const { return nlohmann::json::parse(read("out/results.json")); }

  /// Exit code 2 and one line with all the words.
  ::testing::AssertionResult refuses(const std::string& arguments, const std::vector<std::string>& words) const {
    return tissue_stiffness::refuses("export " + arguments, words);
  }
};

TEST_F(Export, WritesEveryFormatFromAFolderOrAFile) {
  estimate();
  const double modulus = results().at("parameters").at("elasticity.young_modulus").at("mean");
  EXPECT_NEAR(modulus, 4e5, 4e4);
  const std::vector<std::pair<std::string, std::string>> formats = {{"vtu", "<UnstructuredGrid>"},
                                                                    {"calculix", "*ELASTIC"},
                                                                    {"febio", "<febio_spec"},
                                                                    {"sofa", "TetrahedronFEMForceField"},
                                                                    {"usd", "def TetMesh"}};
  for (const auto& [format, content] : formats) {
    const Outcome outcome = call("export " + path("out/results.json") + " --to " + format + " -o " + path("bar." + format));
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_NE(outcome.text.find("written " + path("bar." + format) + ", loads at 0.1"), std::string::npos) << outcome.text;
    EXPECT_NE(read("bar." + format).find(content), std::string::npos) << format;
  }
  ASSERT_EQ(call("export " + path("out") + " --to calculix --quiet").text, "");
  EXPECT_EQ(read("out/model.inp"), read("bar.calculix"));
  std::ostringstream elastic;
  elastic.precision(12);
  elastic << "*ELASTIC\n" << modulus << ", 0.45\n";
  EXPECT_NE(read("out/model.inp").find(elastic.str()), std::string::npos) << elastic.str();
  EXPECT_NE(read("out/model.inp").find("** traction on tip: in sum 0, 0, 0.3 N"), std::string::npos);
}

TEST_F(Export, WritesMeshesThatTheToolsRead) {
  estimate();
  for (const auto& [format, file] : {std::pair<std::string, std::string>{"vtu", "model.vtu"}, {"calculix", "model.inp"}}) {
    ASSERT_EQ(call("export " + path("out") + " --quiet --to " + format).text, "");
    std::string model = read("model.yaml");
    write("again.yaml", model.replace(model.find("bar.vtk"), 7, "out/" + file));
    EXPECT_EQ(call("check " + path("again.yaml")).text, "nothing found\n") << file;
  }
  std::string model = read("model.yaml");
  write("again.yaml", model.replace(model.find("bar.vtk"), 7, "out/model.vtu"));
  call("estimate " + path("again.yaml") + " " + path("r.bag") + " --quiet --output " + path("again"));
  EXPECT_EQ(read("again/estimates.csv"), read("out/estimates.csv"));
}

TEST_F(Export, TakesTheLoadsOfAnInstant) {
  estimate();
  const auto pulled = [&](const std::string& at) {
    EXPECT_EQ(call("export " + path("out") + " --to calculix --quiet --at " + at).text, "");
    const std::string text = read("out/model.inp");
    const std::string start = "** traction on tip: in sum 0, 0, ";
    const std::size_t found = text.find(start);
    return found == std::string::npos ? -1.0 : std::stod(text.substr(found + start.size()));
  };
  EXPECT_EQ(pulled("0.05"), 0.0);
  EXPECT_DOUBLE_EQ(pulled("0.2"), 0.3);
  EXPECT_DOUBLE_EQ(pulled("0.35"), 0.15);
  EXPECT_TRUE(refuses(path("out") + " --to vtu --at 7", {"--at", "7 s", "0 to 0."}));
  EXPECT_TRUE(refuses(path("out") + " --to vtu --at -1", {"--at", "-1 s"}));
}

TEST_F(Export, SaysOnStderrAndInTheFileWhatIsLeftOut) {
  estimate("", "- viscoelasticity: {gamma: 0.1, tau: 0.05}\n");
  const Outcome outcome = call("export " + path("out") + " --to sofa --quiet");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.text.find("export: note: viscoelasticity is left out: "), std::string::npos) << outcome.text;
  EXPECT_NE(read("out/model.scn").find("<!-- Note: viscoelasticity is left out: "), std::string::npos);
  const std::string state = results().at("state");
  EXPECT_EQ(outcome.text.find("export: note: the estimate is " + state) != std::string::npos, state != "converged")
      << outcome.text;
}

TEST_F(Export, TakesTheModuliOfAMap) {
  estimate("map: {cells: 4, length: 0.03, factor: 2}\n");
  const EstimatedModel estimated = load_estimated_model(path("out"));
  const auto patches = results().at("map").at("patches");
  ASSERT_EQ(estimated.mapped_modulus.size(), estimated.model->mesh().tet_count());
  std::set<double> expected,
      found(estimated.mapped_modulus.data(), estimated.mapped_modulus.data() + estimated.mapped_modulus.size());
  for (const auto& patch : patches) expected.insert(patch.at("young_modulus").get<double>());
  EXPECT_EQ(found, expected);
  EXPECT_DOUBLE_EQ(estimated.common_modulus, results().at("parameters").at("elasticity.young_modulus").at("mean"));
  std::filesystem::remove(path("out/map.vtk"));
  EXPECT_TRUE(refuses(path("out") + " --to vtu", {"map.vtk"}));
}

TEST_F(Export, NeedsWhatTheEstimateWasMadeOf) {
  EXPECT_TRUE(refuses(path("none") + " --to vtu", {"none", "results.json"}));
  EXPECT_TRUE(refuses(path("none"), {"--to"}));
  EXPECT_TRUE(refuses(path("none") + " --to stl", {"--to", "calculix"}));
  estimate();
  std::filesystem::rename(path("r.bag"), path("moved.bag"));
  EXPECT_TRUE(refuses(path("out") + " --to vtu", {"results.json: recording", "r.bag", "--recording FILE"}));
  EXPECT_EQ(call("export " + path("out") + " --to vtu --quiet --recording " + path("moved.bag")).text, "");
  std::filesystem::create_directory(path("elsewhere"));
  std::filesystem::rename(path("model.yaml"), path("elsewhere/model.yaml"));
  const std::string rest = " --to vtu --quiet --recording " + path("moved.bag");
  EXPECT_TRUE(refuses(path("out") + rest, {"results.json: model", "model.yaml", "--model FILE"}));
  EXPECT_TRUE(refuses(path("out") + rest + " --model " + path("elsewhere/model.yaml"), {"bar.vtk"}));
  save_mesh(make_box_mesh({0.1, 0.02, 0.02}, 6, 1, 1, 1), path("elsewhere/bar.vtk"));
  EXPECT_TRUE(refuses(path("out") + rest + " --model " + path("elsewhere/model.yaml"), {"mesh", "nodes", "results.json"}));
  std::filesystem::copy_file(path("bar.vtk"), path("elsewhere/bar.vtk"), std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(call("export " + path("out") + rest + " --model " + path("elsewhere/model.yaml")).text, "");
}

TEST_F(Export, RefusesResultsThatAreNotComplete) {
  write("results.json", "[1, 2]");
  EXPECT_TRUE(refuses(path("results.json") + " --to vtu", {"results.json", "no JSON object"}));
  write("results.json", R"({"model": "m.yaml", "recording": "r.bag"})");
  EXPECT_TRUE(refuses(path("results.json") + " --to vtu", {"results.json: model_text", "nothing"}));
  estimate();
  nlohmann::json root = results();
  root["parameters"]["elasticity.young_modulus"]["mean"] = nullptr;
  write("out/results.json", root.dump());
  EXPECT_TRUE(refuses(path("out") + " --to vtu", {"elasticity.young_modulus: mean", "null"}));
  root["parameters"] = nlohmann::json::object();
  write("out/results.json", root.dump());
  EXPECT_TRUE(refuses(path("out") + " --to vtu", {"no elasticity.young_modulus"}));
}

}  // namespace
}  // namespace tissue_stiffness
