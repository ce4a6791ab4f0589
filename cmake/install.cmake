# Install space: `rosrun` and `roslaunch` work from it as from the development space.
install(TARGETS uav_landing_core uav_landing_ros uav_landing_nodelets
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION})
install(TARGETS dataset_to_bag inject_faults measure_noise_bound measure_runways process_bag simulate_approach simulate_campaign RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(PROGRAMS src/tools/evaluate src/tools/convert_recording src/tools/split_images scripts/flightgear DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(DIRECTORY src/tools/evaluation src/tools/conversion DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION} FILES_MATCHING PATTERN "*.py")
install(DIRECTORY include/uav_landing/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION})
install(FILES nodelet_plugins.xml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
install(DIRECTORY config launch rviz DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
