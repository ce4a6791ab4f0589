# The simulator: path and truth, rig, pictures, sensor, configuration files; what the chain makes of its gusts and flares.
uav_landing_add_gtest(trajectory_test test/simulator/trajectory_test.cpp)
uav_landing_add_gtest(simulated_imu_test test/simulator/imu_test.cpp)
uav_landing_add_gtest(camera_rig_test test/simulator/camera_rig_test.cpp)
uav_landing_add_gtest(renderer_test test/simulator/renderer_test.cpp)
uav_landing_add_gtest(approach_simulator_test test/simulator/approach_simulator_test.cpp)
uav_landing_add_gtest(simulator_parameters_test test/simulator/simulator_parameters_test.cpp LIBS yaml-cpp)
uav_landing_add_gtest(approach_lag_test test/simulator/approach_lag_test.cpp)
uav_landing_add_gtest(approach_position_test test/simulator/approach_position_test.cpp)
