#pragma once

#include <dynamic_reconfigure/server.h>
#include <ros/node_handle.h>

#include <boost/thread/recursive_mutex.hpp>
#include <functional>
#include <string>

#include "nodes/live_options.hpp"

namespace tissue_stiffness {

/// Lets LiveOptions change while the node runs, by dynamic_reconfigure. A request with a wrong value changes nothing: the
/// answer holds the values that stay.
class Reconfiguration {
 public:
  /// Receives the new options, from a thread that serves callbacks.
  using Apply = std::function<void(const LiveOptions&)>;
  /// Receives a sentence that names the parameter, its value and what is allowed.
  using Refuse = std::function<void(const std::string&)>;

  /// Writes the options that the node starts with to its private parameters, and calls `apply` with them.
  Reconfiguration(const ros::NodeHandle& private_node, const LiveOptions& start, Apply apply, Refuse refuse);

 private:
  void on_request(EstimatorConfig& wanted);

  const std::string where_;
  const Apply apply_;
  const Refuse refuse_;
  EstimatorConfig running_;
  boost::recursive_mutex mutex_;
  dynamic_reconfigure::Server<EstimatorConfig> server_;  ///< last member, because its callback uses the ones above
};

}  // namespace tissue_stiffness
