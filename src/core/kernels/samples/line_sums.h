#pragma once

namespace uav_landing {

/// Samples of a value along a line, by columns, filled up to whole lanes with anything finite.
struct LineSamples {
  const float *along, *across, *weight;
  int count;
};

/// across = offset + slope (along - centre), by weighted least squares. weight: sum of the weights. spread:
/// sum of w (along - centre)^2.
struct LineFit {
  float centre = 0, offset = 0, slope = 0, weight = 0, spread = 0;
};
LineFit fitLine(const LineSamples& samples);

/// Sets the distances of the samples from a line and returns their mean. Weights do not matter.
float measureDistances(const LineSamples& samples, const LineFit& line, float* distances);

/// Tukey's weights (1 - d^2)^2 of d = distance inverse, 0 from d = 1 on, times the weights of base.
void weighByDistance(const float* base, const float* distances, float inverse, int count, float* weights);

/// Square of each value over enough, at most 1.
void weighByShare(const float* values, float enough, int count, float* weights);

float meanOf(const float* values, int count);

/// Weighted sums over samples about a line, in their order. squares: of the distances. products: of
/// neighbours' distances, times the root of their weights' product. pairs: sum of these roots.
struct LineScatter {
  double squares, products, pairs;
};
/// samples: at most kMostLineSamples.
constexpr int kMostLineSamples = 320;
LineScatter scatterAbout(const LineSamples& samples, const LineFit& line);

}  // namespace uav_landing
