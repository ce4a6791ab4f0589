# Test programs of the core, by the folders of src/core.

# base
uav_landing_add_gtest(text_test test/core/base/text_test.cpp)
uav_landing_add_gtest(steadiness_test test/core/base/steadiness_test.cpp)

# kernels
uav_landing_add_gtest(order_statistic_test test/core/kernels/lanes/order_statistic_test.cpp)
uav_landing_add_gtest(bilinear_rows_test test/core/kernels/image/bilinear_rows_test.cpp)
uav_landing_add_gtest(harris_rows_test test/core/kernels/image/harris_rows_test.cpp)
uav_landing_add_gtest(line_shades_test test/core/kernels/image/line_shades_test.cpp)
uav_landing_add_gtest(line_view_test test/core/kernels/image/line_view_test.cpp)
uav_landing_add_gtest(slanted_row_test test/core/kernels/image/slanted_row_test.cpp)
uav_landing_add_gtest(smoothing_test test/core/kernels/image/smoothing_test.cpp)
uav_landing_add_gtest(transpose_test test/core/kernels/image/transpose_test.cpp)
uav_landing_add_gtest(parabolic_window_test test/core/kernels/window/parabolic_window_test.cpp)
uav_landing_add_gtest(shifts_test test/core/kernels/window/shifts_test.cpp)
uav_landing_add_gtest(strip_test test/core/kernels/window/strip_test.cpp)
uav_landing_add_gtest(window_copy_test test/core/kernels/window/window_copy_test.cpp)
uav_landing_add_gtest(window_planes_test test/core/kernels/window/window_planes_test.cpp)
uav_landing_add_gtest(block_sums_test test/core/kernels/block/block_sums_test.cpp)
uav_landing_add_gtest(block_texture_test test/core/kernels/block/block_texture_test.cpp)
uav_landing_add_gtest(pair_sums_test test/core/kernels/block/pair_sums_test.cpp)
uav_landing_add_gtest(apart_test test/core/kernels/samples/apart_test.cpp)
uav_landing_add_gtest(line_passes_test test/core/kernels/samples/line_passes_test.cpp)
uav_landing_add_gtest(line_sums_test test/core/kernels/samples/line_sums_test.cpp)
uav_landing_add_gtest(plane_sums_test test/core/kernels/samples/plane_sums_test.cpp)
uav_landing_add_gtest(plane_votes_test test/core/kernels/samples/plane_votes_test.cpp)
uav_landing_add_gtest(seen_rays_test test/core/kernels/samples/seen_rays_test.cpp)
uav_landing_add_gtest(shares_test test/core/kernels/samples/shares_test.cpp)
uav_landing_add_gtest(surface_places_test test/core/kernels/samples/surface_places_test.cpp)
uav_landing_add_gtest(edge_growth_test test/core/kernels/edges/edge_growth_test.cpp)
uav_landing_add_gtest(edge_peaks_test test/core/kernels/edges/edge_peaks_test.cpp)
uav_landing_add_gtest(edge_starts_test test/core/kernels/edges/edge_starts_test.cpp)
uav_landing_add_gtest(falls_test test/core/kernels/edges/falls_test.cpp)

# estimation
uav_landing_add_gtest(convergence_test test/core/estimation/convergence_test.cpp)
uav_landing_add_gtest(estimation_test test/core/estimation/estimation_test.cpp)
uav_landing_add_gtest(innovation_scatter_test test/core/estimation/innovation_scatter_test.cpp)

# parameters
uav_landing_add_gtest(parameter_file_test test/core/parameters/parameter_file_test.cpp)

