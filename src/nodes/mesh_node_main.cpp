#include "nodes/mesh_node.hpp"
#include "nodes/run_node.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "mesh_node");
  return tissue_stiffness::run_node<tissue_stiffness::MeshNode>();
}
