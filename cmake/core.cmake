# The core knows no ROS: it is compiled without catkin's include directories and linked without its libraries, with
# --no-undefined, so that a ROS header or symbol in it breaks the build.
file(GLOB core_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/core/*.cpp ${PROJECT_SOURCE_DIR}/src/core/*/*.cpp
  ${PROJECT_SOURCE_DIR}/src/core/*/*/*.cpp)
add_library(uav_landing_core SHARED ${core_sources})
target_include_directories(uav_landing_core PUBLIC ${PROJECT_SOURCE_DIR}/include)
target_include_directories(uav_landing_core PRIVATE ${PROJECT_SOURCE_DIR}/src/core)
target_link_libraries(uav_landing_core
  PUBLIC Eigen3::Eigen opencv_core opencv_imgproc opencv_calib3d opencv_imgcodecs PRIVATE yaml-cpp)
# Nobody puts other functions in place of the library's when it is loaded, so calls within it are direct.
target_compile_options(uav_landing_core PRIVATE -fno-semantic-interposition)
# Nothing asks for errno or for traps of the floating-point unit: the same bits with fewer branches.
target_compile_options(uav_landing_core PRIVATE -fno-math-errno -fno-trapping-math)
if(NOT UAV_LANDING_FUZZ) # clang's sanitizers are in the programs only
  target_link_options(uav_landing_core PRIVATE -Wl,--no-undefined)
endif()
