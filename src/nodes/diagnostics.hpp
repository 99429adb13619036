#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <limits>
#include <map>
#include <mutex>
#include <string>

namespace tissue_stiffness {

/// Publishes a node's state on /diagnostics by a diagnostic_updater: counts, texts and the times of stages. It is thread
/// safe.
class Diagnostics {
 public:
  /// `period`: between two messages [s, wall time], because simulated time may stand still or jump back.
  Diagnostics(ros::NodeHandle node, const std::string& name, double period);

  void count(const std::string& key);
  void set(const std::string& key, const std::string& text);
  /// Returns a text; empty when it was never set.
  std::string text(const std::string& key);
  /// Adds the wall time of a stage [s]. Its mean and its longest are published.
  void time(const std::string& stage, double seconds);
  void state(std::uint8_t level, const std::string& message);

  /// Watches an input by its topic. Its age is published. If nothing has come for more than the longest silence, a level of
  /// OK becomes WARN, and the message names the topic.
  void expect(const std::string& topic);
  /// Sets how long an input may be silent [s, wall time].
  void set_longest_silence(double seconds);
  /// Notes that a message has come on a topic, usable or not.
  void heard(const std::string& topic);

  /// Counts a message that was left out, and logs it at most once a second.
  void bad_message(const std::string& what);

 private:
  struct Stage {
    double sum = 0.0, longest = 0.0;
    int runs = 0;
  };
  struct Input {
    ros::WallTime last;
    bool heard = false;
  };
  using Status = diagnostic_updater::DiagnosticStatusWrapper;
  void publish();
  void fill(Status& status);
  void add_inputs(Status& status) const;

  std::mutex mutex_;
  std::uint8_t level_ = Status::OK;
  std::string message_ = "starting";
  std::map<std::string, int> counts_;
  std::map<std::string, std::string> texts_;
  std::map<std::string, Stage> stages_;
  std::map<std::string, Input> inputs_;
  double longest_silence_ = std::numeric_limits<double>::infinity();
  ros::Publisher topic_;
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;  ///< last member, because it uses the ones above
};

}  // namespace tissue_stiffness
