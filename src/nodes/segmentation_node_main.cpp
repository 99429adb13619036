#include "tissue_stiffness/nodes/run_node.hpp"
#include "tissue_stiffness/nodes/segmentation_node.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "segmentation_node");
  return tissue_stiffness::run_node<tissue_stiffness::SegmentationNode>();
}
