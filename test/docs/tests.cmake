uav_landing_add_python_test(test/docs/links_test.py)
uav_landing_add_python_test(test/docs/reference_test.py)
