#include "uav_landing/vanishing_point.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <numeric>
#include <random>

#include "median.h"
#include "multiversion.h"
#include "rotation.h"
#include "vanishing_candidate.h"

namespace uav_landing {

namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kPriorTolerance = 5 * kDegree;  // of the direction from the ground known from elsewhere
constexpr double kMinSpread = 3 * kDegree;       // between the inlier lines in the image
constexpr double kMaxStddev = 5 * kDegree;       // of a direction that is worth reporting
constexpr double kGate = 4;                      // robust sigma, of the lines that count in the end
constexpr double kChance = 1;                    // accepted number of such coincidences among random lines
constexpr double kStraightness = 1.0;            // px by which an edge may differ from a straight line
constexpr double kRunwayShare = 0.25;            // of the lines, that are along the runway
constexpr double kLikely = 0.05;                 // chance from which on a line that passes says nothing

using Matrix32 = Eigen::Matrix<double, 3, 2>;

Failure noVanishingPoint(const char* format, double a, double b = 0) {
  char text[200];
  std::snprintf(text, sizeof(text), format, a, b);
  return {Reason::kNoVanishingPoint, text};
}

/// The lines' numbers that most attempts need, by column.
struct LineColumns {
  std::vector<double> middle_u, middle_v, along_u, along_v, across_u, across_v, top_u, top_v;
  std::vector<double> half2, reach, tolerance2;  // half: length; reach: with the clearance

  void add(const VanishingCandidate& line, double tolerance) {
    middle_u.push_back(line.middle.x());
    middle_v.push_back(line.middle.y());
    along_u.push_back(line.along.x());
    along_v.push_back(line.along.y());
    across_u.push_back(line.line.x());
    across_v.push_back(line.line.y());
    top_u.push_back(line.top.x());
    top_v.push_back(line.top.y());
    half2.push_back(line.half * line.half);
    reach.push_back(line.half + VanishingCandidate::kClearance);
    tolerance2.push_back(tolerance * tolerance);
  }
};

constexpr double kAbove = 2;  // instead of a fit, which is 1 at most

/// How well each line passes through the homogeneous point (x, y, z): 1 when exactly, 0 when its ends miss it
/// by the tolerance, kAbove when part of the line is above the horizon. As VanishingCandidate has it for one.
UAV_LANDING_MULTIVERSION void fitLines(const LineColumns& lines, double x, double y, double z, int count,
                                       double* __restrict fit) {
  const double *mu = lines.middle_u.data(), *mv = lines.middle_v.data(), *au = lines.along_u.data(),
               *av = lines.along_v.data(), *nu = lines.across_u.data(), *nv = lines.across_v.data(),
               *tu = lines.top_u.data(), *tv = lines.top_v.data(), *half2 = lines.half2.data(),
               *reach = lines.reach.data(), *tolerance2 = lines.tolerance2.data();
  for (int i = 0; i < count; ++i) {
    const double eu = x - z * mu[i], ev = y - z * mv[i];
    const double ahead = std::abs(au[i] * eu + av[i] * ev), across = nu[i] * eu + nv[i] * ev;
    const double miss2 = half2[i] * across * across / (across * across + ahead * ahead);
    const double passing = ahead < reach[i] * z ? -1.0 : 1 - miss2 / tolerance2[i];
    const double above = (y - z * tv[i]) - VanishingCandidate::kMaxHorizonSlope * std::abs(x - z * tu[i]);
    fit[i] = above > 0 ? kAbove : passing;
  }
}

class Search {
 public:
  Search(const std::vector<LineSegment>& lines, const Eigen::Matrix3d& K,
         const ApproachAngleParameters& parameters, const Eigen::Vector3d* prior_normal)
      : lines_(lines.begin(), lines.end()),
        K_(K),
        Kinv_(K.inverse()),
        parameters_(parameters),
        prior_normal_(prior_normal) {
    const Eigen::Vector3d horizon =
        prior_normal ? Eigen::Vector3d(Kinv_.transpose() * *prior_normal) : Eigen::Vector3d::UnitY();
    horizon_ = Eigen::Vector2d(horizon.y(), -horizon.x()).normalized();
    groupPieces();
    for (const VanishingCandidate& line : lines_) {
      columns_.add(line, toleranceOf(line));
      turns_.push_back(toleranceOf(line) / line.half * perTurn(line));
      impossible_.push_back(std::log1p(line.half / parameters_.ransac_tolerance));
    }
    fit_.resize(lines_.size());
    agreeing_.resize(lines_.size());
  }

