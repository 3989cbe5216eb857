#include "time_law/law_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "time_law/law_problem.hpp"

namespace rmac {
namespace {

constexpr std::size_t kSamples = 17;
/// As a part of a piece: no derivative differs between places that are nearer.
constexpr double kSamePlace = 1e-7;

/// What a joint asks of one of its limits at equidistant instants of a piece, as parts of the limit.
using Demand = std::array<double, kSamples>;

struct Peak {
  double largest = 0;
  double at = 0;          ///< the sample where it is, and part of the way to the next
  double unevenness = 0;  ///< largest third difference: what a parabola does not see
};

/// The peak over every `stride`th sample. Between them the curve is taken for the parabola through three neighbours, so
/// that a peak between samples counts.
Peak peak_of(const Demand& demand, std::size_t stride) {
  Peak peak;
  const auto take = [&peak](double value, double at) {
    if (!(std::abs(value) > peak.largest)) return;
    peak.largest = std::abs(value);
    peak.at = at;
  };
  take(demand.front(), 0);
  take(demand.back(), kSamples - 1);
  double bend_before = 0;
  for (std::size_t i = stride; i + stride < kSamples; i += stride) {
    const double here = demand[i], rise = (demand[i + stride] - demand[i - stride]) / 2;
    const double bend = demand[i + stride] - 2 * here + demand[i - stride];
    const bool inside = here > 0 ? bend < 0 : bend > 0;
    const double ahead = inside && std::abs(rise) < std::abs(bend) ? -rise / bend : 0;
    take(here + ahead * rise / 2, static_cast<double>(i) + ahead * static_cast<double>(stride));
    if (i > stride) peak.unevenness = std::max(peak.unevenness, std::abs(bend - bend_before));
    bend_before = bend;
  }
  return peak;
}

/// The part of the samples' third difference that is added for doubt: an error of the parabola is a sixteenth of it
/// where the next difference is small, which it is not everywhere. With a quarter, one stop in 10 000 went over a limit
/// by 0.09 %.
constexpr double kDoubt = 0.5;
/// And of that of all samples: between two of them may lie a kink, where the tables of arc length meet.
constexpr double kKink = 0.25;

class PieceCheck {
 public:
  PieceCheck(const PathView& path, const std::vector<JointLimits>& joints, const FeedRule* feed)
      : path_(path), joint_count_(joints.size()), feed_(feed) {
    for (std::size_t j = 0; j < joint_count_; ++j)
      per_limit_[j] = {1 / joints[j].max_speed, 1 / joints[j].max_acceleration, 1 / joints[j].max_jerk};
  }

  struct Worst {
    double part = 0;             ///< of the bound that is exceeded most, or nearest to be
    std::optional<double> peak;  ///< where between the piece's ends a joint's acceleration or jerk is over its bound
  };

  /// Samples are halved until what lies between them cannot matter: five, nine, seventeen.
  Worst worst(const LawPiece& piece) {
    end_ = piece.at(piece.duration);
    others_ = 0;
    for (std::size_t stride = 4;; stride /= 2) {
      for (std::size_t i = 0; i < kSamples; i += stride) {
        if ((stride == 4 || i % (2 * stride) != 0) && !sample(piece, i)) return {kInfinity, {}};
      }
      double worst = others_;
      bool sure = true;
      for (std::size_t j = 0; j < joint_count_; ++j) {
        for (const Demand* demand : {&speed_[j], &acceleration_[j], &jerk_[j]}) {
          const Peak peak = peak_of(*demand, stride);
          worst = std::max(worst, peak.largest + (stride == 1 ? kKink * peak.unevenness : 0));
          sure = sure && peak.largest + kDoubt * peak.unevenness <= 1;
        }
      }
      if (!std::isfinite(worst)) return {kInfinity, {}};
      if (sure) return {worst, {}};
      if (stride == 1) return {worst, worst > 1 ? peak_within(piece) : std::nullopt};
    }
  }

