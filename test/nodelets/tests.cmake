# Nodelets in the test's own process, with real topics.
foreach(nodelet rectify stereo_depth approach_angle kalman_height overlay autopilot chain abuse bad_configurations rig_check)
  uav_landing_add_rostest_gtest(${nodelet}_nodelet_test
    test/nodelets/${nodelet}_nodelet.test test/nodelets/${nodelet}_nodelet_test.cpp
    LIBS ${catkin_LIBRARIES} yaml-cpp DEPENDENCIES uav_landing_nodelets)
endforeach()
uav_landing_add_rostest_gtest(links_nodelet_test
  test/nodelets/links_nodelet.test test/nodelets/links_nodelet_test.cpp
  LIBS uav_landing_nodelets uav_landing_ros ${catkin_LIBRARIES})