  Expected<VanishingPoint> run() {
    if (count() < std::max(parameters_.min_lines, 2))
      return tl::unexpected(Failure{Reason::kTooFewFeatures, std::to_string(count()) + " lines of at least " +
                                                                 std::to_string(parameters_.min_lines)});
    Eigen::Vector3d direction;
    if (!consensus(direction))
      return tl::unexpected(noVanishingPoint("none of the %.0f lines meet along the runway", count()));
    return fit(direction);
  }

  /// Of given lines.
  Expected<VanishingPoint> fitTo(const std::vector<int>& used) const {
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    double widest = 0;
    for (const int i : used) {
      for (const int j : used) {
        const double sine =
            std::abs(lines_[i].along.x() * lines_[j].along.y() - lines_[i].along.y() * lines_[j].along.x());
        Eigen::Vector3d candidate;
        if (sine <= widest || !meeting(i, j, candidate)) continue;
        widest = sine;
        direction = candidate;
      }
    }
    if (widest < std::sin(kMinSpread))
      return tl::unexpected(noVanishingPoint("%.0f lines are parallel", static_cast<double>(used.size())));
    Eigen::Matrix2d information;
    Matrix32 B;
    for (int iteration = 0; iteration < 5; ++iteration) {
      const double scale = robustScale(normalised(direction, used));
      step(direction, used, 2.385 * scale, information, B);
      if (!direction.allFinite() || direction.z() <= 0 || !alongRunway(direction))
        return tl::unexpected(
            noVanishingPoint("%.0f lines meet, but not along the runway", static_cast<double>(used.size())));
    }
    return describe(direction, used, information, B);
  }

 private:
  int count() const { return static_cast<int>(lines_.size()); }

  bool alongRunway(const Eigen::Vector3d& v) const {
    return std::abs(std::atan2(v.x(), v.z())) <= parameters_.max_yaw_deg * kDegree &&
           std::abs(std::asin(v.y())) <= parameters_.max_elevation_deg * kDegree &&
           (prior_normal_ == nullptr || std::abs(prior_normal_->dot(v)) <= std::sin(kPriorTolerance));
  }

  /// Where two lines meet, as a direction towards +z; false when that is not along the runway.
  bool meeting(int i, int j, Eigen::Vector3d& direction) const {
    direction = Kinv_ * lines_[i].line.cross(lines_[j].line);
    const double norm = direction.norm();
    if (!(norm > 0)) return false;
    direction *= (direction.z() < 0 ? -1 : 1) / norm;
    return alongRunway(direction);
  }

  /// Probability that a line of random direction on the ground, seen where this one is, passes through V
  /// within the tolerance at its ends. Texture seen at a grazing angle looks like lines along the horizon, so
  /// these pass near every point of it and say next to nothing; lines that rise towards it say much.
  double chance(const VanishingCandidate& line, const Eigen::Vector3d& V, double tolerance) const {
    const double turn = tolerance / line.half * perTurn(line) * line.towards(V).norm() * perPixel(V);
    return std::min(1.0, 2 / M_PI * std::atan(turn));  // turn: on the ground, rad
  }
  /// Along the horizon a pixel is less of an angle the farther it is to the side. Over V.z.
  double perPixel(const Eigen::Vector3d& V) const { return V.z() / (Kinv_ * V).squaredNorm(); }
  /// Angle on the ground over that in the picture, rad / px.
  double perTurn(const VanishingCandidate& line) const {
    const double sine = std::abs(line.along.x() * horizon_.y() - line.along.y() * horizon_.x());
    return 1 / (K_(0, 0) * std::max(sine, 1e-6));
  }

  /// Distance by which a line's ends may miss, px: as far as its own errors let it, but runways are not
  /// perfectly straight.
  double toleranceOf(const VanishingCandidate& line) const {
    return std::min(std::max(kStraightness, kGate * std::sqrt(line.endVariance())),
                    parameters_.ransac_tolerance);
  }

  /// Log-likelihood ratio of a line that passes, where a share of the lines does because they are the
  /// runway's and the others do by chance.
  static double evidence(double chance) { return std::log(1 - kRunwayShare + kRunwayShare / chance); }

