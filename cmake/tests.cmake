# Tests. Each folder test/<area>/ registers its own in test/<area>/tests.cmake with the helpers below; every test source
# must be registered, else the configuration fails. All of them leave XML results in catkin's test_results and run by
# `ctest`, `make run_tests` and scripts/test alike. File names are relative to the project root.
find_package(rostest REQUIRED)
find_package(roslaunch REQUIRED)
file(MAKE_DIRECTORY ${CATKIN_TEST_RESULTS_DIR}/${PROJECT_NAME})

# uav_landing_add_gtest(<name> <file.cpp> [LIBS <library>...] [SOURCES <more.cpp>...])
# A gtest program without a ROS master, linked with the core and gtest's main.
function(uav_landing_add_gtest name file)
  cmake_parse_arguments(ARG "" "" "LIBS;SOURCES" ${ARGN})
  catkin_add_gtest(${name} ${file} ${ARG_SOURCES} WORKING_DIRECTORY ${PROJECT_BINARY_DIR})
  uav_landing_setup_test_program(${name} ${ARG_LIBS})
  uav_landing_test_sources(${file} ${ARG_SOURCES})
  set_tests_properties(_ctest_${PROJECT_NAME}_gtest_${name} PROPERTIES TIMEOUT 300)
endfunction()

# uav_landing_add_rostest_gtest(<name> <file.test> <file.cpp> [LIBS <library>...] [DEPENDENCIES <target>...])
# A gtest program that a .test file starts with a master of its own, as <test pkg="uav_landing" type="<name>" .../>.
function(uav_landing_add_rostest_gtest name launch_file file)
  cmake_parse_arguments(ARG "" "" "LIBS;DEPENDENCIES" ${ARGN})
  add_rostest_gtest(${name} ${launch_file} ${file})
  uav_landing_setup_test_program(${name} ${ARG_LIBS})
  if(ARG_DEPENDENCIES)
    add_dependencies(${name} ${ARG_DEPENDENCIES})
  endif()
  uav_landing_test_sources(${launch_file} ${file})
  uav_landing_lock(rostest ${launch_file} nodelets)
endfunction()

# uav_landing_add_rostest(<file.test> [SOURCES <node.py>...] [DEPENDENCIES <target>...])
# A .test file whose nodes are python programs (SOURCES) or built elsewhere.
function(uav_landing_add_rostest launch_file)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDENCIES" ${ARGN})
  add_rostest(${launch_file} DEPENDENCIES ${ARG_DEPENDENCIES})
  uav_landing_test_sources(${launch_file} ${ARG_SOURCES})
  uav_landing_lock(rostest ${launch_file} nodelets)
endfunction()

# uav_landing_add_python_test(<file.py> [LOCK <name>] [DEPENDENCIES <target>...])
# unittest.TestCase classes in a python file. They may import from test/support, and find the build and its programs
# by project.py there. LOCK: tests with the same name here run one at a time. The rostests have `nodelets`.
function(uav_landing_add_python_test file)
  cmake_parse_arguments(ARG "" "LOCK" "DEPENDENCIES" ${ARGN})
  if(NOT NOSETESTS)
    message(FATAL_ERROR "nosetests is missing (package python3-nose)")
  endif()
  string(REPLACE "/" "_" name ${file})
  set(result nosetests-${name}.xml)
  set(environment "PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=\"${PROJECT_SOURCE_DIR}/test/support:$PYTHONPATH\" \
UAV_LANDING_BUILD_DIR=\"${PROJECT_BINARY_DIR}\" UAV_LANDING_DEVEL_DIR=\"${CATKIN_DEVEL_PREFIX}\"")
  set(nose "${PYTHON_EXECUTABLE} ${NOSETESTS} -P --process-timeout=600 --exe ${PROJECT_SOURCE_DIR}/${file} \
--with-xunit --xunit-testsuite-name=${name} --xunit-file=${CATKIN_TEST_RESULTS_DIR}/${PROJECT_NAME}/${result}")
  catkin_run_tests_target("nosetests" ${name} ${result} COMMAND "${environment} ${nose}"
    DEPENDENCIES ${ARG_DEPENDENCIES} WORKING_DIRECTORY ${PROJECT_BINARY_DIR})
  uav_landing_test_sources(${file})
  set_tests_properties(_ctest_${PROJECT_NAME}_nosetests_${name} PROPERTIES TIMEOUT 600)
  if(ARG_LOCK)
    uav_landing_lock(nosetests ${file} ${ARG_LOCK})
  endif()
endfunction()

# Includes and libraries that every C++ test has.
function(uav_landing_setup_test_program name)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/src/core
    ${PROJECT_SOURCE_DIR}/test)
  target_include_directories(${name} SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
  target_compile_definitions(${name} PRIVATE UAV_LANDING_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_link_libraries(${name} uav_landing_core ${ARGN} ${gtest_main})
endfunction()

# What starts nodelets runs one at a time, beside other tests: these tests wait most of the time, and a processor would
# be idle. COST: tests with a lock begin first. In a row they take longest.
function(uav_landing_lock type file lock)
  string(REPLACE "/" "_" name ${file})
  set_tests_properties(_ctest_${PROJECT_NAME}_${type}_${name} PROPERTIES RESOURCE_LOCK ${lock} COST 100)
endfunction()

# Notes test sources as registered; also for files that a .test file starts by itself.
function(uav_landing_test_sources)
  set_property(GLOBAL APPEND PROPERTY uav_landing_test_sources ${ARGN})
endfunction()

# catkin gives gtest's main one name or the other; CMake before 3.18 cannot make an alias of an imported library.
set(gtest_main gtest_main)
if(TARGET GTest::gtest_main)
  set(gtest_main GTest::gtest_main)
endif()

file(GLOB test_areas CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/test/*/tests.cmake)
foreach(area ${test_areas})
  include(${area})
endforeach()

# The longest tests begin first, so that no processor waits for one of them at the end.
foreach(test nosetests_test_scripts_fault_campaign_test.py gtest_scenery_yaw_test
    nosetests_test_tools_simulate_campaign_test.py nosetests_test_tools_simulate_approach_test.py)
  set_tests_properties(_ctest_${PROJECT_NAME}_${test} PROPERTIES COST 50)
endforeach()

file(GLOB launch_files CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} launch/*.launch)
foreach(launch_file ${launch_files})
  roslaunch_add_file_check(${launch_file})
endforeach()

file(GLOB_RECURSE test_sources CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} test/*.cpp test/*.py test/*.test)
list(FILTER test_sources EXCLUDE REGEX "^test/support/")
get_property(registered_sources GLOBAL PROPERTY uav_landing_test_sources)
if(registered_sources)
  list(REMOVE_ITEM test_sources ${registered_sources})
endif()
if(test_sources)
  message(FATAL_ERROR "These test sources run in no test, add them to the tests.cmake of their folder: ${test_sources}")
endif()
