#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

// Effects of a sensor, and of the way of its images to the chain.
namespace uav_landing {

void changeExposure(cv::Mat& image, double gain, double offset);
void smear(cv::Mat& image, int pixels);
void addNoise(cv::Mat& image, double sigma, cv::RNG& random);
/// Little light, with the noise that this leaves.
void night(cv::Mat& image, uint64_t seed);
void band(cv::Mat& image, double phase);
/// Rows that are black or white all the time.
void killRows(cv::Mat& image, uint64_t seed);
/// Pixels that do not change, and columns with offsets of their own.
void stickPixels(cv::Mat& image, uint64_t seed);
/// JPEG and back. quality: 0 to 100.
void compress(cv::Mat& image, int quality);
/// What a video's decoder shows after it has lost an image: each later change, on top of the image before
/// that. before: the last one that it has. lost: the one after it.
void leaveGhost(cv::Mat& image, const cv::Mat& before, const cv::Mat& lost);
/// Gives the image the uppermost rows of the one before.
void tear(cv::Mat& image, const cv::Mat& before, int rows);

}  // namespace uav_landing