  /// Evidence of the lines that pass through, each weighted by how well, less that of those that do not and
  /// of those that could not be on the ground if this were its horizon. Lines that pass nearly everywhere do
  /// not count, however many they are; of the pieces of one edge only the best does.
  double score(const Eigen::Vector3d& direction) {
    static const double kLikelyTurn = std::tan(0.5 * M_PI * kLikely);
    const Eigen::Vector3d V = K_ * direction;
    fitLines(columns_, V.x(), V.y(), V.z(), count(), fit_.data());
    const double per_pixel = perPixel(V);
    std::fill(agreeing_.begin(), agreeing_.end(), 0.0);
    double impossible = 0;
    for (size_t i = 0; i < lines_.size(); ++i) {
      if (fit_[i] <= 0) continue;
      if (fit_[i] == kAbove) {
        impossible += impossible_[i];
        continue;
      }
      const double turn = turns_[i] * lines_[i].towards(V).norm() * per_pixel;
      if (turn >= kLikelyTurn) continue;
      double& best = agreeing_[edge_[i]];
      best = std::max(best, fit_[i] * evidence(2 / M_PI * std::atan(turn)));
    }
    return std::accumulate(agreeing_.begin(), agreeing_.end(), -impossible);
  }

  /// Numbers the edges that the lines are pieces of: lines that continue each other belong to one.
  void groupPieces() {
    constexpr double kSameEdge = 1.5;  // px
    edge_.resize(lines_.size());
    std::iota(edge_.begin(), edge_.end(), size_t(0));
    for (size_t i = 0; i < lines_.size(); ++i) {
      for (size_t j = 0; j < i; ++j) {
        const double miss = std::max(std::abs(lines_[i].line.dot(lines_[j].middle.homogeneous())),
                                     std::abs(lines_[j].line.dot(lines_[i].middle.homogeneous())));
        if (miss >= kSameEdge) continue;
        edge_[i] = edge_[j];
        break;
      }
    }
  }

  /// RANSAC: the meeting point of the pair of lines on which most length of lines agrees. All pairs when
  /// they are few, otherwise random ones in proportion to length.
  bool consensus(Eigen::Vector3d& best) {
    double best_score = std::numeric_limits<double>::lowest();
    int tried = 0, meetings = 0;
    const auto attempt = [&](int i, int j) {
      if (i == j) return;
      ++tried;
      Eigen::Vector3d direction;
      if (!meeting(i, j, direction)) return;
      ++meetings;
      const double s = score(direction);
      if (s <= best_score) return;
      best_score = s;
      best = direction;
    };
    const int pairs = count() * (count() - 1) / 2;
    if (pairs <= parameters_.ransac_iterations) {
      for (int i = 0; i < count(); ++i)
        for (int j = i + 1; j < count(); ++j) attempt(i, j);
      meetings_ = meetings;
      return meetings > 0;
    }
    std::vector<double> cumulative(lines_.size());
    std::transform(lines_.begin(), lines_.end(), cumulative.begin(),
                   [](const VanishingCandidate& c) { return c.half; });
    std::partial_sum(cumulative.begin(), cumulative.end(), cumulative.begin());
    // The generator is the same everywhere; the standard library's distributions are not.
    std::mt19937 random(1);
    const auto draw = [&] {
      const double place = (random() + 0.5) / 4294967296.0 * cumulative.back();
      return static_cast<int>(std::lower_bound(cumulative.begin(), cumulative.end(), place) -
                              cumulative.begin());
    };
    for (int k = 0; k < parameters_.ransac_iterations; ++k) {
      const int i = draw(), j = draw();
      attempt(i, j);
    }
    meetings_ = static_cast<double>(meetings) / std::max(tried, 1) * pairs;
    return meetings > 0;
  }

  /// Indices of the lines that pass through by the consensus tolerance.
  std::vector<int> passing(const Eigen::Vector3d& direction) const {
    const Eigen::Vector3d V = K_ * direction;
    std::vector<int> indices;
    for (int i = 0; i < count(); ++i)
      if (lines_[i].endMiss2(V) <= std::pow(toleranceOf(lines_[i]), 2) && !lines_[i].isAboveHorizon(V))
        indices.push_back(i);
    return indices;
  }

