#include "report/comparison.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "example.hpp"
#include "report/page.hpp"
#include "report/write_results.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

namespace fs = std::filesystem;

class Comparison : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "comparison_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    write_results(example(40), {}, folder_ + "/before");
    Results after = example(60);
    after.parameters[0] = young(3.0e5, 1.0e3);
    after.parameters.push_back({"viscoelasticity.tau", "s", 0.2, 0.01, 0.18, 0.22});
    for (FrameRecord& frame : after.frames) {
      if (frame.used) frame.parameters.push_back(after.parameters.back());
    }
    after.model_text =
        "mesh: {file: elsewhere/mesh.vtk}\neffects:\n- inertia: {density: 1000}\n- viscoelasticity: {tau: <0.2>}\n";
    after.state = EstimateState::model_invalid;
    write_results(after, {}, folder_ + "/after");
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string refusal(const std::string& name) const {
    try {
      read_run(folder_ + "/" + name);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  void replace(const std::string& file, const std::string& what, const std::string& by) const {
    std::ifstream in(folder_ + file);
    std::string text((std::istreambuf_iterator<char>(in)), {});
    ASSERT_NE(text.find(what), std::string::npos);
    text.replace(text.find(what), what.size(), by);
    std::ofstream(folder_ + file) << text;
  }

  std::string folder_;
};

TEST_F(Comparison, ReadsWhatARunLeft) {
  const ComparedRun run = read_run(folder_ + "/after/");
  EXPECT_EQ(run.name, folder_ + "/after");
  EXPECT_EQ(run.state, "model_invalid");
  EXPECT_EQ(run.frames, 57);
  EXPECT_EQ(run.rms_error, 3.1e-4);
  ASSERT_EQ(run.parameters.size(), 3U);
  const Results written = example(60);
  ASSERT_EQ(run.time.size(), 57U);
  EXPECT_EQ(run.time.front(), 0.0);
  EXPECT_NEAR(run.time.back(), 0.02 * 59, 1e-6);
  const std::size_t modulus = run.parameters[0].name == "elasticity.young_modulus" ? 0 : 1;
  EXPECT_EQ(run.mean[modulus].back(), written.frames.back().parameters[0].mean);
  EXPECT_EQ(run.upper[modulus].back(), written.frames.back().parameters[0].upper95);
  EXPECT_EQ(run.misfit.back(), written.frames.back().misfit_rms);
}

TEST_F(Comparison, ShowsRunsBesideEachOther) {
  const std::string page =
      comparison_html({read_run(folder_ + "/before"), read_run(folder_ + "/after")}, "compare a b", {});
  std::size_t at = 0;
  for (const std::string fragment :
       {"id=\"runs\"", ">before</span></td>", "converged", ">after</span></td>", "model invalid",
        "Young&#39;s modulus (elasticity)", "412.3 kPa", "408.2 to 416.5", "300.0 kPa", "tau (viscoelasticity)",
        "not in this model", "data-chart=\"intervals:viscoelasticity.tau\"", "compare-misfit",
        "<code>inertia.density</code></td><td><del>1060</del></td><td><ins>1000</ins></td>",
        "<code>viscoelasticity</code></td><td class=\"soft\">not there</td><td><ins>{tau: &lt;0.2&gt;}</ins>",
        "compare a b"}) {
    const std::size_t found = page.find(fragment, at);
    EXPECT_NE(found, std::string::npos) << fragment;
    if (found != std::string::npos) at = found;
  }
  EXPECT_EQ(page.find("<code>mesh.file"), std::string::npos) << "a folder is no difference";
  const std::string start = "id=\"data\">";
  const std::size_t from = page.find(start) + start.size();
  const auto data = nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from)).at("compare");
  ASSERT_EQ(data.at("runs").size(), 2U);
  EXPECT_EQ(data.at("runs")[0].at("time").size(), 38U);
  EXPECT_NEAR(data.at("runs")[1].at("parameters").at("elasticity.young_modulus").at("mean").back(), 412.0, 0.1);
  const auto last = data.at("runs")[1].at("parameters").at("elasticity.young_modulus").at("final");
  EXPECT_NEAR(last[0], 300.0, 1e-9);
  EXPECT_NEAR(last[2], 300.0 + 1.96, 1e-9);
  EXPECT_EQ(data.at("titles").at("viscoelasticity.tau"), "tau (viscoelasticity) [s]");
}

TEST(WithoutCommonFolders, KeepsWhatTellsPathsApart) {
  using Paths = std::vector<std::string>;
  EXPECT_EQ(without_common_folders({"/a/b/c", "/a/b/d/c"}), (Paths{"c", "d/c"}));
  EXPECT_EQ(without_common_folders({"a/one", "ab/one"}), (Paths{"a/one", "ab/one"}));
  EXPECT_EQ(without_common_folders({"a/b", "a"}), (Paths{"a/b", "a"}));
  EXPECT_EQ(without_common_folders({"a/b", "a/b"}), (Paths{"b", "b"}));
}

TEST_F(Comparison, RefusesAModelThatIsNoYaml) {
  replace("/after/results.json", "effects:", "effects: [");
  const std::vector<ComparedRun> runs = {read_run(folder_ + "/before"), read_run(folder_ + "/after")};
  try {
    comparison_html(runs, "", {});
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("model of after:"), 0U) << error.what();
  }
}

TEST_F(Comparison, NamesWhatIsMissing) {
  EXPECT_NE(refusal("nowhere").find("nowhere/results.json"), std::string::npos);
  replace("/before/estimates.csv", "misfit_rms [m]", "other");
  EXPECT_NE(refusal("before").find("no column `misfit_rms [m]`"), std::string::npos) << refusal("before");
  replace("/after/results.json", "\"state\"", "\"mood\"");
  EXPECT_NE(refusal("after").find("after/results.json"), std::string::npos);
  EXPECT_NE(refusal("after").find("state"), std::string::npos);
}

}  // namespace
}  // namespace tissue_stiffness
