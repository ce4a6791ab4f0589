# The project itself: style, manifest, layering, install space.
uav_landing_add_python_test(test/checks/clang_format_test.py)
uav_landing_add_python_test(test/checks/catkin_lint_test.py)
uav_landing_add_python_test(test/checks/core_without_ros_test.py)
uav_landing_add_python_test(test/checks/core_folders_test.py)
uav_landing_add_python_test(test/checks/install_test.py SERIAL)
uav_landing_add_python_test(test/checks/foreign_python_test.py)
uav_landing_add_python_test(test/checks/summarize_results_test.py)
