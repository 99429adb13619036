// Many recordings: shared out, killed and resumed, they give one and the same table.
#include "tools/manifest.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "outcome.hpp"
#include "tools/run_manifest.hpp"
#include "workbench.hpp"

namespace tissue_stiffness {
namespace {

class ManifestTest : public Workbench {
 protected:
  void SetUp() override {
    Workbench::SetUp();
    write_model("scene.yaml", "4e5", vertices(), "simulation: {duration: 0.2, rate: 60, step: 0.001}\n");
    ASSERT_EQ(call("simulate " + path("scene.yaml") + " --output " + path("r.bag") + " --quiet").code, 0);
    write_model("model.yaml", "{prior: 8e5, factor: 3}", vertices());
  }

  /// A manifest of so many rows, three of which have no answer: a recording that is none, and files that are not there.
  void write_manifest(int count) {
    std::string text = "subject,model,recording\n";
    for (int k = 0; k < count; ++k) {
      const std::string name = "r" + std::to_string(k) + ".bag";
      if (k == 2) write(name, "no bag");
      if (k != 2 && k != 4) std::filesystem::copy_file(path("r.bag"), path(name));
      text += "\"a, " + std::to_string(k) + "\"," + (k == 5 ? "none.yaml," : "model.yaml,") + name + "\n";
    }
    write("list.csv", text);
  }
  std::string command(const std::string& out, const std::string& more) const {
    return "estimate --manifest " + path("list.csv") + " --output " + path(out) + " --quiet " + more;
  }
  std::string merged(const std::string& out) {
    EXPECT_EQ(call(command(out, "--merge " + path(out + ".csv"))).text, "");
    return read(out + ".csv");
  }
  std::size_t folders(const std::string& out) const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path(out)), {}));
  }

  /// A shard under way.
  pid_t begin(const std::string& out, const std::string& shard) const {
    const pid_t child = fork();
    if (child != 0) return child;
    const std::string tool = std::string(TISSUE_STIFFNESS_TOOLS) + "/estimate";
    execl(tool.c_str(), "estimate", "--manifest", path("list.csv").c_str(), "--output", path(out).c_str(), "--shard",
          shard.c_str(), "--resume", "--quiet", static_cast<char*>(nullptr));
    _exit(127);
  }
};

int code_of(pid_t process) {
  int status = 0;
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

TEST_F(ManifestTest, HasTheSameTableHoweverItIsSharedOutAndKilled) {
  const int count = 12;
  write_manifest(count);
  ASSERT_EQ(call(command("whole", "--threads 2")).code, 0);
  const std::string table = merged("whole");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), count + 1) << table;
  std::mt19937 random(1);
  const std::string shards[] = {"1/3", "2/3", "3/3"};
  int interrupted = 0;
  for (int trial = 0; trial < 4; ++trial) {
    for (const std::string& shard : shards) {
      const pid_t process = begin("shared", shard);
      std::this_thread::sleep_for(std::chrono::milliseconds(std::uniform_int_distribution<>(50, 600)(random)));
      kill(process, trial % 2 == 0 ? SIGKILL : SIGTERM);
      interrupted += code_of(process) != 0 ? 1 : 0;
    }
  }
  EXPECT_GT(interrupted, 0);
  for (const std::string& shard : shards) EXPECT_EQ(code_of(begin("shared", shard)), 0);
  EXPECT_EQ(merged("shared"), table);
  EXPECT_EQ(folders("shared"), std::size_t(count)) << "nothing is left of what was killed";
}

TEST_F(ManifestTest, TellsWhatBecameOfEachRow) {
  write_manifest(7);
  ASSERT_EQ(call(command("out", "")).code, 0);
  const std::string table = merged("out");
  EXPECT_EQ(table.rfind("subject,model,recording,exit_code,message,state,", 0), 0U) << table;
  EXPECT_NE(table.find("\"a, 1\",model.yaml,r1.bag,0,,"), std::string::npos) << table;
  EXPECT_NE(table.find("elasticity.young_modulus lower95 [Pa]"), std::string::npos) << table;
  for (const std::string wrong : {"r2.bag,2,estimate: ", "r4.bag,2,estimate: ", "r5.bag,2,estimate: "}) {
    EXPECT_NE(table.find(wrong), std::string::npos) << wrong << "\n" << table;
  }
  for (const auto& entry : std::filesystem::directory_iterator(path("out"))) {
    EXPECT_TRUE(std::filesystem::exists(entry.path() / "status.json")) << entry.path();
  }
}

