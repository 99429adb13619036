#include "nodes/run_node.hpp"
#include "nodes/segmentation_node.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "segmentation_node");
  return tissue_stiffness::run_node<tissue_stiffness::SegmentationNode>();
}