  /// Residuals over their standard deviations.
  std::vector<double> normalised(const Eigen::Vector3d& direction, const std::vector<int>& used) const {
    const Eigen::Vector3d V = K_ * direction;
    std::vector<double> residuals;
    for (const int i : used)
      residuals.push_back(lines_[i].line.dot(V) / std::sqrt(lines_[i].residualVariance(V)));
    return residuals;
  }

  /// Robust scale of normalised residuals, not below 1: lines are not better than they say.
  static double robustScale(std::vector<double> residuals) {
    for (double& r : residuals) r = std::abs(r);
    return std::max(1.0, robustStddev(residuals));
  }

  /// One Gauss-Newton step on the sphere. information: of the direction along the tangents B.
  void step(Eigen::Vector3d& direction, const std::vector<int>& used, double cauchy_scale,
            Eigen::Matrix2d& information, Matrix32& B) const {
    const Eigen::Vector3d V = K_ * direction;
    B = tangents(direction);
    information.setZero();
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    for (const int i : used) {
      const double residual = lines_[i].line.dot(V), variance = lines_[i].residualVariance(V);
      const double u2 = residual * residual / variance / (cauchy_scale * cauchy_scale);
      const Eigen::Vector2d J = B.transpose() * (K_.transpose() * lines_[i].line);
      const double weight = 1 / (variance * (1 + u2));
      information += weight * J * J.transpose();
      gradient += weight * J * residual;
    }
    direction = (direction - B * information.ldlt().solve(gradient)).normalized();
  }

  Expected<VanishingPoint> fit(Eigen::Vector3d direction) const {
    Eigen::Matrix2d information;
    Matrix32 B;
    std::vector<int> used = passing(direction);
    double scale = 1;
    for (int iteration = 0; iteration < 8 && used.size() >= 2; ++iteration) {
      scale = robustScale(normalised(direction, used));
      step(direction, used, 2.385 * scale, information, B);
      if (!direction.allFinite()) return tl::unexpected(noVanishingPoint("%.0f lines are parallel", count()));
      used = passing(direction);
    }
    used = withinGate(direction, used, kGate * scale);
    const int n = static_cast<int>(used.size());
    if (n < std::max(parameters_.min_lines, 2))
      return tl::unexpected(
          noVanishingPoint("%.0f lines of at least %.0f meet in one point", n, parameters_.min_lines));
    constexpr double kNoRobustness = 1e6;
    for (int iteration = 0; iteration < 3; ++iteration) step(direction, used, kNoRobustness, information, B);
    if (const Failure failure = check(direction, used)) return tl::unexpected(failure);
    return describe(direction, used, information, B);
  }

  std::vector<int> withinGate(const Eigen::Vector3d& direction, const std::vector<int>& used,
                              double gate) const {
    const std::vector<double> residuals = normalised(direction, used);
    std::vector<int> kept;
    for (size_t k = 0; k < used.size(); ++k)
      if (std::abs(residuals[k]) <= gate) kept.push_back(used[k]);
    return kept;
  }

  Failure check(const Eigen::Vector3d& direction, const std::vector<int>& used) const {
    if (!direction.allFinite() || direction.z() <= 0 || !alongRunway(direction))
      return noVanishingPoint("%.0f lines meet, but not along the runway", static_cast<double>(used.size()));
    const double spread = directionSpread(used);
    if (spread < kMinSpread)
      return noVanishingPoint("lines are parallel within %.1f deg, less than %.1f", spread / kDegree,
                              kMinSpread / kDegree);
    const double coincidences = expectedCoincidences(direction, used);
    if (parameters_.min_lines > 2 && coincidences > kChance)
      return noVanishingPoint("as many lines meet by chance: %.0f of %.0f", static_cast<double>(used.size()),
                              count());
    return {};
  }

