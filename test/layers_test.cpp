// Guards the layers: an include points only up the table, ROS stays in the nodes and the tools.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

/// What a layer may include, besides itself.
const std::map<std::string, std::set<std::string>> kAllowed = [] {
  std::map<std::string, std::set<std::string>> allowed{{"types", {}}};
  const auto add = [&](const std::string& layer, const std::vector<std::string>& above) {
    for (const std::string& name : above) {
      allowed[layer].insert(name);
      allowed[layer].insert(allowed.at(name).begin(), allowed.at(name).end());
    }
  };
  add("settings", {"types"});
  add("segmentation", {"settings"});
  add("meshing", {"settings"});
  add("vtu", {"meshing"});
  add("fem", {"settings"});
  add("effects", {"fem", "meshing"});
  add("forward", {"effects"});
  add("export", {"forward"});
  add("filter", {"types"});
  add("observation", {"forward", "filter"});
  add("fit", {"observation"});
  add("estimation", {"fit"});
  add("diagnosis", {"estimation"});
  add("report", {"settings"});
  add("check", {"estimation", "segmentation", "report"});
  add("nodes", {"diagnosis", "segmentation", "report", "check", "vtu"});
  add("tools", {"nodes", "export"});
  add("nodelets", {"nodes"});
  add("rviz", {"nodes"});
  add("python", {"tools"});
  return allowed;
}();

bool is_ros(const std::string& header) {
  static const std::regex ros(
      "^(ros|rosbag|tf2?|tf2_\\w+|\\w+_msgs|std_srvs|cv_bridge|image_transport|pcl_conversions|topic_tools|XmlRpc\\w*|"
      "message_filters|diagnostic_updater|dynamic_reconfigure|pluginlib|nodelet|rviz)(/|\\.h).*|^tissue_stiffness/"
      "[A-Z]\\w*\\.h$");
  return std::regex_match(header, ros);
}

/// What is wrong with an include of `header` in `layer`; empty when nothing is.
std::string fault(const std::string& layer, const std::string& header) {
  static const std::set<std::string> with_ros{"nodes", "nodelets", "tools", "rviz"};
  if (is_ros(header) && with_ros.count(layer) == 0) return "ROS outside nodes, tools and rviz";
  static const std::regex qt("^((Qt|Q[A-Z])\\w*(/.*)?|qwt_\\w+\\.h)$");
  if (std::regex_match(header, qt) && layer != "rviz") return "Qt or Qwt outside rviz";
  std::smatch match;
  static const std::regex own("^(tissue_stiffness/)?([a-z_]+)/.*");
  if (!std::regex_match(header, match, own) || match[2] == layer) return "";
  const bool is_public = match[1].matched;
  if (kAllowed.count(match[2]) == 0) return is_public ? "no such layer" : "";
  return kAllowed.at(layer).count(match[2]) == 1 ? "" : layer + " may not use " + match[2].str();
}

std::vector<std::string> includes(const fs::path& file) {
  static const std::regex include("^\\s*#\\s*include\\s*[<\"]([^>\"]+)[>\"].*");
  std::vector<std::string> out;
  std::ifstream stream(file);
  std::smatch match;
  for (std::string line; std::getline(stream, line);) {
    if (std::regex_match(line, match, include)) out.push_back(match[1]);
  }
  return out;
}

TEST(Layers, IncludesPointOnlyUpTheTable) {
  int files = 0;
  for (const char* top : {"include/tissue_stiffness", "src"}) {
    for (const auto& [layer, above] : kAllowed) {
      const fs::path folder = fs::path(TISSUE_STIFFNESS_SOURCE_DIR) / top / layer;
      if (!fs::exists(folder)) continue;
      for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        ++files;
        for (const std::string& header : includes(entry.path())) {
          EXPECT_EQ(fault(layer, header), "") << entry.path() << " includes " << header;
        }
      }
    }
  }
  EXPECT_GT(files, 50) << "the folders of the layers were not found";
}

TEST(Layers, EveryFolderIsALayer) {
  for (const char* top : {"include/tissue_stiffness", "src"}) {
    for (const auto& entry : fs::directory_iterator(fs::path(TISSUE_STIFFNESS_SOURCE_DIR) / top)) {
      EXPECT_EQ(kAllowed.count(entry.path().filename().string()), 1U) << entry.path();
    }
  }
}

// A program that uses the installed package sees the public headers alone.
TEST(Layers, PublicHeadersIncludePublicHeaders) {
  const fs::path top = fs::path(TISSUE_STIFFNESS_SOURCE_DIR) / "include";
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(top)) {
    if (!entry.is_regular_file()) continue;
    ++files;
    for (const std::string& header : includes(entry.path())) {
      const bool own = header.rfind("tissue_stiffness/", 0) == 0;
      const bool other = kAllowed.count(header.substr(0, header.find('/'))) == 0;
      EXPECT_TRUE(own ? fs::exists(top / header) : other) << entry.path() << " includes " << header;
    }
  }
  EXPECT_GT(files, 10);
}

TEST(Layers, FaultsAreFound) {
  EXPECT_NE(fault("fem", "ros/ros.h"), "");
  EXPECT_NE(fault("forward", "sensor_msgs/Image.h"), "");
  EXPECT_NE(fault("report", "rviz/panel.h"), "");
  EXPECT_NE(fault("nodes", "QWidget"), "");
  EXPECT_NE(fault("report", "qwt_plot.h"), "");
  EXPECT_EQ(fault("rviz", "QWidget"), "");
  EXPECT_EQ(fault("rviz", "qwt_plot.h"), "");
  EXPECT_NE(fault("report", "tissue_stiffness/StiffnessEstimate.h"), "");
  EXPECT_NE(fault("types", "tissue_stiffness/settings/value.hpp"), "");
  EXPECT_NE(fault("filter", "forward/model.hpp"), "");
  EXPECT_NE(fault("nodes", "tools/bag_reader.hpp"), "");
  EXPECT_EQ(fault("tools", "tissue_stiffness/types/error.hpp"), "");
  EXPECT_EQ(fault("nodes", "ros/ros.h"), "");
  EXPECT_EQ(fault("fem", "Eigen/Core"), "");
}

std::string content(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The page of hazards names tests, by `Suite.Name` or `test_name`. Each of them exists.
TEST(Hazards, EachIsShownByATestThatExists) {
  const fs::path root = TISSUE_STIFFNESS_SOURCE_DIR;
  std::string tests;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / "test")) {
    const std::string ending = entry.path().extension().string();
    if (ending == ".cpp" || ending == ".py") tests += content(entry.path());
  }
  const std::string page = content(root / "doc" / "hazards.md");
  const std::regex named("`(?:([A-Z]\\w+)\\.([A-Z]\\w+)|(test_\\w+))`");
  int count = 0;
  for (std::sregex_iterator test(page.begin(), page.end(), named), end; test != end; ++test, ++count) {
    const std::string text =
        (*test)[3].matched ? "def " + (*test)[3].str() + "(" : (*test)[1].str() + ", " + (*test)[2].str() + ")";
    EXPECT_NE(tests.find(text), std::string::npos) << (*test)[0];
  }
  EXPECT_GT(count, 40);
}

}  // namespace
