# The launch file on bags of the simulator.
uav_landing_add_rostest(test/launch/launch.test SOURCES test/launch/launch_test.py
  DEPENDENCIES uav_landing_nodelets simulate_approach process_bag)
uav_landing_add_rostest(test/launch/autopilot.test SOURCES test/launch/autopilot_test.py
  DEPENDENCIES uav_landing_nodelets simulate_approach)
uav_landing_add_rostest(test/launch/diagnostics.test SOURCES test/launch/diagnostics_test.py DEPENDENCIES uav_landing_nodelets)
uav_landing_add_rostest(test/launch/shared_parameters.test SOURCES test/launch/shared_parameters_test.py
  DEPENDENCIES uav_landing_nodelets)
uav_landing_add_rostest(test/launch/simulate.test SOURCES test/launch/simulate_test.py
  DEPENDENCIES uav_landing_nodelets simulate_approach)
uav_landing_add_rostest(test/launch/recovery.test SOURCES test/launch/recovery_test.py
  DEPENDENCIES uav_landing_nodelets simulate_approach)
uav_landing_add_rostest(test/launch/split_images.test SOURCES test/launch/split_images_test.py)
uav_landing_add_python_test(test/launch/arguments_test.py)
