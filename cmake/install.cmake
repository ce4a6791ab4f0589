# Install space: `rosrun` and `roslaunch` work from it as from the development space.
foreach(library uav_landing_core uav_landing_ros uav_landing_nodelets)
  if(TARGET ${library})
    install(TARGETS ${library}
      ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
      LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
      RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION})
  endif()
endforeach()
foreach(program dataset_to_bag process_bag simulate_approach)
  if(TARGET ${program})
    install(TARGETS ${program} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  endif()
endforeach()
install(PROGRAMS src/tools/evaluate DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(DIRECTORY src/tools/evaluation DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION} FILES_MATCHING PATTERN "*.py")
install(DIRECTORY include/uav_landing/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION})
install(FILES nodelet_plugins.xml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
foreach(folder config launch rviz)
  if(EXISTS ${PROJECT_SOURCE_DIR}/${folder})
    install(DIRECTORY ${folder} DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
  endif()
endforeach()
