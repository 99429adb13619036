// The tools as a user meets them: exit codes, one line on what is wrong, help.
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "workbench.hpp"

namespace tissue_stiffness {
namespace {

struct Outcome {
  int code;
  std::string text;  ///< standard output and error
};

Outcome run(const std::string& command) {
  Outcome outcome{-1, ""};
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    outcome.text.append(buffer.data(), count);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.code = WEXITSTATUS(status);
  return outcome;
}

Outcome call(const std::string& command) {
  return run(std::string(TISSUE_STIFFNESS_TOOLS) + "/" + command);
}

/// Exit code 2 and one line with all the words.
::testing::AssertionResult refuses(const std::string& command, const std::vector<std::string>& words) {
  Outcome outcome = call(command);
  if (outcome.code != 2) return ::testing::AssertionFailure() << "exit code " << outcome.code << ": " << outcome.text;
  if (!outcome.text.empty() && outcome.text.back() == '\n') outcome.text.pop_back();
  return says(outcome.text, words);
}

class Executables : public Workbench {};

TEST_F(Executables, HelpThemselves) {
  for (const std::string tool : {"estimate", "diagnose", "simulate", "effects", "parameters"}) {
    const Outcome help = call(tool + " --help");
    EXPECT_EQ(help.code, 0) << help.text;
    EXPECT_NE(help.text.find("Usage"), std::string::npos) << help.text;
    EXPECT_NE(help.text.find("Example: " + tool), std::string::npos) << help.text;
  }
}

TEST_F(Executables, RefuseWrongArguments) {
  EXPECT_TRUE(refuses("estimate", {"estimate:", "required"}));
  EXPECT_TRUE(refuses("estimate a.yaml b.bag --output " + path("out") + " --colour", {"--colour"}));
  EXPECT_TRUE(refuses("estimate a.yaml b.bag --output " + path("out") + " --frames -3", {"frames"}));
  EXPECT_TRUE(refuses("simulate", {"simulate:", "required"}));
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