  /// Largest angle between the lines in the image: pi minus the widest gap between their directions.
  double directionSpread(const std::vector<int>& used) const {
    std::vector<double> angles;
    for (const int i : used) {
      const double angle = std::atan2(lines_[i].along.y(), lines_[i].along.x());
      angles.push_back(angle < 0 ? angle + M_PI : angle);
    }
    std::sort(angles.begin(), angles.end());
    double gap = angles.front() + M_PI - angles.back();
    for (size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
    return M_PI - gap;
  }

  /// How many meeting points as well supported as this one are expected of lines of random direction on the
  /// ground: pairs of lines that meet along the runway times (Chernoff's bound of) the probability that the
  /// other lines pass through. Each counts with -log of its own chance; those that say nothing are left out.
  double expectedCoincidences(const Eigen::Vector3d& direction, const std::vector<int>& used) const {
    const Eigen::Vector3d V = K_ * direction;
    std::vector<double> passing_by, others;  // chances
    for (int i = 0; i < count(); ++i) {
      const double p = chance(lines_[i], V, toleranceOf(lines_[i]));
      if (p > kLikely) continue;
      const bool passes = std::binary_search(used.begin(), used.end(), i);
      (passes ? passing_by : others).push_back(p);
    }
    if (passing_by.size() <= 2) return meetings_;
    const double lines = static_cast<double>(passing_by.size() + others.size());
    // Two lines always meet: the two that say most do not count.
    std::sort(passing_by.begin(), passing_by.end(), std::greater<double>());
    passing_by.resize(passing_by.size() - 2);
    double evidence = 0;
    for (const double p : passing_by) evidence -= std::log(p);
    others.insert(others.end(), passing_by.begin(), passing_by.end());
    double log_probability = 0;
    for (double lambda = 0.1; lambda < 1.05; lambda += 0.1) {
      double bound = -lambda * evidence;
      for (const double p : others) bound += std::log1p(p * (std::pow(p, -lambda) - 1));
      log_probability = std::min(log_probability, bound);
    }
    return std::min(meetings_, 0.5 * lines * (lines - 1)) * std::exp(log_probability);
  }

  Expected<VanishingPoint> describe(const Eigen::Vector3d& direction, const std::vector<int>& used,
                                    const Eigen::Matrix2d& information, const Matrix32& B) const {
    double chi2 = 0;
    for (const double r : normalised(direction, used)) chi2 += r * r;
    const double inflation = std::max(1.0, chi2 / std::max<double>(static_cast<double>(used.size()) - 2, 1));
    const Eigen::Matrix2d covariance = inflation * information.inverse();
    const double stddev =
        std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance).eigenvalues()[1]);
    if (!(stddev <= kMaxStddev))
      return tl::unexpected(
          noVanishingPoint("uncertain by %.1f deg, more than %.1f", stddev / kDegree, kMaxStddev / kDegree));
    VanishingPoint point;
    point.direction = direction;
    point.covariance = B * covariance * B.transpose();
    point.inliers.assign(lines_.size(), 0);
    for (const int i : used) point.inliers[i] = 1;
    point.inlier_count = static_cast<int>(used.size());
    return point;
  }

  std::vector<VanishingCandidate> lines_;
  Eigen::Matrix3d K_, Kinv_;
  const ApproachAngleParameters& parameters_;
  const Eigen::Vector3d* prior_normal_;
  std::vector<size_t> edge_;  // per line, the edge it is a piece of
  LineColumns columns_;
  std::vector<double> turns_;       // angle on the ground by which a line may turn, over its distance from V
  std::vector<double> impossible_;  // evidence against V of a line above its horizon
  std::vector<double> fit_;         // of one attempt
  std::vector<double> agreeing_;    // by edge
  Eigen::Vector2d horizon_;         // direction of the horizon in the image, unit
  double meetings_ = 0;             // pairs of lines that meet along the runway
};

}  // namespace

Expected<VanishingPoint> findVanishingPoint(const std::vector<LineSegment>& lines, const Eigen::Matrix3d& K,
                                            const ApproachAngleParameters& parameters,
                                            const Eigen::Vector3d* prior_normal) {
  return Search(lines, K, parameters, prior_normal).run();
}

Expected<VanishingPoint> fitVanishingPoint(const std::vector<LineSegment>& lines, const Eigen::Matrix3d& K,
                                           const ApproachAngleParameters& parameters,
                                           const std::vector<char>& members,
                                           const Eigen::Vector3d* prior_normal) {
  std::vector<int> used;
  for (size_t i = 0; i < members.size(); ++i)
    if (members[i] != 0) used.push_back(static_cast<int>(i));
  return Search(lines, K, parameters, prior_normal).fitTo(used);
}

}  // namespace uav_landing
