uav_landing_add_python_test(test/docs/links_test.py)
uav_landing_add_python_test(test/docs/troubleshooting_test.py)
uav_landing_add_python_test(test/docs/reasons_test.py)
uav_landing_add_python_test(test/docs/version_test.py)
uav_landing_add_python_test(test/docs/named_parameters_test.py)
# Both make the site.
uav_landing_add_python_test(test/docs/reference_test.py LOCK site)
uav_landing_add_python_test(test/docs/site_test.py LOCK site)
uav_landing_add_python_test(test/docs/plotjuggler_test.py DEPENDENCIES ${PROJECT_NAME}_generate_messages_py)
uav_landing_add_python_test(test/docs/help_test.py DEPENDENCIES ${PROJECT_NAME}_generate_messages_py
  process_bag simulate_approach)
