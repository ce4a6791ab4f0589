# The programs.
uav_landing_add_python_test(test/tools/evaluate_test.py)
