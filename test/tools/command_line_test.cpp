// Arguments of a tool: what reaches the variables, what is refused and in which words, and the help.
#include "tools/command_line.hpp"

#include <gtest/gtest.h>

#include "workbench.hpp"

namespace tissue_stiffness {
namespace {

using Words = std::vector<std::string>;

class CommandLineTest : public testing::Test {
 protected:
  CommandLineTest() : line("Measures things.", "measure") {
    line.add_positional("MODEL", model, "model file").required();
    line.add_positional("RECORDING", recordings, "rosbags");
    line.add_option("-o,--output", output, "folder").required();
    line.add_option("--data", data, "files");
    line.add_option("--seed", seed, "point of the image").count(2, 2);
    line.add_option("--frames", frames, "number of frames").positive();
    line.add_option("--offset", offset, "frames to skip");
    line.add_option("--count", count, "frames to leave out");
    line.add_option("--time-limit", time_limit, "end after so many seconds").positive();
    line.add_option("--at", at, "time [s]");
    line.add_option("--to", to, "the format").one_of({"febio", "usd"});
    const CommandArgument& manifest = line.add_option("--manifest", list, "CSV file");
    line.add_option("--threads", threads, "rows at once").needs(manifest).between(1, 1000);
    line.add_flag("--resume", resume, "keep what is there").needs(manifest);
    line.add_flag("-q,--quiet", quiet, "no table");
    line.footer("Example: measure model.yaml -o out");
  }

  /// Parses words behind a model and an output.
  void parse(const Words& words) {
    Words all{"m.yaml", "-o", "out"};
    all.insert(all.end(), words.begin(), words.end());
    EXPECT_EQ(line.parse(all), CommandLine::Wanted::run);
  }
  /// What is wrong with such a command line.
  std::string fault(const Words& words) {
    return input_error([&] { parse(words); });
  }
  std::string whole_fault(const Words& words) {
    return input_error([&] { line.parse(words); });
  }