 private:
  /// From all samples.
  [[nodiscard]] std::optional<double> peak_within(const LawPiece& piece) const {
    Peak most{1, 0, 0};
    for (std::size_t j = 0; j < joint_count_; ++j) {
      for (const Demand* demand : {&acceleration_[j], &jerk_[j]}) {
        const Peak peak = peak_of(*demand, 1);
        if (peak.largest > most.largest) most = peak;
      }
    }
    if (!(most.at > 0) || !(most.at < kSamples - 1)) return std::nullopt;
    return piece.at(piece.duration * most.at / (kSamples - 1)).s;
  }

  bool sample(const LawPiece& piece, std::size_t i) {
    const bool first = i == 0, last = i + 1 == kSamples;
    const PathState at = first  ? piece.start
                         : last ? end_
                                : piece.at(piece.duration * static_cast<double>(i) / (kSamples - 1));
    if (!(at.v >= -1e-9)) return false;
    const double path_jerk = piece.kind == LawPiece::Kind::Jerk ? piece.slope : piece.slope * at.v;
    const double s = first ? just_inside(at.s, end_.s) : last ? just_inside(at.s, piece.start.s) : at.s;
    const int side = last ? -1 : 1;
    if (segment_ == nullptr || s < segment_start_ || s > segment_start_ + segment_->length()) enter_segment(s, side);
    const bool known = first && std::abs(at.s - end_point_s_) <= kSamePlace * (end_.s - at.s);
    JointPoint& point = last || known ? end_point_ : point_;
    const double on_segment = std::clamp(s - segment_start_, 0.0, segment_->length());
    if (!known && segment_->derivatives(on_segment, side, point) != KinematicsStatus::Ok) return false;
    if (last) end_point_s_ = segment_->curve().breaks().empty() ? at.s : kInfinity;
    for (std::size_t j = 0; j < joint_count_; ++j) {
      const double d1 = point.d[1][j], d2 = point.d[2][j], d3 = point.d[3][j], v = at.v;
      speed_[j][i] = d1 * v * per_limit_[j][0];
      acceleration_[j][i] = (d2 * v * v + d1 * at.a) * per_limit_[j][1];
      jerk_[j][i] = (d3 * v * v * v + 3 * d2 * v * at.a + d1 * path_jerk) * per_limit_[j][2];
    }
    others_ = std::max({others_, at.a * per_rise_, -at.a * per_fall_, at.v * per_feed_});
    return true;
  }

  void enter_segment(double s, int side) {
    const std::size_t index = path_.find(s, side);
    segment_ = &path_.segment(index);
    segment_start_ = path_.start(index);
    end_point_s_ = kInfinity;
    const PathDemand& demand = segment_->demand();
    per_rise_ = 1 / or_unbounded(demand.accel_rise_mm_s2);
    per_fall_ = 1 / or_unbounded(demand.accel_fall_mm_s2);
    per_feed_ = feed_ != nullptr ? 1 / (feed_->bound(*segment_) * 1.0005) : 0;
  }

  const PathView& path_;
  std::size_t joint_count_;
  std::array<std::array<double, 3>, kMaxJoints> per_limit_;  ///< inverse bounds of speed, acceleration and jerk
  const FeedRule* feed_;
  double others_ = 0;                     ///< what the path itself demands, of its bounds
  PathState end_;                         ///< of the piece
  const PathSegment* segment_ = nullptr;  ///< of the sample before: nearly always that of the next one too
  double segment_start_ = 0;
  double per_rise_ = 0, per_fall_ = 0, per_feed_ = 0;  ///< inverse bounds there
  std::array<Demand, kMaxJoints> speed_, acceleration_, jerk_;
  JointPoint point_;
  /// At the end of the piece before, and where that is: derivatives at the next one's begin too, where they do not
  /// jump.
  JointPoint end_point_;
  double end_point_s_ = kInfinity;
};

}  // namespace

LawExcess check_law(const PathView& path, const std::vector<JointLimits>& joints, const std::vector<LawPiece>& law,
                    const FeedRule* feed) {
  LawExcess excess;
  excess.by_piece.reserve(law.size());
  excess.peaks.reserve(law.size());
  PieceCheck check(path, joints, feed);
  for (const LawPiece& piece : law) {
    const auto [part, peak] = check.worst(piece);
    excess.by_piece.push_back(part);
    excess.peaks.push_back(peak);
    excess.worst = std::max(excess.worst, part);
    if (!std::isfinite(excess.worst)) break;
  }
  return excess;
}

}  // namespace rmac
