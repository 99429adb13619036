#include "nodes/mesh_node.hpp"
#include "nodes/run_node.hpp"
#include "vtu/vtu_reader.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "mesh_node");
  tissue_stiffness::accept_vtu_meshes();
  return tissue_stiffness::run_node<tissue_stiffness::MeshNode>();
}
