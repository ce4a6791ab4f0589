# The programs.
uav_landing_add_python_test(test/tools/process_bag_input_test.py DEPENDENCIES process_bag dataset_to_bag)
uav_landing_add_python_test(test/tools/evaluate_test.py)
uav_landing_add_python_test(test/tools/rosrun_test.py DEPENDENCIES process_bag dataset_to_bag simulate_approach)
