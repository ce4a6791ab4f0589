# What the programs share, and the programs (src/tools).
add_library(uav_landing_tools STATIC
  src/tools/bags/bag_bytes.cpp src/tools/bags/bag_chunk.cpp src/tools/bags/bag_records.cpp
  src/tools/bags/bag_structure.cpp src/tools/bags/pair_plan.cpp
  src/tools/bags/stamp_epochs.cpp src/tools/bags/stereo_bag_reader.cpp src/tools/bags/stereo_bag_writer.cpp
  src/tools/bags/topic_advice.cpp src/tools/datasets/csv_table.cpp src/tools/datasets/dataset.cpp
  src/tools/datasets/dataset_writer.cpp src/tools/datasets/decimal_time.cpp src/tools/simulation/random_approach.cpp
  src/tools/simulation/random_far.cpp src/tools/simulation/random_flight.cpp src/tools/simulation/random_rows.cpp src/tools/simulation/random_scenery.cpp)
target_include_directories(uav_landing_tools PUBLIC ${PROJECT_SOURCE_DIR}/src/tools)
target_compile_definitions(uav_landing_tools PUBLIC UAV_LANDING_VERSION="${${PROJECT_NAME}_VERSION}")
target_include_directories(uav_landing_tools SYSTEM PUBLIC ${catkin_INCLUDE_DIRS})
target_link_libraries(uav_landing_tools PUBLIC uav_landing_ros ${catkin_LIBRARIES} CLI11::CLI11 PRIVATE BZip2::BZip2 yaml-cpp)
add_dependencies(uav_landing_tools ${PROJECT_NAME}_generate_messages_cpp)

add_executable(dataset_to_bag src/tools/datasets/dataset_to_bag.cpp)
target_link_libraries(dataset_to_bag PRIVATE uav_landing_tools)

add_executable(simulate_approach src/tools/simulation/live_cameras.cpp src/tools/simulation/simulate_approach.cpp)
target_link_libraries(simulate_approach PRIVATE uav_landing_tools)

add_executable(measure_noise_bound src/tools/simulation/measure_noise_bound.cpp)
target_link_libraries(measure_noise_bound PRIVATE uav_landing_tools)

add_executable(measure_runways src/tools/offline/measure_runways.cpp)
target_link_libraries(measure_runways PRIVATE uav_landing_tools)

add_executable(process_bag
  src/tools/offline/process_bag.cpp src/tools/offline/estimate_bag.cpp src/tools/offline/estimate_csv.cpp
  src/tools/offline/offline_chain.cpp src/tools/offline/pair_count.cpp src/tools/offline/report_data.cpp
  src/tools/offline/timing_table.cpp src/tools/offline/verdict.cpp)
target_link_libraries(process_bag PRIVATE uav_landing_tools)

add_executable(simulate_campaign src/tools/simulation/campaign_csv.cpp src/tools/simulation/simulate_campaign.cpp)
target_link_libraries(simulate_campaign PRIVATE uav_landing_tools)

set(UAV_LANDING_FAULT_SOURCES
  src/tools/faults/fault_flight.cpp src/tools/faults/fault_makers.cpp src/tools/faults/fault_score.cpp
  src/tools/faults/faults.cpp src/tools/faults/flight.cpp src/tools/faults/ground_faults.cpp
  src/tools/faults/lens_effects.cpp src/tools/faults/lens_faults.cpp src/tools/faults/light_faults.cpp
  src/tools/faults/output_score.cpp src/tools/faults/rig_faults.cpp src/tools/faults/row_faults.cpp
  src/tools/faults/sensor_effects.cpp src/tools/faults/sensor_faults.cpp src/tools/faults/timing_faults.cpp
  src/tools/faults/view_effects.cpp)
add_executable(inject_faults src/tools/faults/fault_choice.cpp src/tools/faults/inject_faults.cpp
  ${UAV_LANDING_FAULT_SOURCES})
target_link_libraries(inject_faults PRIVATE uav_landing_tools)

# rosrun looks everywhere in the source folder but in its folder build/, which is where a plain cmake build puts the
# programs: links in bin/ lead it there. In a catkin workspace there is nothing to do.
if(PROJECT_BINARY_DIR STREQUAL "${PROJECT_SOURCE_DIR}/build")
  file(MAKE_DIRECTORY ${PROJECT_SOURCE_DIR}/bin)
  foreach(program dataset_to_bag inject_faults measure_noise_bound measure_runways process_bag simulate_approach simulate_campaign)
    file(CREATE_LINK ${CATKIN_DEVEL_PREFIX}/lib/${PROJECT_NAME}/${program} ${PROJECT_SOURCE_DIR}/bin/${program} SYMBOLIC)
  endforeach()
endif()
