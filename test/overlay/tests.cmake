uav_landing_add_gtest(overlay_test test/overlay/overlay_test.cpp)
