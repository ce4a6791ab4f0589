#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

// Effects of what is on a lens, before it or wrong with it.
namespace uav_landing {

void blur(cv::Mat& image, double sigma);
/// Water on a lens: a rest of the image, a veil, and the sensor's noise.
void fogLens(cv::Mat& image, cv::RNG& random);
/// Water that condenses on a lens: a veil, and a blur. share: 0 dry to 1 hardly transparent.
void condense(cv::Mat& image, double share);
/// Dark spots at fixed places.
void soil(cv::Mat& image, uint64_t seed);
/// Water drops: blurred and displaced. way: px that they have run down from their fixed places.
void wet(cv::Mat& image, uint64_t seed, double way = 0);
/// Dark spots, much out of focus, of insects that hit the lens one after another.
void hitByInsects(cv::Mat& image, uint64_t seed, int count);
void glare(cv::Mat& image);
/// Two blades of a propeller, blurred by their own movement. hub: in px. angle: of the blades, rad.
void spinPropeller(cv::Mat& image, const cv::Point2d& hub, double angle);
/// A dark arm that turns about a point below the middle of the image. angle: from upright, rad.
void wipe(cv::Mat& image, double angle);

}  // namespace uav_landing
