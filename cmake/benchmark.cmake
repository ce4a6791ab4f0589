# The benchmark and its peers (benchmark/): cmake -DUAV_LANDING_BENCHMARK=OFF leaves it out.
option(UAV_LANDING_BENCHMARK "build the benchmark" ON)
if(UAV_LANDING_BENCHMARK)
  add_executable(benchmark
    benchmark/benchmark.cpp benchmark/heap.cpp benchmark/paper_pipeline.cpp benchmark/peers.cpp
    benchmark/resources.cpp benchmark/sequences.cpp)
  target_compile_definitions(benchmark PRIVATE UAV_LANDING_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_link_libraries(benchmark PRIVATE uav_landing_tools)
  install(TARGETS benchmark RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  if(PROJECT_BINARY_DIR STREQUAL "${PROJECT_SOURCE_DIR}/build")
    file(CREATE_LINK ${CATKIN_DEVEL_PREFIX}/lib/${PROJECT_NAME}/benchmark ${PROJECT_SOURCE_DIR}/bin/benchmark SYMBOLIC)
  endif()
endif()