# geometry
uav_landing_add_gtest(bad_calibrations_test test/core/geometry/bad_calibrations_test.cpp LIBS yaml-cpp)
uav_landing_add_gtest(calibration_test test/core/geometry/calibration_test.cpp)
uav_landing_add_gtest(camera_pair_test test/core/geometry/camera_pair_test.cpp)
uav_landing_add_gtest(ground_normal_test test/core/geometry/ground_normal_test.cpp)
uav_landing_add_gtest(ground_plane_test test/core/geometry/ground_plane_test.cpp)
uav_landing_add_gtest(plane_vector_test test/core/geometry/plane_vector_test.cpp)
uav_landing_add_gtest(half_plane_test test/core/geometry/half_plane_test.cpp)
uav_landing_add_gtest(rig_check_test test/core/geometry/rig_check_test.cpp)
uav_landing_add_gtest(row_times_test test/core/geometry/row_times_test.cpp SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(stamp_map_test test/core/geometry/stamp_map_test.cpp SOURCES test/support/ground_renderer.cpp)

# results
uav_landing_add_gtest(result_check_test test/core/results/result_check_test.cpp)

# image
uav_landing_add_gtest(clipping_test test/core/image/clipping_test.cpp)
uav_landing_add_gtest(corners_test test/core/image/corners_test.cpp)
uav_landing_add_gtest(row_alternation_test test/core/image/row_alternation_test.cpp)
uav_landing_add_gtest(grey_range_test test/core/image/grey_range_test.cpp)
uav_landing_add_gtest(image_cells_test test/core/image/image_cells_test.cpp)
uav_landing_add_gtest(window_overlap_test test/core/image/window_overlap_test.cpp)
uav_landing_add_gtest(image_check_test test/core/image/image_check_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(learned_frame_test test/core/image/learned_frame_test.cpp)
uav_landing_add_gtest(mask_bounds_test test/core/image/mask_bounds_test.cpp)
uav_landing_add_gtest(patch_matching_test test/core/image/patch_matching_test.cpp)
uav_landing_add_gtest(patch_refinement_test test/core/image/patch_refinement_test.cpp)
uav_landing_add_gtest(rectification_test test/core/image/rectification_test.cpp)
uav_landing_add_gtest(resampler_test test/core/image/resampler_test.cpp)
uav_landing_add_gtest(rig_masks_test test/core/image/rig_masks_test.cpp LIBS yaml-cpp)

# lines
uav_landing_add_gtest(heading_gate_test test/core/lines/heading_gate_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(line_fit_test test/core/lines/line_fit_test.cpp)
uav_landing_add_gtest(line_segments_test test/core/lines/line_segments_test.cpp)
uav_landing_add_gtest(segment_scanner_test test/core/lines/segment_scanner_test.cpp)
uav_landing_add_gtest(stripe_line_test test/core/lines/stripe_line_test.cpp)
uav_landing_add_gtest(vanishing_point_test test/core/lines/vanishing_point_test.cpp)

# rig
uav_landing_add_gtest(pair_skew_test test/core/rig/pair_skew_test.cpp)
uav_landing_add_gtest(plane_by_turns_test test/core/rig/plane_by_turns_test.cpp SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(plane_rate_test test/core/rig/plane_rate_test.cpp SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(rig_change_test test/core/rig/rig_change_test.cpp)
uav_landing_add_gtest(rig_rotation_filter_test test/core/rig/rig_rotation_filter_test.cpp SOURCES test/support/ground_renderer.cpp)

# height
uav_landing_add_gtest(attitude_test test/core/height/attitude_test.cpp)
uav_landing_add_gtest(attitude_filter_test test/core/height/attitude_filter_test.cpp)
uav_landing_add_gtest(camera_twist_test test/core/height/camera_twist_test.cpp)
uav_landing_add_gtest(height_filter_test test/core/height/height_filter_test.cpp)
uav_landing_add_gtest(reconstruction_test test/core/height/reconstruction_test.cpp)
uav_landing_add_gtest(runway_height_test test/core/height/runway_height_test.cpp)
uav_landing_add_gtest(vertical_speed_test test/core/height/vertical_speed_test.cpp)
uav_landing_add_gtest(width_height_test test/core/height/width_height_test.cpp)

# stereo
uav_landing_add_gtest(corner_matcher_test test/core/stereo/matching/corner_matcher_test.cpp LIBS opencv_video
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(plane_drift_test test/core/stereo/matching/plane_drift_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(aligned_rows_test test/core/stereo/photometric/aligned_rows_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(band_disparities_test test/core/stereo/photometric/band_disparities_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(band_evidence_test test/core/stereo/bands/band_evidence_test.cpp)
uav_landing_add_gtest(texture_bands_test test/core/stereo/bands/texture_bands_test.cpp)
uav_landing_add_gtest(block_disparity_test test/core/stereo/photometric/block_disparity_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(block_disparities_test test/core/stereo/photometric/block_disparities_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(pair_disparities_test test/core/stereo/photometric/pair_disparities_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(direct_refinement_test test/core/stereo/photometric/direct_refinement_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(refined_rows_test test/core/stereo/photometric/refined_rows_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(corner_plane_test test/core/stereo/plane/corner_plane_test.cpp)
uav_landing_add_gtest(plane_tracker_test test/core/stereo/plane/plane_tracker_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(plane_fit_test test/core/stereo/plane/plane_fit_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(plane_following_test test/core/stereo/plane/plane_following_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(plane_search_test test/core/stereo/plane/plane_search_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(slope_band_test test/core/stereo/plane/slope_band_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(region_planes_test test/core/stereo/plane/region_planes_test.cpp)
uav_landing_add_gtest(row_fit_test test/core/stereo/rows/row_fit_test.cpp)
uav_landing_add_gtest(row_matching_test test/core/stereo/matching/row_matching_test.cpp)
uav_landing_add_gtest(sample_stddevs_test test/core/stereo/photometric/sample_stddevs_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(shift_evidence_test test/core/stereo/photometric/shift_evidence_test.cpp)
uav_landing_add_gtest(shift_matching_test test/core/stereo/photometric/shift_matching_test.cpp)
uav_landing_add_gtest(surface_profile_test test/core/stereo/surface/surface_profile_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(surface_variance_test test/core/stereo/surface/surface_variance_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(vertical_disparity_test test/core/stereo/rows/vertical_disparity_test.cpp SOURCES test/support/ground_renderer.cpp)

# motion
uav_landing_add_gtest(approach_angle_test test/core/motion/approach_angle_test.cpp)
uav_landing_add_gtest(turn_history_test test/core/motion/turn_history_test.cpp)
uav_landing_add_gtest(row_rates_test test/core/motion/row_rates_test.cpp SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(row_sums_test test/core/motion/row_sums_test.cpp SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(row_shake_test test/core/motion/row_shake_test.cpp SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(readout_filter_test test/core/motion/readout_filter_test.cpp)
uav_landing_add_gtest(readout_shift_test test/core/motion/readout_shift_test.cpp SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(ego_motion_test test/core/motion/ego_motion_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(focus_of_expansion_test test/core/motion/focus_of_expansion_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(imu_buffer_test test/core/motion/imu_buffer_test.cpp SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(motion_rows_test test/core/motion/motion_rows_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(first_step_search_test test/core/motion/first_step_search_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(motion_tracker_test test/core/motion/motion_tracker_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(own_normal_test test/core/motion/own_normal_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(path_angle_filter_test test/core/motion/path_angle_filter_test.cpp)
uav_landing_add_gtest(image_errors_test test/core/motion/image_errors_test.cpp)
uav_landing_add_gtest(plane_proof_test test/core/motion/plane_proof_test.cpp)
uav_landing_add_gtest(common_gain_test test/core/motion/common_gain_test.cpp)
uav_landing_add_gtest(temporal_matching_test test/core/motion/temporal_matching_test.cpp
  SOURCES test/support/ground_renderer.cpp)

# far
uav_landing_add_gtest(outline_pose_test test/core/far/outline_pose_test.cpp)
uav_landing_add_gtest(outline_fit_test test/core/far/outline_fit_test.cpp)
uav_landing_add_gtest(edge_readings_test test/core/far/edge_readings_test.cpp)
uav_landing_add_gtest(outline_search_test test/core/far/outline_search_test.cpp)
uav_landing_add_gtest(sighted_ground_test test/core/far/sighted_ground_test.cpp)
uav_landing_add_gtest(stereo_scale_test test/core/far/stereo_scale_test.cpp)
uav_landing_add_gtest(surface_disparity_test test/core/far/surface_disparity_test.cpp)
uav_landing_add_gtest(sight_search_test test/core/far/sight_search_test.cpp)
uav_landing_add_gtest(sighting_test test/core/far/sighting_test.cpp)

# runway
uav_landing_add_gtest(runway_hypothesis_test test/core/runway/runway_hypothesis_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(ground_direction_test test/core/runway/ground_direction_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(ground_edges_test test/core/runway/ground_edges_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(position_filter_test test/core/runway/position_filter_test.cpp)
uav_landing_add_gtest(position_separation_test test/core/runway/position_separation_test.cpp)
uav_landing_add_gtest(centre_solutions_test test/core/runway/centre_solutions_test.cpp)
uav_landing_add_gtest(runway_direction_test test/core/runway/runway_direction_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(right_view_test test/core/runway/right_view_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(centre_columns_test test/core/runway/centre_columns_test.cpp)
uav_landing_add_gtest(runway_edges_test test/core/runway/runway_edges_test.cpp)
uav_landing_add_gtest(runway_threshold_test test/core/runway/runway_threshold_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(runway_tracker_test test/core/runway/runway_tracker_test.cpp
  SOURCES test/support/ground_renderer.cpp)

# integrity
uav_landing_add_gtest(clock_watch_test test/core/integrity/tests/clock_watch_test.cpp)
uav_landing_add_gtest(ground_memory_test test/core/integrity/memory/ground_memory_test.cpp)
uav_landing_add_gtest(height_memory_test test/core/integrity/memory/height_memory_test.cpp)
uav_landing_add_gtest(normal_doubt_test test/core/integrity/tests/normal_doubt_test.cpp)
uav_landing_add_gtest(pair_tests_test test/core/integrity/tests/pair_tests_test.cpp)
uav_landing_add_gtest(recovery_test test/core/integrity/tests/recovery_test.cpp)
uav_landing_add_gtest(solution_separation_test test/core/integrity/tests/solution_separation_test.cpp)
uav_landing_add_gtest(speed_memory_test test/core/integrity/memory/speed_memory_test.cpp)
uav_landing_add_gtest(stamp_order_test test/core/integrity/tests/stamp_order_test.cpp)
uav_landing_add_gtest(stamp_scatter_test test/core/integrity/tests/stamp_scatter_test.cpp)
uav_landing_add_gtest(vanishing_memory_test test/core/integrity/memory/vanishing_memory_test.cpp)
uav_landing_add_gtest(runway_identity_test test/core/integrity/tests/runway_identity_test.cpp)
uav_landing_add_gtest(velocity_memory_test test/core/integrity/memory/velocity_memory_test.cpp)

# landing
uav_landing_add_gtest(runway_track_test test/core/landing/runway_track_test.cpp)
uav_landing_add_gtest(runway_report_test test/core/landing/runway_report_test.cpp)
uav_landing_add_gtest(ground_estimate_test test/core/landing/ground_estimate_test.cpp)
uav_landing_add_gtest(yaw_failure_test test/core/landing/yaw_failure_test.cpp)
uav_landing_add_gtest(height_by_ground_test test/core/landing/height_by_ground_test.cpp)
uav_landing_add_gtest(height_measurement_test test/core/landing/height_measurement_test.cpp)
uav_landing_add_gtest(height_track_test test/core/landing/height_track_test.cpp)
uav_landing_add_gtest(landing_clock_test test/core/landing/landing_clock_test.cpp)
uav_landing_add_gtest(landing_report_test test/core/landing/landing_report_test.cpp)
uav_landing_add_gtest(pair_monitor_test test/core/landing/pair_monitor_test.cpp)
uav_landing_add_gtest(path_doubt_test test/core/landing/path_doubt_test.cpp)
uav_landing_add_gtest(recovery_wait_test test/core/landing/recovery_wait_test.cpp)
uav_landing_add_gtest(sink_rate_watch_test test/core/landing/sink_rate_watch_test.cpp)
uav_landing_add_gtest(surface_ahead_test test/core/landing/surface_ahead_test.cpp)
uav_landing_add_gtest(surface_below_test test/core/landing/surface_below_test.cpp)
uav_landing_add_gtest(velocity_watch_test test/core/landing/velocity_watch_test.cpp)

# stages
uav_landing_add_gtest(approach_angle_normal_test test/core/stages/approach_angle_normal_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(approach_angle_stage_test test/core/stages/approach_angle_stage_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(kalman_height_angle_test test/core/stages/kalman_height_angle_test.cpp)
uav_landing_add_gtest(kalman_height_attitude_test test/core/stages/kalman_height_attitude_test.cpp)
uav_landing_add_gtest(kalman_height_clock_test test/core/stages/kalman_height_clock_test.cpp)
uav_landing_add_gtest(kalman_height_motion_normal_test
  test/core/stages/kalman_height_motion_normal_test.cpp)
uav_landing_add_gtest(kalman_height_ground_test test/core/stages/kalman_height_ground_test.cpp)
uav_landing_add_gtest(kalman_height_integrity_test test/core/stages/kalman_height_integrity_test.cpp)
uav_landing_add_gtest(kalman_height_reconstruction_test
  test/core/stages/kalman_height_reconstruction_test.cpp)
uav_landing_add_gtest(kalman_height_reset_test test/core/stages/kalman_height_reset_test.cpp)
uav_landing_add_gtest(kalman_height_stage_test test/core/stages/kalman_height_stage_test.cpp)
uav_landing_add_gtest(stereo_depth_search_test test/core/stages/stereo_depth_search_test.cpp
  SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(stereo_depth_stage_test test/core/stages/stereo_depth_stage_test.cpp
  SOURCES test/support/ground_renderer.cpp)

# the whole chain
uav_landing_add_gtest(pipeline_test test/core/pipeline_test.cpp SOURCES test/support/ground_renderer.cpp)
uav_landing_add_gtest(rolling_shutter_test test/core/rolling_shutter_test.cpp SOURCES test/support/ground_renderer.cpp)
