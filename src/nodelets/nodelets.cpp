// The segmentation and the estimator as nodelets: in one process with the camera's driver, images and outlines pass between
// them as pointers.
#include <nodelet/nodelet.h>

#include <memory>
#include <pluginlib/class_list_macros.hpp>

#include "nodes/estimator_node.hpp"
#include "nodes/segmentation_node.hpp"
#include "vtu/vtu_reader.hpp"

namespace tissue_stiffness {

/// A node as a nodelet. A wrong setting is one fatal line, and the nodelet does not load.
template <typename Node>
class NodeletOf : public nodelet::Nodelet {
  void onInit() override {
    accept_vtu_meshes();
    try {
      node_ = std::make_unique<Node>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const std::exception& error) {
      NODELET_FATAL("%s", error.what());
      throw;
    }
  }
  std::unique_ptr<Node> node_;
};

class SegmentationNodelet : public NodeletOf<SegmentationNode> {};
class EstimatorNodelet : public NodeletOf<EstimatorNode> {};

}  // namespace tissue_stiffness

PLUGINLIB_EXPORT_CLASS(tissue_stiffness::SegmentationNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(tissue_stiffness::EstimatorNodelet, nodelet::Nodelet)
