#include "uav_landing/image/rectification.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace uav_landing {
namespace {

constexpr double kPeriod = 40;  // px, of the pattern in the raw image

CameraCalibration ideal() {
  CameraCalibration c;
  c.width = 320;
  c.height = 240;
  c.distortion_model = "plumb_bob";
  c.K << 300, 0, 158, 0, 305, 122, 0, 0, 1;
  c.R = Eigen::Matrix3d::Identity();
  c.P << 290, 0, 163, 0, 0, 290, 118, 0, 0, 0, 1, 0;
  return c;
}

CameraCalibration turned(CameraCalibration c) {
  c.R =
      (Eigen::AngleAxisd(0.03, Eigen::Vector3d::UnitX()) *
       Eigen::AngleAxisd(-0.04, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  return c;
}

CameraCalibration plumbBob() {
  CameraCalibration c = turned(ideal());
  c.D = {-0.25, 0.08, 0.004, -0.003, 0.01};
  return c;
}

CameraCalibration rationalPolynomial() {
  CameraCalibration c = turned(ideal());
  c.distortion_model = "rational_polynomial";
  c.D = {0.4, -0.2, 0.002, 0.003, 0.05, 0.7, -0.1, 0.02};
  return c;
}

CameraCalibration fisheye() {
  CameraCalibration c = turned(ideal());
  c.distortion_model = "equidistant";
  // 75 degrees to each side in the raw picture, 62 in the rectified one.
  c.K << 120, 0, 158, 0, 122, 122, 0, 0, 1;
  c.P << 85, 0, 163, 0, 0, 85, 118, 0, 0, 0, 1, 0;
  c.D = {-0.03, 0.02, -0.008, 0.001};
  return c;
}

CameraCalibration prismsAndTilt() {
  CameraCalibration c = rationalPolynomial();
  c.D.insert(c.D.end(), {0.01, -0.004, -0.008, 0.003, 0.03, -0.02});
  return c;
}

/// Kannala and Brandt's lens: the distance from the middle is an odd polynomial of the angle off the axis.
Eigen::Vector2d throughFisheye(const Eigen::Vector3d& ray, const std::vector<double>& D) {
  const double angle = std::atan2(std::hypot(ray.x(), ray.y()), ray.z());
  const double distance = angle + D[0] * std::pow(angle, 3) + D[1] * std::pow(angle, 5) +
                          D[2] * std::pow(angle, 7) + D[3] * std::pow(angle, 9);
  return distance * Eigen::Vector2d(ray.x(), ray.y()).normalized();
}

/// A sensor that is turned by these angles about x and y, seen from the lens (Louhichi et al. 2007).
Eigen::Vector2d onTiltedSensor(const Eigen::Vector2d& m, double about_x, double about_y) {
  // Columns are the sensor's axes; the rotation that OpenCV describes is the inverse of that of the axes.
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(-about_y, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(-about_x, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  const Eigen::Vector3d p = turn * m.homogeneous();
  // The ray cut by the sensor's plane, at the distance at which the axis meets it.
  return {(turn(2, 2) * p.x() - turn(0, 2) * p.z()) / p.z(),
          (turn(2, 2) * p.y() - turn(1, 2) * p.z()) / p.z()};
}

/// Brown's lens with tangential part, times the rational denominator, with thin prisms and a tilted sensor;
/// written from the published equations. D: k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 tx ty.
Eigen::Vector2d throughLens(const Eigen::Vector3d& ray, std::vector<double> D) {
  D.resize(14, 0.0);
  const double x = ray.x() / ray.z(), y = ray.y() / ray.z(), r2 = x * x + y * y;
  const double radial = (1 + D[0] * r2 + D[1] * std::pow(r2, 2) + D[4] * std::pow(r2, 3)) /
                        (1 + D[5] * r2 + D[6] * std::pow(r2, 2) + D[7] * std::pow(r2, 3));
  const Eigen::Vector2d seen(
      x * radial + 2 * D[2] * x * y + D[3] * (r2 + 2 * x * x) + D[8] * r2 + D[9] * r2 * r2,
      y * radial + D[2] * (r2 + 2 * y * y) + 2 * D[3] * x * y + D[10] * r2 + D[11] * r2 * r2);
  return onTiltedSensor(seen, D[12], D[13]);
}

/// Pixel of the delivered raw image at which the lens shows what the delivered rectified pixel looks at.
Eigen::Vector2d rawPixel(const CameraCalibration& c, double u, double v) {
  const double bx = std::max(c.binning_x, 1), by = std::max(c.binning_y, 1);
  const double full_u = u * bx + c.roi.x, full_v = v * by + c.roi.y;
  const Eigen::Vector3d rectified((full_u - c.P(0, 2)) / c.P(0, 0), (full_v - c.P(1, 2)) / c.P(1, 1), 1);
  const Eigen::Vector3d ray = c.R.transpose() * rectified;
  const Eigen::Vector2d m =
      c.distortion_model == "equidistant" ? throughFisheye(ray, c.D) : throughLens(ray, c.D);
  return {(c.K(0, 0) * m.x() + c.K(0, 2) - c.roi.x) / bx, (c.K(1, 1) * m.y() + c.K(1, 2) - c.roi.y) / by};
}

double pattern(double position) { return 128 + 110 * std::cos(2 * M_PI * position / kPeriod); }

/// Rectifies a wave along one axis of the raw image and compares each pixel with the wave where the lens
/// model says it comes from. One grey level is 0.06 px where the wave is steepest.
void expectRectified(const CameraCalibration& c) {
  const Expected<Rectifier> rectifier = Rectifier::create(c);
  ASSERT_TRUE(rectifier) << rectifier.error().message();
  const cv::Size size = c.imageSize();
  for (int axis = 0; axis < 2; ++axis) {
    cv::Mat raw(size, CV_8UC1), rectified;
    for (int v = 0; v < size.height; ++v)
      for (int u = 0; u < size.width; ++u)
        raw.at<uchar>(v, u) = cv::saturate_cast<uchar>(pattern(axis == 0 ? u : v));
    ASSERT_FALSE(rectifier->rectify(raw, rectified));
    ASSERT_EQ(rectified.size(), size);
    int compared = 0;
    double worst = 0;
    for (int v = 0; v < size.height; ++v)
      for (int u = 0; u < size.width; ++u) {
        if (rectifier->mask().at<uchar>(v, u) == 0) continue;
        ++compared;
        worst = std::max(worst, std::abs(rectified.at<uchar>(v, u) - pattern(rawPixel(c, u, v)[axis])));
      }
    EXPECT_GT(compared, size.area() / 2);
    EXPECT_LT(worst, 2.0) << "axis " << axis;
  }
}

/// The mask is 255 exactly where the lens model says the source is inside, but for the maps' 1/32 px.
void expectTrueMask(const CameraCalibration& c) {
  const Expected<Rectifier> rectifier = Rectifier::create(c);
  ASSERT_TRUE(rectifier) << rectifier.error().message();
  const cv::Size size = c.imageSize();
  constexpr double kGrid = 1.0 / 16;
  int inside_count = 0, outside_count = 0;
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u) {
      const Eigen::Vector2d p = rawPixel(c, u, v);
      const double margin = std::min({p.x(), p.y(), size.width - 1 - p.x(), size.height - 1 - p.y()});
      const int mask = rectifier->mask().at<uchar>(v, u);
      ASSERT_TRUE(mask == 0 || mask == 255);
      if (margin > kGrid) {
        ++inside_count;
        EXPECT_EQ(mask, 255) << u << ", " << v;
      } else if (margin < -kGrid) {
        ++outside_count;
        EXPECT_EQ(mask, 0) << u << ", " << v;
      }
    }
  EXPECT_GT(inside_count, 0);
  EXPECT_GT(outside_count, 0);
}

TEST(Rectifier, UndoesPlumbBobDistortionAndRotation) { expectRectified(plumbBob()); }
TEST(Rectifier, UndoesRationalPolynomialDistortionAndRotation) { expectRectified(rationalPolynomial()); }
TEST(Rectifier, UndoesThinPrismsAndATiltedSensor) {
  CameraCalibration c = prismsAndTilt();
  expectRectified(c);
  c.D.resize(12);
  expectRectified(c);
}
TEST(Rectifier, UndoesAFisheyeLens) {
  CameraCalibration c = fisheye();
  expectRectified(c);
  expectTrueMask(c);
  c.binning_x = c.binning_y = 2;
  c.roi = {40, 20, 240, 200};
  expectRectified(c);
}
TEST(Rectifier, LeavesOutWhereAFisheyeLensFoldsBack) {
  // The distance from the middle is greatest at 0.8 rad: 1 + 3 k1 0.64 = 0.
  CameraCalibration c = fisheye();
  c.R.setIdentity();
  c.D = {-1 / (3 * 0.64), 0, 0, 0};
  const Expected<Rectifier> rectifier = Rectifier::create(c);
  ASSERT_TRUE(rectifier) << rectifier.error().message();
  for (int u = 0; u < c.width; ++u) {
    const double angle = std::atan(std::abs(u - c.P(0, 2)) / c.P(0, 0));
    const int mask = rectifier->mask().at<uchar>(118, u);
    if (angle < 0.79) EXPECT_EQ(mask, 255) << u;
    if (angle > 0.81) EXPECT_EQ(mask, 0) << u;
  }
}
TEST(Rectifier, TakesALensWithoutDistortionForAPinholeByAnyName) {
  CameraCalibration c = turned(ideal());
  c.distortion_model = "equidistant";
  c.D.assign(4, 0.0);
  cv::Mat raw(c.imageSize(), CV_8UC1), by_name, plain;
  cv::randu(raw, 0, 256);
  ASSERT_FALSE(Rectifier::create(c)->rectify(raw, by_name));
  c.distortion_model = "plumb_bob";
  ASSERT_FALSE(Rectifier::create(c)->rectify(raw, plain));
  EXPECT_EQ(cv::norm(by_name, plain, cv::NORM_INF), 0);
}
TEST(Rectifier, HonoursRotationAndProjectionWithoutDistortion) {
  CameraCalibration c = turned(ideal());
  expectRectified(c);
  c.D.assign(5, 0.0);
  expectRectified(c);
}
TEST(Rectifier, HonoursBinning) {
  CameraCalibration c = plumbBob();
  c.binning_x = 2;
  c.binning_y = 3;
  expectRectified(c);
}
TEST(Rectifier, HonoursRegionOfInterest) {
  CameraCalibration c = plumbBob();
  c.roi = {70, 30, 180, 150};
  expectRectified(c);
  c.binning_x = c.binning_y = 2;
  expectRectified(c);
}

TEST(RectifierMask, IsTrueForEachLensModel) {
  expectTrueMask(plumbBob());
  expectTrueMask(rationalPolynomial());
  expectTrueMask(turned(ideal()));
  CameraCalibration c = plumbBob();
  c.roi = {70, 30, 180, 150};
  c.binning_x = 2;
  expectTrueMask(c);
}

TEST(RectifierMask, IsFullForAnImageThatIsAlreadyRectified) {
  CameraCalibration c = ideal();
  c.P.leftCols<3>() = c.K;
  const Expected<Rectifier> rectifier = Rectifier::create(c);
  ASSERT_TRUE(rectifier);
  EXPECT_EQ(cv::countNonZero(rectifier->mask()), 320 * 240);
}

TEST(RectifierMask, LeavesOutOnlyWhatLacksAPixelToInterpolateWith) {
  // Half a pixel to the side: the last column lacks its right neighbour, but no row lacks one below; and the
  // other way round.
  CameraCalibration aside = ideal(), below = ideal();
  aside.P.leftCols<3>() = below.P.leftCols<3>() = aside.K;
  aside.P(0, 2) -= 0.5;
  below.P(1, 2) -= 0.5;
  const Expected<Rectifier> columns = Rectifier::create(aside), rows = Rectifier::create(below);
  ASSERT_TRUE(columns && rows);
  EXPECT_EQ(cv::countNonZero(columns->mask().colRange(0, 319)), 319 * 240);
  EXPECT_EQ(cv::countNonZero(columns->mask().col(319)), 0);
  EXPECT_EQ(cv::countNonZero(rows->mask().rowRange(0, 239)), 320 * 239);
  EXPECT_EQ(cv::countNonZero(rows->mask().row(239)), 0);
}

TEST(RectifierMask, ExcludesWhereTheDistortionFoldsBackIntoThePicture) {
  // r (1 + k1 r^2) grows up to r = 1 / sqrt(-3 k1) = 1.054, and comes back to 0 at 1.826.
  CameraCalibration c = ideal();
  c.D = {-0.3, 0, 0, 0};
  c.P << 80, 0, 160, 0, 0, 80, 120, 0, 0, 0, 1, 0;
  const Expected<Rectifier> rectifier = Rectifier::create(c);
  ASSERT_TRUE(rectifier);
  int folded_into_picture = 0;
  for (int v = 0; v < c.height; ++v)
    for (int u = 0; u < c.width; ++u) {
      const double r = std::hypot(u - 160, v - 120) / 80;
      if (r < 1.06) continue;
      EXPECT_EQ(rectifier->mask().at<uchar>(v, u), 0) << u << ", " << v;
      const Eigen::Vector2d p = rawPixel(c, u, v);
      folded_into_picture += p.x() >= 0 && p.y() >= 0 && p.x() < c.width && p.y() < c.height;
    }
  EXPECT_GT(folded_into_picture, 1000);
  EXPECT_EQ(rectifier->mask().at<uchar>(120, 160), 255);
}

TEST(RectifierMask, ExcludesCoordinatesBeyondTheFixedPointRange) {
  // Sources 65536 px and more away must not wrap around into the picture.
  CameraCalibration c = ideal();
  c.D = {1000, 1000, 0, 0, 1000};
  const Expected<Rectifier> rectifier = Rectifier::create(c);
  ASSERT_TRUE(rectifier);
  for (int v = 0; v < c.height; ++v)
    for (int u = 0; u < c.width; ++u) {
      const Eigen::Vector2d p = rawPixel(c, u, v);
      if (p.x() < -1 || p.y() < -1 || p.x() > c.width || p.y() > c.height) {
        ASSERT_EQ(rectifier->mask().at<uchar>(v, u), 0) << u << ", " << v;
      }
    }
}

TEST(RectifierMask, ExcludesWhatLiesBehindTheCamera) {
  CameraCalibration c = ideal();
  c.R = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Expected<Rectifier> rectifier = Rectifier::create(c);
  ASSERT_TRUE(rectifier);
  EXPECT_EQ(cv::countNonZero(rectifier->mask()), 0);
}

TEST(Rectifier, IsBlackWhereTheRawImageHasNothingToGive) {
  const Expected<Rectifier> rectifier = Rectifier::create(plumbBob());
  ASSERT_TRUE(rectifier);
  cv::Mat rectified, near_picture, lost;
  ASSERT_FALSE(rectifier->rectify(cv::Mat(240, 320, CV_8UC1, cv::Scalar(255)), rectified));
  cv::dilate(rectifier->mask(), near_picture, cv::Mat::ones(5, 5, CV_8U));
  cv::bitwise_and(rectified, ~near_picture, lost);
  EXPECT_EQ(cv::countNonZero(lost), 0);
  cv::bitwise_and(~rectified, rectifier->mask(), lost);
  EXPECT_EQ(cv::countNonZero(lost), 0);
}

TEST(Rectifier, RefusesImagesItWasNotMadeFor) {
  const Expected<Rectifier> rectifier = Rectifier::create(ideal());
  ASSERT_TRUE(rectifier);
  cv::Mat out;
  EXPECT_EQ(rectifier->rectify(cv::Mat::zeros(480, 640, CV_8UC1), out).message(),
            "input_invalid: image is 640x480, its camera_info says 320x240");
  EXPECT_EQ(rectifier->rectify(cv::Mat::zeros(240, 320, CV_8UC3), out).message(),
            "input_invalid: image is not 8 bit grey");
  EXPECT_TRUE(rectifier->rectify(cv::Mat(), out));
}

TEST(Rectifier, RefusesABadCalibrationWithTheFieldsName) {
  CameraCalibration c = ideal();
  c.P(0, 0) = 0;
  const Expected<Rectifier> rectifier = Rectifier::create(c);
  ASSERT_FALSE(rectifier);
  EXPECT_EQ(rectifier.error().detail, "P[0]: 0, expected a positive focal length in pixels");
}

TEST(RigModel, HasTheRigAndBothMasks) {
  CameraCalibration left = plumbBob(), right = rationalPolynomial();
  right.P(0, 3) = -145;
  const Expected<RigModel> model = makeRigModel(left, right);
  ASSERT_TRUE(model) << model.error().message();
  EXPECT_DOUBLE_EQ(model->rig.baseline, 0.5);
  EXPECT_EQ(cv::norm(model->left_mask, Rectifier::create(left)->mask(), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(model->right_mask, Rectifier::create(right)->mask(), cv::NORM_INF), 0);
  right.P(0, 3) = 145;
  EXPECT_FALSE(makeRigModel(left, right));
}

/// What a person left out of a raw picture: a nose with a round top, and a strut of three pixels.
RawMask drawnMask(cv::Size size, const std::string& parameter) {
  RawMask mask{cv::Mat(size, CV_8UC1, cv::Scalar(7)), parameter, "/home/me/nose.png"};
  cv::ellipse(mask.usable, {size.width / 2, size.height}, {size.width / 4, size.height / 4}, 0, 0, 360, 0,
              cv::FILLED);
  cv::line(mask.usable, {size.width / 5, 0}, {size.width / 3, size.height}, 0, 3);
  return mask;
}

/// 1 where the lens takes a rectified pixel from usable pixels of the raw image alone, 0 where it does not,
/// and -1 where it comes from so near a pixel's middle that rounding decides whether the next one counts.
int expectedUsable(const CameraCalibration& c, const cv::Mat& usable, int u, int v) {
  constexpr double kRounding = 1.0 / 32 + 1e-3;  // px, of the places' fixed point
  const Eigen::Vector2d raw = rawPixel(c, u, v);
  const double x = std::floor(raw.x()), y = std::floor(raw.y());
  for (const double fraction : {raw.x() - x, raw.y() - y})
    if (fraction < kRounding || fraction > 1 - kRounding) return -1;
  const cv::Point first(static_cast<int>(x), static_cast<int>(y));
  const cv::Rect picture({}, usable.size());
  for (const cv::Point& step : {cv::Point(0, 0), {1, 0}, {0, 1}, {1, 1}})
    if (!picture.contains(first + step) || usable.at<uchar>(first + step) == 0) return 0;
  return 1;
}

void expectMaskIs(const cv::Mat& mask, const CameraCalibration& c, const cv::Mat& usable) {
  int compared = 0, left_out = 0;
  for (int v = 0; v < mask.rows; ++v)
    for (int u = 0; u < mask.cols; ++u) {
      const int expected = expectedUsable(c, usable, u, v);
      if (expected < 0) continue;
      ++compared;
      left_out += expected == 0;
      ASSERT_EQ(mask.at<uchar>(v, u), 255 * expected) << u << ", " << v;
    }
  EXPECT_GT(compared, 0.8 * static_cast<double>(mask.total()));
  EXPECT_GT(left_out, 0.1 * static_cast<double>(mask.total()));
}

TEST(RigModel, LeavesOutWhatTheMasksOfTheRawImagesSayAndNothingElse) {
  for (const bool reduced : {false, true}) {
    SCOPED_TRACE(reduced);
    CameraCalibration left = plumbBob(), right = rationalPolynomial();
    right.P(0, 3) = -145;
    for (CameraCalibration* camera : {&left, &right}) {
      if (!reduced) continue;
      camera->roi = cv::Rect(20, 10, 280, 220);
      camera->binning_x = camera->binning_y = 2;
    }
    const RigMasks masks{drawnMask(left.imageSize(), "rig/left_mask"), {}};
    const Expected<RigModel> model = makeRigModel(left, right, masks);
    ASSERT_TRUE(model) << model.error().message();
    expectMaskIs(model->left_mask, left, masks.left.usable);
    EXPECT_EQ(cv::norm(model->right_mask, Rectifier::create(right)->mask(), cv::NORM_INF), 0)
        << "it has none";

    const RigMasks other{{}, drawnMask(right.imageSize(), "rig/right_mask")};
    const Expected<RigModel> right_masked = makeRigModel(left, right, other);
    ASSERT_TRUE(right_masked) << right_masked.error().message();
    expectMaskIs(right_masked->right_mask, right, other.right.usable);
    EXPECT_EQ(cv::norm(right_masked->left_mask, Rectifier::create(left)->mask(), cv::NORM_INF), 0);
  }
}

TEST(RigModel, LeavesOutTheSamePixelsOfImagesThatAreRectifiedAlready) {
  CameraCalibration left = ideal();
  left.K = left.P.leftCols<3>();
  CameraCalibration right = left;
  right.P(0, 3) = -145;
  const RigMasks masks{drawnMask(left.imageSize(), "rig/left_mask"), {}};
  const cv::Mat expected = masks.left.usable != 0;
  EXPECT_EQ(cv::norm(makeRigModel(left, right, masks)->left_mask, expected, cv::NORM_INF), 0);
}

TEST(RigModel, RefusesAMaskOfAnotherPictureAndNamesIt) {
  CameraCalibration left = plumbBob(), right = rationalPolynomial();
  right.P(0, 3) = -145;
  const RawMask small = drawnMask({160, 120}, "rig/right_mask");
  const Expected<RigModel> model = makeRigModel(left, right, {{}, small});
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().detail.find("rig/right_mask: /home/me/nose.png: is 160x120, expected 320x240"), 0U)
      << model.error().detail;
}

}  // namespace
}  // namespace uav_landing
