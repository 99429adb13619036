#include "nodes/estimator_node.hpp"
#include "nodes/run_node.hpp"
#include "types/freed_memory.hpp"

int main(int argc, char** argv) {
  tissue_stiffness::return_large_blocks();  // model checks take hundreds of megabytes for a while
  ros::init(argc, argv, "estimator_node");
  return tissue_stiffness::run_node<tissue_stiffness::EstimatorNode>();
}
