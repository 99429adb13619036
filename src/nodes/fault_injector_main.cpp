#include "nodes/fault_injector.hpp"
#include "nodes/run_node.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "fault_injector");
  return tissue_stiffness::run_node<tissue_stiffness::FaultInjector>();
}
