#include "nodes/reconfiguration.hpp"

#include <utility>

namespace tissue_stiffness {

Reconfiguration::Reconfiguration(const ros::NodeHandle& private_node, const LiveOptions& start, Apply apply, Refuse refuse)
    : where_("parameters of " + private_node.getNamespace()),
      apply_(std::move(apply)),
      refuse_(std::move(refuse)),
      running_(to_config(start)),
      server_(mutex_, private_node) {
  server_.setConfigMin(least_config());
  server_.setConfigMax(largest_config());
  server_.updateConfig(running_);
  server_.setCallback([this](EstimatorConfig& wanted, std::uint32_t) { on_request(wanted); });
}

// The server keeps what this function leaves in `wanted`, and catches what it throws.
void Reconfiguration::on_request(EstimatorConfig& wanted) {
  try {
    apply_(to_live_options(wanted, where_));
    running_ = wanted;
  } catch (const std::exception& error) {
    refuse_(error.what());
    wanted = running_;
  }
}

}  // namespace tissue_stiffness
