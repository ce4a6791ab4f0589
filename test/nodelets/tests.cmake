# Nodelets in the test's own process, with real topics.
foreach(nodelet rectify stereo_depth approach_angle kalman_height overlay autopilot chain abuse bad_configurations)
  uav_landing_add_rostest_gtest(${nodelet}_nodelet_test
    test/nodelets/${nodelet}_nodelet.test test/nodelets/${nodelet}_nodelet_test.cpp
    LIBS ${catkin_LIBRARIES} yaml-cpp DEPENDENCIES uav_landing_nodelets)
endforeach()