TEST_F(ManifestTest, KeepsWhatIsAnsweredUntilAnInputChanges) {
  write("list.csv", "model,recording\nmodel.yaml,r.bag\n");
  const auto answered = [&](const std::string& more) { return call(command("out", "--resume" + more)).code; };
  ASSERT_EQ(answered(""), 0);
  const auto folder = std::filesystem::directory_iterator(path("out"))->path();
  const auto written = std::filesystem::last_write_time(folder / "results.json");
  ASSERT_EQ(answered(""), 0);
  EXPECT_EQ(std::filesystem::last_write_time(folder / "results.json"), written);
  std::filesystem::remove(folder / "status.json");  // as if it had been killed before the end
  ASSERT_EQ(answered(""), 0);
  EXPECT_GT(std::filesystem::last_write_time(folder / "results.json"), written);
  EXPECT_EQ(folders("out"), 1U);
  ASSERT_EQ(answered(" --frames 8"), 0);
  EXPECT_EQ(folders("out"), 2U);
  std::filesystem::copy_file(path("bar.vtk"), path("before.vtk"));
  save_mesh(make_box_mesh({0.1, 0.02, 0.02}, 5, 1, 1, 1), path("bar.vtk"));
  ASSERT_EQ(answered(""), 0);
  EXPECT_EQ(folders("out"), 2U) << "the same mesh again";
  save_mesh(make_box_mesh({0.1, 0.02, 0.021}, 5, 1, 1, 1), path("bar.vtk"));
  answered("");
  EXPECT_EQ(folders("out"), 3U) << "another mesh";
}

TEST_F(ManifestTest, NamesWhatIsWrongWithIt) {
  write("list.csv", "model,bag\nmodel.yaml,r.bag\n");
  EXPECT_TRUE(refuses(command("out", ""), {"list.csv", "recording"}));
  write("list.csv", "model,recording\nmodel.yaml\n");
  EXPECT_TRUE(refuses(command("out", ""), {"list.csv: row 1", "1 cells", "2"}));
  write("list.csv", "model,recording\n");
  EXPECT_TRUE(refuses(command("out", ""), {"list.csv", "row"}));
  write("list.csv", "model,recording\nmodel.yaml,r.bag\n");
  for (const std::string shard : {"0/3", "4/3", "2", "a/b", "1/2/3", "-1/3"}) {
    EXPECT_TRUE(refuses(command("out", "--shard " + shard), {"--shard", shard})) << shard;
  }
  EXPECT_TRUE(refuses(command("out", "--threads 0"), {"threads"}));
  EXPECT_TRUE(
      refuses("estimate " + path("model.yaml") + " " + path("r.bag") + " --resume --output " + path("out"), {"resume"}));
  EXPECT_TRUE(refuses("estimate " + path("model.yaml") + " --output " + path("out"), {"RECORDING"}));
}

TEST(ManifestFile, ReadsQuotedCells) {
  const std::string file = testing::TempDir() + "/manifest_test.csv";
  std::ofstream(file) << "recording,note,model\r\na.bag,\"one, \"\"two\"\"\nthree\",/m/a.yaml\n\nb/c.bag,,../b.yaml";
  const Manifest manifest = read_manifest(file);
  ASSERT_EQ(manifest.rows.size(), 2U);
  EXPECT_EQ(manifest.rows[0].cells[1], "one, \"two\"\nthree");
  EXPECT_EQ(manifest.rows[0].model_file, "/m/a.yaml");
  EXPECT_EQ(csv_row(manifest.rows[0].cells), "a.bag,\"one, \"\"two\"\"\nthree\",/m/a.yaml\n");
  EXPECT_EQ(std::filesystem::path(manifest.rows[1].recording_file).filename(), "c.bag");
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace tissue_stiffness
