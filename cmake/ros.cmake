# What the nodelets and the programs share (src/ros), and the nodelets.
file(GLOB ros_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/ros/*.cpp)
add_library(uav_landing_ros SHARED ${ros_sources})
# src/core: order of stamps, range of greys and others that no program outside needs.
target_include_directories(uav_landing_ros PUBLIC ${PROJECT_SOURCE_DIR}/src/ros ${PROJECT_SOURCE_DIR}/src/core)
target_include_directories(uav_landing_ros SYSTEM PUBLIC ${catkin_INCLUDE_DIRS})
target_link_libraries(uav_landing_ros PUBLIC uav_landing_core ${catkin_LIBRARIES} PRIVATE yaml-cpp)
add_dependencies(uav_landing_ros ${PROJECT_NAME}_generate_messages_cpp)

file(GLOB nodelet_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/nodelets/*.cpp)
add_library(uav_landing_nodelets SHARED ${nodelet_sources})
target_link_libraries(uav_landing_nodelets PRIVATE uav_landing_ros)
if(NOT UAV_LANDING_FUZZ) # clang's sanitizers are in the programs only
  # What is missing shows in the build, and not when a manager loads the library.
  target_link_options(uav_landing_nodelets PRIVATE -Wl,--no-undefined)
endif()
