# The benchmark and its peers (benchmark/): cmake -DUAV_LANDING_BENCHMARK=OFF leaves it out.
option(UAV_LANDING_BENCHMARK "build the benchmark" ON)
if(UAV_LANDING_BENCHMARK)
  find_package(stereo_image_proc REQUIRED)  # what the chain is compared with
  add_executable(benchmark
    benchmark/benchmark.cpp benchmark/heap.cpp benchmark/opencv_rectifier.cpp benchmark/paper_pipeline.cpp benchmark/peers.cpp
    benchmark/resources.cpp benchmark/searching.cpp benchmark/sequences.cpp)
  add_executable(nodelet_benchmark
    benchmark/copied_bytes.cpp benchmark/heap.cpp benchmark/nodelet_benchmark.cpp benchmark/nodelet_chain.cpp
    benchmark/sequences.cpp)
  target_include_directories(benchmark SYSTEM PRIVATE ${stereo_image_proc_INCLUDE_DIRS})
  target_link_libraries(benchmark PRIVATE ${stereo_image_proc_LIBRARIES})
  # The compiler must not take the copies for the C library's own while it builds their replacement.
  set_source_files_properties(benchmark/copied_bytes.cpp PROPERTIES COMPILE_OPTIONS -fno-builtin)
  foreach(program benchmark nodelet_benchmark)
    target_compile_definitions(${program} PRIVATE UAV_LANDING_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    target_link_libraries(${program} PRIVATE uav_landing_tools)
    install(TARGETS ${program} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
    if(PROJECT_BINARY_DIR STREQUAL "${PROJECT_SOURCE_DIR}/build")
      file(CREATE_LINK ${CATKIN_DEVEL_PREFIX}/lib/${PROJECT_NAME}/${program} ${PROJECT_SOURCE_DIR}/bin/${program} SYMBOLIC)
    endif()
  endforeach()
endif()
