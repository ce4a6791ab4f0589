#pragma once

#include <gtest/gtest.h>
#include <ros/ros.h>

/// Main program of a nodelet test.
#define UAV_LANDING_NODELET_TEST_MAIN(name) \
  int main(int argc, char** argv) {         \
    testing::InitGoogleTest(&argc, argv);   \
    ros::init(argc, argv, name);            \
    const ros::NodeHandle keep_alive;       \
    return RUN_ALL_TESTS();                 \
  }
