if(UAV_LANDING_BENCHMARK)
  uav_landing_add_python_test(test/benchmark/benchmark_test.py DEPENDENCIES benchmark)
  uav_landing_add_rostest(test/benchmark/nodelet_benchmark.test SOURCES test/benchmark/nodelet_benchmark_test.py
    DEPENDENCIES nodelet_benchmark uav_landing_nodelets)
else()
  uav_landing_test_sources(test/benchmark/benchmark_test.py test/benchmark/nodelet_benchmark.test
    test/benchmark/nodelet_benchmark_test.py)
endif()
