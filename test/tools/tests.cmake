# The programs.
uav_landing_add_python_test(test/tools/process_bag_input_test.py DEPENDENCIES process_bag dataset_to_bag)
uav_landing_add_python_test(test/tools/process_bag_rig_test.py DEPENDENCIES process_bag simulate_approach)
uav_landing_add_python_test(test/tools/verdict_test.py DEPENDENCIES process_bag simulate_approach)
uav_landing_add_python_test(test/tools/evaluate_test.py)
uav_landing_add_python_test(test/tools/convert_recording_test.py DEPENDENCIES process_bag)
uav_landing_add_python_test(test/tools/rosrun_test.py
  DEPENDENCIES process_bag dataset_to_bag simulate_approach simulate_campaign)
uav_landing_add_python_test(test/tools/dataset_to_bag_test.py DEPENDENCIES dataset_to_bag)
uav_landing_add_python_test(test/tools/simulate_approach_test.py DEPENDENCIES dataset_to_bag simulate_approach)
uav_landing_add_python_test(test/tools/simulate_campaign_test.py DEPENDENCIES simulate_campaign)
uav_landing_add_python_test(test/tools/measure_noise_bound_test.py DEPENDENCIES measure_noise_bound)
uav_landing_add_python_test(test/tools/measure_runways_test.py DEPENDENCIES measure_runways)
uav_landing_add_gtest(bag_structure_test test/tools/bag_structure_test.cpp LIBS uav_landing_tools)
uav_landing_add_gtest(pair_plan_test test/tools/pair_plan_test.cpp LIBS uav_landing_tools)
uav_landing_add_gtest(topic_advice_test test/tools/topic_advice_test.cpp LIBS uav_landing_tools)
uav_landing_add_gtest(dataset_calibrations_test test/tools/dataset_calibrations_test.cpp LIBS uav_landing_tools)
uav_landing_add_gtest(random_approach_test test/tools/random_approach_test.cpp LIBS uav_landing_tools)
uav_landing_add_gtest(chart_test test/tools/chart_test.cpp LIBS uav_landing_tools)
uav_landing_add_gtest(fast_low_pass_test test/tools/fast_low_pass_test.cpp LIBS uav_landing_tools)
uav_landing_add_gtest(fault_score_test test/tools/fault_score_test.cpp
  SOURCES src/tools/faults/fault_score.cpp src/tools/faults/output_score.cpp
  LIBS uav_landing_tools)
uav_landing_add_gtest(campaign_csv_test test/tools/campaign_csv_test.cpp SOURCES src/tools/simulation/campaign_csv.cpp
  LIBS uav_landing_tools)
uav_landing_add_gtest(faults_test test/tools/faults_test.cpp
  SOURCES ${UAV_LANDING_FAULT_SOURCES} LIBS uav_landing_tools)
uav_landing_add_gtest(offline_sinks_test test/tools/offline_sinks_test.cpp
  SOURCES src/tools/offline/estimate_csv.cpp src/tools/offline/pair_count.cpp src/tools/offline/timing_table.cpp
  src/tools/offline/verdict.cpp
  LIBS uav_landing_tools)
uav_landing_add_python_test(test/tools/interrupted_test.py DEPENDENCIES process_bag simulate_approach)
