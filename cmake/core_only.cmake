# Builds without ROS (-DUAV_LANDING_CORE_ONLY=ON): the core, simulate_campaign, the example and the tests below. They are what
# scripts/test_arm64 compiles for another processor.
find_package(Eigen3 REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(CLI11 REQUIRED)
find_package(GTest REQUIRED)
# OpenCV's own configuration asks for all its modules. The core uses four.
find_path(UAV_LANDING_OPENCV_INCLUDE_DIR opencv2/calib3d.hpp PATH_SUFFIXES opencv4 REQUIRED)

include(cmake/compile_options.cmake)
add_compile_options(-fpch-preprocess)  # ccache asks for it where headers are compiled beforehand
include(cmake/core.cmake)
target_include_directories(uav_landing_core SYSTEM PUBLIC ${UAV_LANDING_OPENCV_INCLUDE_DIR})
# Most of the time to compile goes into these headers.
set(large_headers <Eigen/Dense> <opencv2/imgproc.hpp> <tl/expected.hpp>)
target_precompile_headers(uav_landing_core PRIVATE ${large_headers})

file(STRINGS package.xml version REGEX "<version>")
string(REGEX REPLACE ".*<version>(.*)</version>.*" "\\1" version "${version}")
add_executable(simulate_campaign
  src/tools/simulation/campaign_csv.cpp src/tools/simulation/random_approach.cpp src/tools/simulation/random_far.cpp
  src/tools/simulation/random_flight.cpp src/tools/simulation/random_rows.cpp src/tools/simulation/random_scenery.cpp src/tools/simulation/simulate_campaign.cpp)
target_include_directories(simulate_campaign PRIVATE src/tools src/core)
target_compile_definitions(simulate_campaign PRIVATE UAV_LANDING_VERSION="${version}")
target_link_libraries(simulate_campaign PRIVATE uav_landing_core CLI11::CLI11)

add_executable(height_without_ros EXCLUDE_FROM_ALL examples/height_without_ros.cpp)
target_link_libraries(height_without_ros PRIVATE uav_landing_core)

# All kernels, and a test of every other step from the images to the landing estimate.
set(core_only_tests
  attitude_test block_disparities_test calibration_test camera_twist_test corner_matcher_test corners_test
  direct_refinement_test ego_motion_test estimation_test focus_of_expansion_test ground_plane_test height_filter_test
  line_segments_test plane_fit_test plane_search_test rectification_test runway_edges_test runway_tracker_test
  solution_separation_test vanishing_point_test)

# Compiled once for all tests: the headers that take long, and the renderer.
add_library(core_only_test_objects OBJECT test/support/ground_renderer.cpp)
target_include_directories(core_only_test_objects PRIVATE src src/core test)
target_link_libraries(core_only_test_objects PRIVATE uav_landing_core GTest::gtest)
target_precompile_headers(core_only_test_objects PRIVATE <gtest/gtest.h> ${large_headers})

# The same registration as with ROS (test/core/tests.cmake), for the tests of the list.
function(uav_landing_add_gtest name file)
  if(NOT file MATCHES "^test/core/kernels/" AND NOT name IN_LIST core_only_tests)
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "LIBS;SOURCES" ${ARGN})
  list(TRANSFORM ARG_SOURCES REPLACE ".*ground_renderer.cpp" "$<TARGET_OBJECTS:core_only_test_objects>")
  add_executable(${name} ${file} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE src src/core test)
  target_compile_definitions(${name} PRIVATE UAV_LANDING_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_link_libraries(${name} PRIVATE uav_landing_core ${ARG_LIBS} GTest::gtest_main)
  target_precompile_headers(${name} REUSE_FROM core_only_test_objects)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
endfunction()
include(test/core/tests.cmake)
foreach(name ${core_only_tests})
  if(NOT TARGET ${name})
    message(FATAL_ERROR "cmake/core_only.cmake names the test ${name}, which test/core/tests.cmake does not register")
  endif()
endforeach()
