# What the nodelets and the programs share, without a master.
uav_landing_add_gtest(camera_info_test test/ros/camera_info_test.cpp LIBS uav_landing_ros)
uav_landing_add_gtest(conversions_test test/ros/conversions_test.cpp LIBS uav_landing_ros)
uav_landing_add_gtest(image_input_test test/ros/image_input_test.cpp LIBS uav_landing_ros)
uav_landing_add_gtest(pairing_test test/ros/pairing_test.cpp LIBS uav_landing_ros)
uav_landing_add_gtest(landing_markers_test test/ros/landing_markers_test.cpp LIBS uav_landing_ros yaml-cpp)
foreach(topic aircraft_tilt autopilot_messages body_pose body_twist foreign_messages image_pool imu_input node_parameters pairs_in_flight picture_watch pose_covariance rate_limit reconfigure_server rig_frames runway_path stage_report time_difference)
  uav_landing_add_gtest(${topic}_test test/ros/${topic}_test.cpp LIBS uav_landing_ros)
endforeach()
