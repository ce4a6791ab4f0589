#include "motion/path/focus_of_expansion.h"

#include <Eigen/LU>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace uav_landing {
namespace {

// A velocity vector. It points away from the focus of expansion.
struct Velocity {
  Eigen::Vector2d from, to;
};

std::vector<Velocity> velocities(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                                 const Eigen::Matrix3d& R) {
  // Shorter vectors have no reliable direction, pixels.
  constexpr double kShortest = 1.0;
  std::vector<Velocity> result;
  for (const TemporalMatch& match : matches) {
    const Eigen::Vector3d turned = R * rig.ray(match.then.x(), match.then.y());
    if (!(turned.z() > 0)) continue;
    const Velocity velocity{rig.project(turned), match.now};
    if ((velocity.to - velocity.from).norm() >= kShortest) result.push_back(velocity);
  }
  return result;
}

// Adds one to each pixel of a line across the whole image.
void addLine(const Velocity& velocity, cv::Mat& counts) {
  const Eigen::Vector2d along = (velocity.to - velocity.from).normalized() * (counts.cols + counts.rows);
  const Eigen::Vector2d a = velocity.to - along, b = velocity.to + along;
  cv::Point p(cvRound(a.x()), cvRound(a.y())), q(cvRound(b.x()), cvRound(b.y()));
  if (!cv::clipLine(counts.size(), p, q)) return;
  cv::LineIterator line(counts, p, q, 8);
  for (int i = 0; i < line.count; ++i, ++line) ++counts.at<ushort>(line.pos());
}

// The window's middle with a covariance. The scatter of the lines that pass nearby gives the covariance of
// the point nearest to them. The square of that point's offset from the middle is added.
Expected<FocusOfExpansion> windowWithCovariance(const std::vector<Velocity>& lines,
                                                const Eigen::Vector2d& window) {
  constexpr double kNear = 4.0;
  constexpr int kFewest = 3;
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  double squares = 0;
  int count = 0;
  for (const Velocity& line : lines) {
    const Eigen::Vector2d along = (line.to - line.from).normalized();
    const Eigen::Vector2d normal(-along.y(), along.x());
    const double distance = normal.dot(line.to - window);
    if (std::abs(distance) > kNear) continue;
    information += normal * normal.transpose();
    right += normal * distance;
    squares += distance * distance;
    ++count;
  }
  if (count < kFewest || information.determinant() < 1e-6 * count * count) {
    return tl::make_unexpected(Failure{Reason::kNoMotion, "the image velocities do not meet in one point"});
  }
  const Eigen::Matrix2d inverse = information.inverse();
  const Eigen::Vector2d offset = inverse * right;
  return FocusOfExpansion{window, squares / count * inverse + offset * offset.transpose()};
}

}  // namespace

Expected<FocusOfExpansion> foeFromMotion(const StereoRig& rig, const Eigen::Vector3d& t,
                                         const Eigen::Matrix3d& t_covariance) {
  if (!(t.z() > 0)) {
    return tl::make_unexpected(Failure{Reason::kNoMotion, "the camera does not move forwards"});
  }
  Eigen::Matrix<double, 2, 3> projection;
  projection << rig.fx / t.z(), 0, -rig.fx * t.x() / (t.z() * t.z()), 0, rig.fy / t.z(),
      -rig.fy * t.y() / (t.z() * t.z());
  return FocusOfExpansion{rig.project(t), projection * t_covariance * projection.transpose()};
}

Expected<FocusOfExpansion> foeSlidingWindow(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                                            const Eigen::Matrix3d& R) {
  const std::vector<Velocity> lines = velocities(rig, matches, R);
  cv::Mat counts = cv::Mat::zeros(rig.size, CV_16UC1), sums;
  for (const Velocity& line : lines) addLine(line, counts);
  cv::boxFilter(counts, sums, CV_32F, cv::Size(3, 3), cv::Point(-1, -1), false, cv::BORDER_CONSTANT);
  double most = 0;
  cv::Point at;
  cv::minMaxLoc(sums, nullptr, &most, nullptr, &at);
  if (!(most > 0)) return tl::make_unexpected(Failure{Reason::kNoMotion, "no image velocities"});
  return windowWithCovariance(lines, {double(at.x), double(at.y)});
}

}  // namespace uav_landing
