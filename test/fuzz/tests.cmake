# What the fuzzers found, replayed; cmake/fuzz.cmake builds the fuzzers themselves.
uav_landing_add_gtest(fuzz_regression_test test/fuzz/regression_test.cpp
  SOURCES test/fuzz/calibration.cpp test/fuzz/config.cpp test/fuzz/harnesses.cpp test/fuzz/image_message.cpp
    test/fuzz/image_pair.cpp test/fuzz/imu.cpp test/fuzz/messages.cpp test/fuzz/recordings.cpp test/support/ground_renderer.cpp
  LIBS uav_landing_tools)
uav_landing_test_sources(test/fuzz/fuzz_main.cpp test/fuzz/make_corpus.py)
