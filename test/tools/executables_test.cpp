// The tools as a user meets them: exit codes, one line on what is wrong, help.
#include <poll.h>
#include <signal.h>
#include <sys/inotify.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "outcome.hpp"
#include "tools/bag_reader.hpp"
#include "workbench.hpp"

namespace tissue_stiffness {
namespace {

using Seconds = std::chrono::duration<double>;

/// `diagnose` under way.
class Diagnosing {
 public:
  Diagnosing(const std::string& model, const std::string& recording, const std::string& output)
      : watch_(inotify_init1(IN_CLOEXEC)) {
    std::filesystem::create_directories(output);
    inotify_add_watch(watch_, output.c_str(), IN_MOVED_TO);
    const std::string tool = std::string(TISSUE_STIFFNESS_TOOLS) + "/diagnose";
    child_ = fork();
    if (child_ != 0) return;
    execl(tool.c_str(), "diagnose", model.c_str(), recording.c_str(), "--output", output.c_str(), "--auto", "--quiet",
          static_cast<char*>(nullptr));
    _exit(127);
  }
  ~Diagnosing() { close(watch_); }
  Diagnosing(const Diagnosing&) = delete;
  Diagnosing& operator=(const Diagnosing&) = delete;

  /// Waits until the signals are held and the tool itself is executed, which then loads its libraries.
  void wait_until_started() const {
    const std::string link = "/proc/" + std::to_string(child_) + "/exe";
    std::error_code none;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (std::filesystem::read_symlink(link, none).extension() != ".tool") {
      if (std::chrono::steady_clock::now() > deadline) FAIL() << "not started";
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  void wait_for_first_file() const {
    pollfd first{watch_, POLLIN, 0};
    EXPECT_EQ(poll(&first, 1, 30000), 1) << "no diagnosis.json";
  }

  void send(int signal_number) const { kill(child_, signal_number); }

  /// Exit code, or minus the signal that it died of.
  int wait() const {
    int status = 0;
    waitpid(child_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  int watch_;
  pid_t child_;
};

class Executables : public Workbench {
 protected:
  /// A recording with damping that model.yaml does not know, and the arguments that name both.
  std::string film_hidden_damping() {
    write_model("scene.yaml", "4e5", vertices(), "simulation: {duration: 0.5, rate: 60, step: 0.001}\n");
    std::string scene = read("scene.yaml");
    write("scene.yaml", scene.insert(scene.find("- gravity"), "- viscous_damping: {beta: 4.0e-3}\n"));
    const Outcome simulated = call("simulate " + path("scene.yaml") + " --output " + path("r.bag") + " --quiet");
    EXPECT_EQ(simulated.code, 0) << simulated.text;
    return write_model("model.yaml", "{prior: 8e5, factor: 3}", vertices()) + " " + path("r.bag");
  }

  Diagnosing begin() const { return {path("model.yaml"), path("r.bag"), path("out")}; }

  nlohmann::json diagnosis() const { return nlohmann::json::parse(read("out/diagnosis.json"), nullptr, false); }

  bool has_temporary_file() const {
    for (const auto& file : std::filesystem::directory_iterator(path("out"))) {
      if (file.path().filename().string().find(".part") != std::string::npos) return true;
    }
    return false;
  }
};

/// The names of all tools, each of which has a main file of its own.
std::vector<std::string> tools() {
  std::vector<std::string> out;
  const std::string end = "_main.cpp";
  for (const auto& file : std::filesystem::directory_iterator(std::string(TISSUE_STIFFNESS_SOURCE_DIR) + "/src/tools")) {
    const std::string name = file.path().filename().string();
    const std::size_t size = name.size() - std::min(end.size(), name.size());
    if (name.substr(size) == end) out.push_back(name.substr(0, size));
  }
  return out;
}

TEST_F(Executables, AllHelpAndTellTheirVersions) {
  EXPECT_GE(tools().size(), 9U);
  for (const std::string& tool : tools()) {
    const Outcome help = call(tool + " --help");
    EXPECT_EQ(help.code, 0) << tool << help.text;
    EXPECT_NE(help.text.find("Usage: " + tool), std::string::npos) << help.text;
    EXPECT_NE(help.text.find("Example: " + tool), std::string::npos) << help.text;
    EXPECT_NE(help.text.find("--version"), std::string::npos) << help.text;
    const Outcome version = call(tool + " --version");  // without its required arguments
    EXPECT_EQ(version.code, 0) << tool << version.text;
    EXPECT_EQ(version.text.rfind("tissue_stiffness ", 0), 0U) << tool << version.text;
    EXPECT_NE(version.text.find("\nEigen "), std::string::npos) << tool << version.text;
  }
}

TEST_F(Executables, RefuseWrongArguments) {
  EXPECT_TRUE(refuses("estimate", {"estimate:", "required"}));
  EXPECT_TRUE(refuses("estimate a.yaml b.bag --output " + path("out") + " --colour", {"--colour"}));
  EXPECT_TRUE(refuses("estimate a.yaml b.bag --output " + path("out") + " --frames -3", {"frames"}));
  EXPECT_TRUE(refuses("simulate", {"simulate:", "required"}));
  const Outcome refused = call("estimate a.yaml b.bag --output " + path("out") + " --frames abc");
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(refused.text, "estimate: --frames: found abc; allowed: a positive whole number (--help shows the arguments)\n");
  EXPECT_TRUE(refuses("estimate a.yaml --manifest l.csv --output " + path("out"), {"MODEL", "a.yaml", "--manifest"}));
  EXPECT_TRUE(refuses("effects --json more", {"effects:", "more", "too many"}));
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(Executables, NameFileKeyAndValueOfWrongInput) {
  EXPECT_TRUE(refuses("estimate " + path("none.yaml") + " b.bag --output " + path("out"), {"none.yaml"}));
  const std::string negative = write_model("model.yaml", "-5", vertices());
  EXPECT_TRUE(refuses("estimate " + negative + " " + path("none.bag") + " --output " + path("out"), {"none.bag"}));
  write("some.bag", "#ROSBAG V1.2\n");
  EXPECT_TRUE(refuses("estimate " + negative + " " + path("some.bag") + " --output " + path("out"), {"some.bag"}));
  EXPECT_TRUE(refuses("simulate " + negative + " --output " + path("out.bag"), {"model.yaml", "simulation"}));
}

TEST_F(Executables, GoFromSceneToResults) {
  const std::string scene =
      write_model("scene.yaml", "4e5", vertices(), "simulation: {duration: 0.2, rate: 60, step: 0.001}\n");
  const Outcome simulated = call("simulate " + scene + " --output " + path("r.bag") + " --truth " + path("truth.yaml"));
  ASSERT_EQ(simulated.code, 0) << simulated.text;
  EXPECT_NE(simulated.text.find("12 frames"), std::string::npos) << simulated.text;
  EXPECT_NE(read("truth.yaml").find("elasticity.young_modulus: 4"), std::string::npos) << read("truth.yaml");

  const std::string model = write_model("model.yaml", "{prior: 8e5, factor: 3}", vertices());
  const std::string estimate = "estimate " + model + " " + path("r.bag") + " --output ";
  const Outcome estimated = call(estimate + path("out"));
  ASSERT_EQ(estimated.code, 0) << estimated.text;
  EXPECT_NE(estimated.text.find("elasticity.young_modulus"), std::string::npos) << estimated.text;
  ASSERT_EQ(call(estimate + path("again") + " --quiet").text, "");
  for (const std::string file : {"out/results.json", "out/estimates.csv", "out/report.html"})
    EXPECT_NE(read(file), "") << file;
  EXPECT_EQ(read("out/estimates.csv"), read("again/estimates.csv"));
  EXPECT_TRUE(refuses("estimate " + scene + " " + path("r.bag") + " --output " + path("x"), {"scene.yaml", "simulation"}));
  EXPECT_TRUE(refuses(estimate + "/proc/none", {"/proc/none"}));
}

TEST_F(Executables, ReadNoFileOutsideTheModelsFolderUnlessAllowed) {
  std::filesystem::create_directory(path("models"));
  const std::string scene =
      write_model("models/scene.yaml", "4e5", vertices(), "simulation: {duration: 0.2, rate: 60, step: 0.001}\n");
  const std::string model = write_model("models/model.yaml", "{prior: 8e5, factor: 3}", vertices());
  for (const std::string& file : {scene, model}) {
    std::string text = read("models/" + std::filesystem::path(file).filename().string());
    text.replace(text.find("bar.vtk"), 7, "../bar.vtk");
    write("models/" + std::filesystem::path(file).filename().string(), text);
  }
  const std::string simulate = "simulate " + scene + " --output " + path("r.bag"), out = " --output " + path("out");
  EXPECT_TRUE(refuses(simulate, {"scene.yaml", "mesh.file", "../bar.vtk", "models", "--allow-outside"}));
  ASSERT_EQ(call(simulate + " --allow-outside").code, 0);
  for (const std::string tool : {"estimate ", "diagnose "}) {
    EXPECT_TRUE(refuses(tool + model + " " + path("r.bag") + out, {"model.yaml", "../bar.vtk", "--allow-outside"}));
  }
  EXPECT_TRUE(refuses("check " + model, {"../bar.vtk", "--allow-outside"}));
  EXPECT_EQ(call("estimate " + model + " " + path("r.bag") + out + " --quiet --allow-outside").code, 0);
  EXPECT_TRUE(refuses("export " + path("out") + " --to vtu", {"../bar.vtk", "--allow-outside"}));
  EXPECT_EQ(call("export " + path("out") + " --to vtu --quiet --allow-outside").text, "");
}

TEST_F(Executables, WriteAModelThatHasItsFilesBesideIt) {
  film_hidden_damping();
  ASSERT_EQ(begin().wait(), 0);
  EXPECT_NE(read("out/model_next.yaml").find("model_files/bar.vtk"), std::string::npos) << read("out/model_next.yaml");
  std::filesystem::rename(path("out"), path("elsewhere"));
  EXPECT_EQ(call("check " + path("elsewhere/model_next.yaml")).text, "nothing found\n");
}

TEST_F(Executables, LeaveAReadableDiagnosisWheneverTheyAreKilled) {
  film_hidden_damping();
  const auto start = std::chrono::steady_clock::now();
  const int answered = begin().wait();
  const Seconds duration = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(diagnosis().value("complete", false), true);
  std::mt19937 random(1);
  for (int trial = 0; trial < 10; ++trial) {
    // A process that has not begun cannot write; one that loads its libraries will.
    const Seconds instant = duration * std::uniform_real_distribution<>(0.0, 1.0)(random);
    std::filesystem::remove_all(path("out"));
    const Diagnosing killed = begin();
    killed.wait_until_started();
    std::this_thread::sleep_for(instant);
    killed.send(SIGTERM);
    const int code = killed.wait();
    const nlohmann::json found = diagnosis();
    ASSERT_TRUE(found.is_object()) << "killed after " << instant.count() << " s: " << read("out/diagnosis.json");
    EXPECT_EQ(code, found.at("complete") == true ? answered : 75) << instant.count();
    EXPECT_EQ(found.contains("interrupted_during"), code == 75);
    EXPECT_EQ(found.at("steps").empty(), found.at("final").value("parameters", nlohmann::json()).empty());
    EXPECT_NE(read("out/report.html").find("</html>"), std::string::npos);
    EXPECT_EQ(read("out/report.html").find("The work was interrupted during") != std::string::npos, code == 75);
    EXPECT_NE(read("out/model_next.yaml"), "");
    EXPECT_FALSE(has_temporary_file());
  }
}

TEST_F(Executables, HearASignalThatCameWhileTheirLibrariesWereLoaded) {
  film_hidden_damping();
  const Diagnosing killed = begin();
  killed.wait_until_started();
  killed.send(SIGTERM);
  EXPECT_EQ(killed.wait(), 75);
  EXPECT_EQ(diagnosis().value("verdict", ""), "unfinished");
}

TEST_F(Executables, LeaveTheLastDiagnosisWhenTheyAreKilledOutright) {
  film_hidden_damping();
  for (const double instant : {0.0, 0.2, 0.5}) {
    const Diagnosing killed = begin();
    killed.wait_for_first_file();
    std::this_thread::sleep_for(Seconds(instant));
    killed.send(SIGKILL);
    killed.wait();
    EXPECT_TRUE(diagnosis().is_object()) << instant;
  }
}

TEST_F(Executables, EndAtOnceOnTheSecondSignal) {
  film_hidden_damping();
  const Diagnosing killed = begin();
  killed.wait_for_first_file();
  killed.send(SIGINT);
  killed.send(SIGTERM);
  EXPECT_EQ(killed.wait(), 75);
  EXPECT_EQ(diagnosis().value("complete", true), false);
  EXPECT_FALSE(std::filesystem::exists(path("out/report.html"))) << "nothing more is written";
}

TEST_F(Executables, EndWithWhatIsKnownWhenTheTimeIsUp) {
  const std::string inputs = film_hidden_damping();
  const std::string limit = " --time-limit 1e-3 --output " + path("out");
  const Outcome diagnosed = call("diagnose " + inputs + limit);
  EXPECT_EQ(diagnosed.code, 75) << diagnosed.text;
  EXPECT_NE(diagnosed.text.find("incomplete    interrupted during: "), std::string::npos) << diagnosed.text;
  EXPECT_EQ(diagnosis().value("complete", true), false);
  EXPECT_EQ(diagnosis().value("verdict", ""), "unfinished");
  const Outcome estimated = call("estimate " + inputs + limit);
  EXPECT_EQ(estimated.code, 75) << estimated.text;
  EXPECT_EQ(nlohmann::json::parse(read("out/results.json")).at("complete"), false);
  EXPECT_NE(read("out/report.html").find("The work was interrupted during"), std::string::npos);
  EXPECT_TRUE(refuses("estimate " + inputs + " --time-limit 0 --output " + path("out"), {"--time-limit"}));
}

TEST_F(Executables, TellTheShellWhetherTheAnswerIsToBeUsed) {
  const std::string inputs = film_hidden_damping();
  const Outcome estimated = call("estimate " + inputs + " --output " + path("out"));
  const auto results = nlohmann::json::parse(read("out/results.json"));
  EXPECT_EQ(results.at("complete"), true);
  EXPECT_TRUE(results.at("state") == "doubtful" || results.at("state") == "model_invalid") << results.at("state");
  EXPECT_EQ(estimated.code, 3) << estimated.text;
  for (const std::string tool : {"estimate", "diagnose"}) {
    const std::string help = call(tool + " --help").text;
    EXPECT_NE(help.find("Exit codes: 0 answered"), std::string::npos) << help;
    EXPECT_NE(help.find("--time-limit"), std::string::npos) << help;
  }
}

TEST_F(Executables, ColourOnlyOnATerminalThatWantsIt) {
  const std::string scene =
      write_model("scene.yaml", "4e5", vertices(), "simulation: {duration: 0.4, rate: 60, step: 0.001}\n");
  ASSERT_EQ(call("simulate " + scene + " --output " + path("r.bag") + " --quiet").text, "");
  const std::string model = write_model("model.yaml", "{prior: 8e5, factor: 3}", vertices());
  const std::string esc = "\033[";
  for (const std::string tool : {"estimate", "diagnose"}) {
    const std::string arguments = tool + " " + model + " " + path("r.bag") + " --output " + path("out");
    const std::string on_terminal = "script -qec '" + std::string(TISSUE_STIFFNESS_TOOLS) + "/" + arguments + "' /dev/null";
    const Outcome coloured = run("env -u NO_COLOR TERM=xterm " + on_terminal);
    ASSERT_EQ(coloured.code, 0) << coloured.text;
    EXPECT_NE(coloured.text.find(esc + "1m"), std::string::npos) << coloured.text;
    EXPECT_NE(coloured.text.find("\r" + tool), std::string::npos) << "no line that changes: " << coloured.text;
    const std::string refused = run("env NO_COLOR=1 TERM=xterm " + on_terminal).text;
    EXPECT_EQ(refused.find(esc + "1m"), std::string::npos) << refused;
    const std::string piped = call(arguments).text;
    EXPECT_EQ(piped.find('\033'), std::string::npos) << piped;
    EXPECT_EQ(piped.find('\r'), std::string::npos) << piped;
    EXPECT_NE(piped.find("written"), std::string::npos) << piped;
    EXPECT_EQ(call(arguments + " --quiet").text, "") << tool;
  }
}

TEST_F(Executables, SpeakJsonAndNothingElse) {
  const std::string scene =
      write_model("scene.yaml", "4e5", vertices(), "simulation: {duration: 0.4, rate: 60, step: 0.001}\n");
  const auto simulated = nlohmann::json::parse(call("simulate " + scene + " --output " + path("r.bag") + " --json").text);
  EXPECT_EQ(simulated.at("frames"), 24);
  EXPECT_GT(simulated.at("motion_rms").get<double>(), 0.0);
  const std::string inputs = write_model("model.yaml", "{prior: 8e5, factor: 3}", vertices()) + " " + path("r.bag");
  const std::string output = " --json --output " + path("out");
  const auto estimated = nlohmann::json::parse(call("estimate " + inputs + output).text);
  EXPECT_EQ(estimated, nlohmann::json::parse(read("out/results.json")));
  EXPECT_TRUE(estimated.at("parameters").contains("elasticity.young_modulus"));
  const auto diagnosed = nlohmann::json::parse(call("diagnose " + inputs + output).text);
  EXPECT_EQ(diagnosed, nlohmann::json::parse(read("out/diagnosis.json")));
  const auto library = nlohmann::json::parse(call("effects --json").text);
  std::string names;
  for (const auto& effect : library) {
    names += effect.at("name").get<std::string>() + "\n";
    for (const auto& parameter : effect.at("parameters")) EXPECT_NE(parameter.at("unit"), "") << effect.at("name");
  }
  EXPECT_EQ(names, call("effects --quiet").text);
}

TEST_F(Executables, DiagnoseWhatWasRecordedWithoutRos) {
  const std::string arguments = film_hidden_damping();
  std::ofstream points(path("points.csv"));
  points << std::fixed << std::setprecision(9) << "time,vertex,x,y,z\n";
  BagReader reader(path("r.bag"), load_model(path("model.yaml")));
  while (const auto instant = reader.next()) {
    const Observation& seen = instant->frame.observations.at(0);
    for (Eigen::Index i = 0; i < seen.ids.size(); ++i) {
      points << instant->frame.time << "," << seen.ids[i];
      for (int axis = 0; axis < 3; ++axis) points << "," << seen.points(axis, i);
      points << "\n";
    }
  }
  points.close();
  const std::string data = " --data /tissue/vertices=" + path("points.csv") + " --json --output " + path("out");
  const Outcome found = call("diagnose " + path("model.yaml") + data);
  EXPECT_EQ(found.code, 0) << found.text;
  EXPECT_EQ(diagnosis()["verdict"], "missing");
  EXPECT_EQ(diagnosis()["set"][0], "viscous_damping");
  EXPECT_TRUE(std::filesystem::exists(path("out/recording.bag")));
  EXPECT_TRUE(refuses("diagnose " + arguments + data, {"RECORDING", "r.bag beside --data or --video"}));
  EXPECT_TRUE(refuses("diagnose " + path("model.yaml") + " --output " + path("out"), {"RECORDING", "nothing"}));
}

TEST_F(Executables, PrintTheLibrary) {
  const Outcome plain = call("effects"), page = call("effects --markdown");
  for (const std::string word : {"elasticity", "young_modulus", "[Pa]", "Yang & Lin"}) {
    EXPECT_NE(plain.text.find(word), std::string::npos) << word;
  }
  EXPECT_NE(page.text.find("| `young_modulus` | E | Pa |"), std::string::npos) << page.text;
}

TEST_F(Executables, TheDocumentedPagesAreWhatTheyPrint) {
  for (const std::string tool : {"effects", "parameters"}) {
    std::ifstream page(std::string(TISSUE_STIFFNESS_SOURCE_DIR) + "/doc/" + tool + ".md");
    const std::string documented{std::istreambuf_iterator<char>(page), {}};
    EXPECT_EQ(documented, call(tool + " --markdown").text)
        << "scripts/run " << tool << " --markdown > doc/" << tool << ".md";
  }
}

}  // namespace
}  // namespace tissue_stiffness
