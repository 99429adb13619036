# The core without ROS, for programs that are no catkin packages: find_package(tissue_stiffness_core) and the target
# tissue_stiffness::core. `cmake --install build --component core --prefix FOLDER` installs it alone.
set(core_folder ${CATKIN_GLOBAL_LIB_DESTINATION}/cmake/tissue_stiffness_core)
install(TARGETS ${tissue_stiffness_core_targets} EXPORT tissue_stiffness_core
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION} COMPONENT core
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION} COMPONENT core)
install(EXPORT tissue_stiffness_core NAMESPACE tissue_stiffness:: FILE targets.cmake DESTINATION ${core_folder} COMPONENT core)
install(DIRECTORY include/${PROJECT_NAME}/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION} COMPONENT core)
install(FILES cmake/tissue_stiffness_coreConfig.cmake DESTINATION ${core_folder} COMPONENT core)
