#pragma once

#include <uav_landing/ConsistencyTest.h>
#include <uav_landing/ImageLines.h>
#include <uav_landing/ImuPrior.h>
#include <uav_landing/Motion.h>
#include <uav_landing/RunwayPosition.h>
#include <uav_landing/RunwaySight.h>

#include <string>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

// Parts that the results of stages and their messages (conversions.h) share, in both directions.

/// Inverse of Failure::message().
Failure parseFailure(const std::string& reason);
/// Inverse of toString(HeightOrigin).
HeightOrigin parseOrigin(const std::string& name);

ImageLines toMessage(const ApproachAngleResult::View& view);
ApproachAngleResult::View toResult(const ImageLines& message);
ConsistencyTest toMessage(const TestResult& test);
TestResult toResult(const ConsistencyTest& message);
Motion toMessage(const ApproachAngleResult::Motion& motion);
ApproachAngleResult::Motion toResult(const Motion& message);
RunwayPosition toMessage(const ApproachAngleResult::Runway& runway);
ApproachAngleResult::Runway toResult(const RunwayPosition& message);
RunwaySight toMessage(const ApproachAngleResult::Sight& sight);
ApproachAngleResult::Sight toResult(const RunwaySight& message);
ImuPrior toMessage(const AttitudePrior& prior);
AttitudePrior toResult(const ImuPrior& message);

}  // namespace uav_landing
