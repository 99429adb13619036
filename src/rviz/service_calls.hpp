#pragma once

#include <ros/node_handle.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace tissue_stiffness {

/// Calls the estimator's services one after the other in a separate thread, so that the caller never waits. Answers are
/// delivered in that thread.
class ServiceCalls {
 public:
  struct Answer {
    bool success = false;
    std::string message;
    std::vector<std::string> added;  ///< effects that add_effect added to the running model, requested after the call
    bool added_known = false;
  };
  using Done = std::function<void(const Answer&)>;

  ServiceCalls();
  /// Cancels the call in progress and those that wait. Their answers are not delivered.
  ~ServiceCalls();

  /// Each function calls the service of that name below `node`.
  void diagnose(const ros::NodeHandle& node, Done done);
  void add_effect(const ros::NodeHandle& node, const std::string& effect, Done done);
  void remove_effect(const ros::NodeHandle& node, const std::string& effect, Done done);
  void reset(const ros::NodeHandle& node, Done done);
  /// Requests only the added effects. The answer holds none when there is no estimator.
  void list_effects(const ros::NodeHandle& node, Done done);

 private:
  template <typename Service>
  Answer ask(ros::NodeHandle node, const std::string& name, Service& service);
  /// `changes_model`: the answer includes the effects that are added after the call.
  template <typename Service>
  void call(const ros::NodeHandle& node, const std::string& name, Service service, bool changes_model, Done done);
  Answer with_added(const ros::NodeHandle& node, Answer answer);
  void enqueue(std::function<Answer()> call, Done done);
  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::pair<std::function<Answer()>, Done>> calls_;
  ros::ServiceClient running_;  ///< client of the call in progress
  bool stopped_ = false;
  std::thread thread_;
};

}  // namespace tissue_stiffness
