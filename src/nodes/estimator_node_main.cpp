#include "nodes/estimator_node.hpp"
#include "nodes/run_node.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "estimator_node");
  return tissue_stiffness::run_node<tissue_stiffness::EstimatorNode>();
}