  std::string model, output, to, list;
  Words recordings, data;
  std::vector<double> seed;
  std::size_t frames = 7, threads = 1;
  int offset = 0;
  unsigned count = 0;
  double time_limit = 0.0;
  std::optional<double> at;
  bool resume = false, quiet = false;
  CommandLine line;
};

TEST_F(CommandLineTest, ReadsEachKindOfValue) {
  parse({"a.bag", "b.bag",    "--frames", "3",   "--offset", "-2",         "--time-limit", "1e-3",
         "--at",  "0.5",      "--to",     "usd", "--quiet",  "--manifest", "list.csv",     "--threads",
         "1000",  "--resume", "--seed",   "3.5", "4",        "--data",     "x=1"});
  EXPECT_EQ(model, "m.yaml");
  EXPECT_EQ(output, "out");
  EXPECT_EQ(recordings, (Words{"a.bag", "b.bag"}));
  EXPECT_EQ(frames, 3U);
  EXPECT_EQ(offset, -2);
  EXPECT_EQ(time_limit, 1e-3);
  EXPECT_EQ(at, 0.5);
  EXPECT_EQ(to, "usd");
  EXPECT_EQ(list, "list.csv");
  EXPECT_EQ(threads, 1000U);
  EXPECT_EQ(seed, (std::vector<double>{3.5, 4.0}));
  EXPECT_EQ(data, Words{"x=1"});
  EXPECT_TRUE(resume && quiet);
}

TEST_F(CommandLineTest, LeavesWhatIsNotGiven) {
  parse({});
  EXPECT_EQ(frames, 7U);
  EXPECT_EQ(at, std::nullopt);
  EXPECT_TRUE(recordings.empty() && data.empty());
  EXPECT_FALSE(resume || quiet);
}

TEST_F(CommandLineTest, ReadsAllForms) {
  line.parse({"--output=out=1", "--frames=3", "m.yaml", "-q"});
  EXPECT_EQ(output, "out=1");
  EXPECT_EQ(frames, 3U);
  EXPECT_TRUE(quiet);
  line.parse({"m.yaml", "-oelsewhere"});
  EXPECT_EQ(output, "elsewhere");
  line.parse({"m.yaml", "-o", "", "--quiet", "--quiet"});
  EXPECT_EQ(output, "");
}

TEST_F(CommandLineTest, ReadsNegativeNumbers) {
  parse({"--at", "-1"});
  EXPECT_EQ(at, -1.0);
  parse({"--at=-.5"});
  EXPECT_EQ(at, -0.5);
  parse({"--at", "-.5e-1", "--seed", "-1", "-2"});
  EXPECT_EQ(at, -0.05);
  EXPECT_EQ(seed, (std::vector<double>{-1.0, -2.0}));
  parse({"-1"});
  EXPECT_EQ(recordings, Words{"-1"}) << "a file may have any name";
}

TEST_F(CommandLineTest, GivesAVectorAllValuesUpToTheNextOption) {
  line.parse({"--data", "a", "b", "m.yaml", "-o", "out", "x.bag", "--data", "c", "d"});
  EXPECT_EQ(data, (Words{"a", "b", "m.yaml", "c", "d"}));
  EXPECT_EQ(model, "x.bag");
  EXPECT_TRUE(recordings.empty());
}

TEST_F(CommandLineTest, LeavesTheLastWordsToRequiredArguments) {
  line.parse({"-o", "out", "--data", "a", "b", "m.yaml"});
  EXPECT_EQ(data, (Words{"a", "b"}));
  EXPECT_EQ(model, "m.yaml");
}

TEST_F(CommandLineTest, GivesAVectorNoMoreThanItTakes) {
  line.parse({"-o", "out", "--seed", "1", "2", "m.yaml", "a.bag"});
  EXPECT_EQ(seed.size(), 2U);
  EXPECT_EQ(model, "m.yaml");
  EXPECT_EQ(recordings, Words{"a.bag"});
}

TEST_F(CommandLineTest, TakesEverythingBehindTwoDashesByItsPosition) {
  line.parse({"-o", "out", "--data", "a", "b", "--", "--odd.yaml", "--help"});
  EXPECT_EQ(data, (Words{"a", "b"}));
  EXPECT_EQ(model, "--odd.yaml");
  EXPECT_EQ(recordings, Words{"--help"});
}

TEST_F(CommandLineTest, RefusesAnUnknownOption) {
  EXPECT_EQ(fault({"--colour"}), "--colour: no such option");
  EXPECT_EQ(fault({"--colour=red"}), "--colour: no such option");
  EXPECT_EQ(fault({"--colour", "red"}), "--colour: no such option");
  EXPECT_EQ(fault({"--farmes", "3"}), "--farmes: no such option (did you mean `--frames`?)");
  EXPECT_EQ(fault({"--colour="}), "--colour: no such option");
  EXPECT_EQ(fault({"-x"}), "-x: no such option");
  EXPECT_EQ(fault({"---h"}), "---h: no such option");
  EXPECT_EQ(fault({"--=x"}), "--=x: no such option");
}

TEST_F(CommandLineTest, GuessesNoAbbreviation) {
  EXPECT_NE(fault({"--frame", "3"}), "");
  EXPECT_NE(fault({"--dat", "x=1"}), "");
  EXPECT_NE(fault({"--Frames", "3"}), "");
  EXPECT_EQ(frames, 7U);
}

TEST_F(CommandLineTest, RefusesANumberThatIsNone) {
  for (const std::string text : {"abc", "3x", "1.5", " 3", "0", "-1", "99999999999999999999999"}) {
    EXPECT_EQ(fault({"--frames", text}), "--frames: found " + text + "; allowed: a positive whole number");
    EXPECT_EQ(fault({"--frames=" + text}), fault({"--frames", text}));
  }
  for (const std::string text : {"abc", "1e", "1,5", "nan", "inf", "1e999", "0x10"}) {
    EXPECT_EQ(fault({"--at", text}), "--at: found " + text + "; allowed: a number");
  }
  EXPECT_EQ(fault({"--at", ""}), "--at: found an empty text; allowed: a number");
  EXPECT_EQ(fault({"--offset", "1.5"}), "--offset: found 1.5; allowed: a whole number");
  EXPECT_EQ(fault({"--count", "-1"}), "--count: found -1; allowed: a whole number from 0 on");
  EXPECT_EQ(fault({"--time-limit", "0"}), "--time-limit: found 0; allowed: a positive number");
  EXPECT_EQ(fault({"--seed", "1", "b"}), "--seed: found b; allowed: a number");
}

TEST_F(CommandLineTest, RefusesANumberOutOfItsRange) {
  for (const std::string text : {"0", "1001", "-1"}) {
    EXPECT_EQ(fault({"--manifest", "l.csv", "--threads", text}),
              "--threads: found " + text + "; allowed: a whole number from 1 to 1000");
  }
}

TEST_F(CommandLineTest, RefusesAWordThatIsNotAllowed) {
  EXPECT_EQ(fault({"--to", "abaqus"}), "--to: found abaqus; allowed: febio, usd");
  EXPECT_EQ(fault({"--to", "febjo"}), "--to: found febjo (did you mean `febio`?); allowed: febio, usd");
}

TEST_F(CommandLineTest, RefusesAnOptionWithoutWhatItNeeds) {
  EXPECT_EQ(fault({"--threads", "2"}), "--threads requires --manifest");
  EXPECT_EQ(fault({"--resume"}), "--resume requires --manifest");
}

TEST_F(CommandLineTest, RefusesALineWithoutWhatIsRequired) {
  EXPECT_EQ(whole_fault({}), "MODEL is required");
  EXPECT_EQ(whole_fault({"m.yaml"}), "--output is required");
  EXPECT_EQ(whole_fault({"-o", "out"}), "MODEL is required");
}

TEST_F(CommandLineTest, RefusesAnOptionWithoutItsValue) {
  EXPECT_EQ(fault({"--frames"}), "--frames: found no value; allowed: a positive whole number");
  EXPECT_EQ(fault({"--at", "--quiet"}), "--at: found no value; allowed: a number");
  EXPECT_EQ(fault({"--data", "-q"}), "--data: found no value; allowed: a text");
  EXPECT_EQ(fault({"--frames="}), "--frames: found no value; allowed: a positive whole number");
  EXPECT_EQ(whole_fault({"m.yaml", "-o"}), "--output: found no value; allowed: a text");
  EXPECT_EQ(fault({"--to=-q"}), "--to: found -q; allowed: febio, usd") << "here it is a value";
}

TEST_F(CommandLineTest, RefusesAFlagWithAValue) {
  EXPECT_EQ(fault({"--quiet=3"}), "--quiet: found a value; allowed: the flag alone");
}

TEST_F(CommandLineTest, RefusesTooManyValuesAndTooFew) {
  EXPECT_EQ(fault({"--frames", "3", "--frames", "4"}), "--frames: found 2 values; allowed: 1 value");
  EXPECT_EQ(fault({"--seed", "3"}), "--seed: found 1 value; allowed: 2 values");
  EXPECT_EQ(fault({"--seed", "3", "4", "--seed", "5"}), "--seed: found 3 values; allowed: 2 values");
}

TEST_F(CommandLineTest, RefusesTooManyAndTooFewPositionalArguments) {
  CommandLine two("Compares.", "compare");
  Words runs;
  two.add_positional("RUNS", runs, "folders").required().count(2, 3);
  const auto fault_of = [&](const Words& words) { return input_error([&] { two.parse(words); }); };
  EXPECT_EQ(fault_of({"a"}), "RUNS: found 1 value; allowed: 2 to 3 values");
  EXPECT_EQ(fault_of({"a", "b", "c", "d"}), "d: found one argument too many; allowed: compare [OPTIONS] RUNS ...");
  EXPECT_EQ(fault_of({"a", "b"}), "");
  CommandLine none("Prints.", "effects");
  EXPECT_EQ(input_error([&] { none.parse({"x"}); }), "x: found one argument too many; allowed: effects [OPTIONS]");
}

TEST_F(CommandLineTest, HelpsWhateverElseIsAsked) {
  for (const std::string flag : {"--help", "-h"}) {
    EXPECT_EQ(line.parse({flag}), CommandLine::Wanted::help);
    EXPECT_EQ(line.parse({"--colour", "--frames", "abc", flag, "--version"}), CommandLine::Wanted::help);
  }
  EXPECT_EQ(line.parse({"--version"}), CommandLine::Wanted::versions);
}

TEST_F(CommandLineTest, TheHelpShowsEachArgumentAndItsConditions) {
  EXPECT_EQ(line.help(), R"(Measures things.
Usage: measure [OPTIONS] MODEL [RECORDING ...]

Positional arguments:
  MODEL                     model file (required)
  RECORDING ...             rosbags

Options:
  -h, --help                print this help and exit
  --version                 print the versions of the package and its libraries and exit
  -o, --output TEXT         folder (required)
  --data TEXT ...           files
  --seed NUMBER ...         point of the image
  --frames NUMBER           number of frames
  --offset NUMBER           frames to skip
  --count NUMBER            frames to leave out
  --time-limit NUMBER       end after so many seconds
  --at NUMBER               time [s]
  --to TEXT                 the format: febio, usd
  --manifest TEXT           CSV file
  --threads NUMBER          rows at once (with --manifest)
  --resume                  keep what is there (with --manifest)
  -q, --quiet               no table

Example: measure model.yaml -o out
)");
}

TEST_F(CommandLineTest, TheHelpBreaksLongLines) {
  CommandLine tool("Prints.", "print");
  std::string text;
  const std::string sentence = "which says at some length what the option is there for";
  tool.add_option("--an-option-with-a-long-name", text, sentence + " " + sentence);
  const std::string help = tool.help(), margin(28, ' ');
  EXPECT_NE(help.find("  --an-option-with-a-long-name TEXT\n" + margin + "which says"), std::string::npos) << help;
  std::istringstream lines(help);
  for (std::string one; std::getline(lines, one);) {
    EXPECT_LE(one.size(), 100U);
    EXPECT_TRUE(one.empty() || one.back() != ' ') << one;
  }
}

}  // namespace
}  // namespace tissue_stiffness
