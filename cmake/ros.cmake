# What the nodelets and the programs share (src/ros), and the nodelets.
add_library(uav_landing_ros SHARED
  src/ros/camera_info.cpp src/ros/conversions.cpp src/ros/image_input.cpp src/ros/input_watch.cpp
  src/ros/node_parameters.cpp)
target_include_directories(uav_landing_ros PUBLIC ${PROJECT_SOURCE_DIR}/src/ros)
target_include_directories(uav_landing_ros SYSTEM PUBLIC ${catkin_INCLUDE_DIRS})
target_link_libraries(uav_landing_ros PUBLIC uav_landing_core ${catkin_LIBRARIES} PRIVATE yaml-cpp)
add_dependencies(uav_landing_ros ${PROJECT_NAME}_generate_messages_cpp)
