#include "nodes/estimator_node.hpp"
#include "nodes/run_node.hpp"
#include "types/freed_memory.hpp"
#include "vtu/vtu_reader.hpp"

int main(int argc, char** argv) {
  tissue_stiffness::return_large_blocks();  // model checks take hundreds of megabytes for a while
  ros::init(argc, argv, "estimator_node");
  tissue_stiffness::accept_vtu_meshes();
  return tissue_stiffness::run_node<tissue_stiffness::EstimatorNode>();
}
