#include "uav_landing/geometry/calibration.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "geometry/lens.h"

namespace uav_landing {

namespace {

constexpr int kMaxImageSide = 16384;  // keeps the maps within fixed point and memory
constexpr double kRotationTolerance = 1e-3;
constexpr double kFocalTolerance = 1e-5;  // relative; 0.01 px at the edge of a 1000 px image
constexpr double kRowTolerance = 0.01;    // px
constexpr double kRowShift = 1e-3;        // of the baseline
constexpr double kSamePlace = 1e-9;       // of the larger P[3]
constexpr const char* kBeside = ", and the pair has to stand side by side";
constexpr const char* kNegative = "-P[0] times the baseline in metres, a negative number";

std::string text(double value) {
  std::ostringstream out;
  out.precision(10);
  out << value;
  return out.str();
}

Failure invalid(const std::string& field, const std::string& value, const std::string& expected) {
  return {Reason::kInputInvalid, field + ": " + value + ", expected " + expected};
}

Failure invalid(const std::string& field, double value, const std::string& expected) {
  return invalid(field, text(value), expected);
}

std::string element(const char* matrix, int index) {
  return std::string(matrix) + "[" + std::to_string(index) + "]";
}

/// Checks the first three columns of K or P: focal lengths and principal point, no skew, last row 0 0 1.
template <class Matrix>
Failure checkPinhole(const char* name, const Matrix& m) {
  const int columns = static_cast<int>(m.cols());
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < columns; ++column)
      if (!std::isfinite(m(row, column)))
        return invalid(element(name, row * columns + column), m(row, column), "a number");
  for (int row = 0; row < 2; ++row)
    if (m(row, row) <= 0)
      return invalid(element(name, row * columns + row), m(row, row), "a positive focal length in pixels");
  for (int row = 0; row < 2; ++row)
    if (m(row, 2) == 0)
      return invalid(element(name, row * columns + 2), m(row, 2),
                     row == 0 ? "the column of the principal point in pixels"
                              : "the row of the principal point in pixels");
  for (const auto& [row, column] : {std::pair{0, 1}, {1, 0}, {2, 0}, {2, 1}})
    if (m(row, column) != 0) return invalid(element(name, row * columns + column), m(row, column), "0");
  if (m(2, 2) != 1) return invalid(element(name, 2 * columns + 2), m(2, 2), "1");
  return {};
}

Failure checkDistortion(const CameraCalibration& c) {
  for (size_t i = 0; i < c.D.size(); ++i)
    if (!std::isfinite(c.D[i])) return invalid(element("D", static_cast<int>(i)), c.D[i], "a number");
  if (!isDistorted(c.D)) return {};
  struct Model {
    const char* name;
    std::vector<size_t> counts;
    const char* expected;
  };
  static const Model kModels[] = {{"plumb_bob", {4, 5}, "4 or 5 for plumb_bob"},
                                  {"rational_polynomial", {8, 12, 14}, "8, 12 or 14 for rational_polynomial"},
                                  {"equidistant", {4}, "4 for equidistant"},
                                  {"fisheye", {4}, "4 for fisheye"}};
  for (const Model& model : kModels) {
    if (c.distortion_model != model.name) continue;
    const bool fits = std::count(model.counts.begin(), model.counts.end(), c.D.size()) > 0;
    return fits ? Failure() : invalid("D", std::to_string(c.D.size()) + " coefficients", model.expected);
  }
  return invalid("distortion_model", "\"" + c.distortion_model + "\"",
                 "plumb_bob, rational_polynomial or equidistant (fisheye lenses)");
}

Failure checkRotation(const Eigen::Matrix3d& R) {
  for (int i = 0; i < 9; ++i)
    if (!std::isfinite(R(i / 3, i % 3))) return invalid(element("R", i), R(i / 3, i % 3), "a number");
  if (R.isZero(0)) return invalid("R", "all zero", "a rotation matrix");
  const double deviation = (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (deviation > kRotationTolerance)
    return invalid("R", "R R' differs from the identity by " + text(deviation), "a rotation matrix");
  if (R.determinant() < 0) return invalid("R", "a reflection", "a rotation matrix");
  return {};
}

Failure checkReduction(const CameraCalibration& c) {
  if (c.binning_x < 0) return invalid("binning_x", c.binning_x, "0 or more");
  if (c.binning_y < 0) return invalid("binning_y", c.binning_y, "0 or more");
  if (c.roi != cv::Rect()) {
    if (c.roi.x < 0 || c.roi.x >= c.width) return invalid("roi.x_offset", c.roi.x, "a column of the image");
    if (c.roi.y < 0 || c.roi.y >= c.height) return invalid("roi.y_offset", c.roi.y, "a row of the image");
    if (c.roi.width <= 0 || c.roi.width > c.width - c.roi.x)
      return invalid("roi.width", c.roi.width, "1 to " + std::to_string(c.width - c.roi.x) + " pixels");
    if (c.roi.height <= 0 || c.roi.height > c.height - c.roi.y)
      return invalid("roi.height", c.roi.height, "1 to " + std::to_string(c.height - c.roi.y) + " pixels");
  }
  const cv::Size size = c.imageSize();
  if (size.width < 1) return invalid("binning_x", c.binning_x, "at most the width of the image");
  if (size.height < 1) return invalid("binning_y", c.binning_y, "at most the height of the image");
  return {};
}

Failure prefixed(const char* side, Failure failure) {
  failure.detail = std::string(side) + " " + failure.detail;
  return failure;
}

Failure mismatch(const std::string& field, double value, double left) {
  return invalid("right " + field, value, text(left) + " as on the left");
}

/// Place of the origin of P in the camera's axes, m: P = K [I | t].
Eigen::Vector3d translation(const Eigen::Matrix<double, 3, 4>& P) {
  return {(P(0, 3) - P(0, 2) * P(2, 3)) / P(0, 0), (P(1, 3) - P(1, 2) * P(2, 3)) / P(1, 1), P(2, 3)};
}

/// Tells why the right camera is not beside the left one, on its right. to_right: from the left to the right
/// camera, m.
Failure checkPlaces(const CameraCalibration& left, const CameraCalibration& right,
                    const Eigen::Vector3d& to_right) {
  const auto &Pl = left.P, &Pr = right.P;
  const double x = to_right.x(), y = to_right.y(), z = to_right.z();
  const double larger = std::max(std::abs(Pl(0, 3)), std::abs(Pr(0, 3)));
  if (std::abs(y) > std::abs(x) && std::abs(y) >= std::abs(z))
    return invalid("right P[7]", Pr(1, 3),
                   (y > 0 ? "0: the right camera stands below the left one"
                          : "0: the right camera stands above the left one") +
                       std::string(kBeside));
  if (std::abs(z) > std::abs(x))
    return invalid("right P[11]", Pr(2, 3),
                   (z > 0 ? "0: the right camera stands before the left one"
                          : "0: the right camera stands behind the left one") +
                       std::string(kBeside));
  if (std::abs(Pr(0, 3) - Pl(0, 3)) <= kSamePlace * larger && larger > 0)
    return invalid("left P[3]", Pl(0, 3),
                   "0: it is that of the right camera, too, as if both stood in one place");
  if (x < 0 && Pl(0, 3) != 0)
    return invalid("left P[3]", Pl(0, 3),
                   Pr(0, 3) == 0 ? "0, and a negative right P[3], which is 0: left and right are exchanged"
                                 : "more than right P[3], " + text(Pr(0, 3)) +
                                       ": left and right are exchanged, or the signs are wrong");
  if (x < 0)
    return invalid("right P[3]", Pr(0, 3),
                   std::string(kNegative) + ": left and right are exchanged, or the driver's sign is wrong");
  if (std::abs(y) > kRowShift * x)
    return invalid("right P[7]", Pr(1, 3), text(Pl(1, 3)) + " as on the left: the same row in both images");
  if (std::abs(z) > kRowShift * x)
    return invalid("right P[11]", Pr(2, 3), text(Pl(2, 3)) + " as on the left");
  return {};
}

bool isAtOrigin(const CameraCalibration& c) { return c.P.col(3).isZero(0); }

/// Tells why the rows of the two rectified images do not correspond.
Failure checkPair(const CameraCalibration& left, const CameraCalibration& right) {
  const auto same = [](const char* field, int l, int r) {
    return l == r ? Failure{} : mismatch(field, r, l);
  };
  for (const Failure& failure :
       {same("width", left.width, right.width), same("height", left.height, right.height),
        same("binning_x", std::max(left.binning_x, 1), std::max(right.binning_x, 1)),
        same("binning_y", std::max(left.binning_y, 1), std::max(right.binning_y, 1)),
        same("roi.y_offset", left.roi.y, right.roi.y), same("roi.width", left.roi.width, right.roi.width),
        same("roi.height", left.roi.height, right.roi.height)})
    if (failure) return failure;
  const auto &Pl = left.P, &Pr = right.P;
  if (isAtOrigin(left) && isAtOrigin(right))
    return invalid("right P[3]", Pr(0, 3),
                   std::string(kNegative) + ": these are two single calibrations, not one of the pair");
  for (int i = 0; i < 2; ++i)
    if (std::abs(Pr(i, i) - Pl(i, i)) > kFocalTolerance * Pl(i, i))
      return mismatch(element("P", 5 * i), Pr(i, i), Pl(i, i));
  if (std::abs(Pr(1, 2) - Pl(1, 2)) > kRowTolerance) return mismatch("P[6]", Pr(1, 2), Pl(1, 2));
  return checkPlaces(left, right, translation(Pl) - translation(Pr));
}

}  // namespace

bool CameraCalibration::operator==(const CameraCalibration& other) const {
  return width == other.width && height == other.height && distortion_model == other.distortion_model &&
         D == other.D && K == other.K && R == other.R && P == other.P && binning_x == other.binning_x &&
         binning_y == other.binning_y && roi == other.roi;
}

cv::Size CameraCalibration::imageSize() const {
  const cv::Size full = roi == cv::Rect() ? cv::Size(width, height) : roi.size();
  return {full.width / std::max(binning_x, 1), full.height / std::max(binning_y, 1)};
}

CameraCalibration CameraCalibration::ofDeliveredImage() const {
  CameraCalibration reduced = *this;
  const Eigen::Vector2d offset(roi.x, roi.y);
  const Eigen::Vector2d binning(std::max(binning_x, 1), std::max(binning_y, 1));
  for (int i = 0; i < 2; ++i) {
    reduced.K(i, 2) -= offset[i];
    reduced.P(i, 2) -= offset[i];
    reduced.P(i, 3) -= offset[i] * P(2, 3);
    reduced.K.row(i) /= binning[i];
    reduced.P.row(i) /= binning[i];
  }
  reduced.width = imageSize().width;
  reduced.height = imageSize().height;
  reduced.binning_x = reduced.binning_y = 0;
  reduced.roi = {};
  return reduced;
}

Eigen::Matrix3d StereoRig::K() const {
  Eigen::Matrix3d K;
  K << fx, 0, cx, 0, fy, cy, 0, 0, 1;
  return K;
}

Eigen::Matrix3d StereoRig::Kinv() const {
  Eigen::Matrix3d K;
  K << 1 / fx, 0, -cx / fx, 0, 1 / fy, -cy / fy, 0, 0, 1;
  return K;
}

Failure checkCalibration(const CameraCalibration& calibration) {
  const std::string side = "1 to " + std::to_string(kMaxImageSide) + " pixels";
  if (calibration.width < 1 || calibration.width > kMaxImageSide)
    return invalid("width", calibration.width, side);
  if (calibration.height < 1 || calibration.height > kMaxImageSide)
    return invalid("height", calibration.height, side);
  if (Failure failure = checkReduction(calibration)) return failure;
  if (Failure failure = checkPinhole("K", calibration.K)) return failure;
  if (Failure failure = checkDistortion(calibration)) return failure;
  if (Failure failure = checkRotation(calibration.R)) return failure;
  return checkPinhole("P", calibration.P);
}

Expected<StereoRig> makeStereoRig(const CameraCalibration& left, const CameraCalibration& right) {
  if (Failure failure = checkCalibration(left)) return tl::unexpected(prefixed("left", failure));
  if (Failure failure = checkCalibration(right)) return tl::unexpected(prefixed("right", failure));
  if (Failure failure = checkPair(left, right)) return tl::unexpected(failure);
  const CameraCalibration l = left.ofDeliveredImage(), r = right.ofDeliveredImage();
  StereoRig rig;
  rig.size = l.imageSize();
  rig.fx = l.P(0, 0);
  rig.fy = l.P(1, 1);
  rig.cx = l.P(0, 2);
  rig.cy = l.P(1, 2);
  rig.cx_right = r.P(0, 2);
  rig.baseline = translation(l.P).x() - translation(r.P).x();
  return rig;
}

}  // namespace uav_landing
