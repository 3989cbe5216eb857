#include "time_law/law_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace rmac {
namespace {

constexpr std::size_t kSamples = 17;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What a joint asks of one of its limits at equidistant instants of a piece, as parts of the limit.
using Demand = std::array<double, kSamples>;

struct Peak {
  double largest = 0;
  double unevenness = 0;  ///< largest third difference: what a parabola does not see
};

/// Of every `stride`th sample, where between them the curve is taken for the parabola through three neighbours, so that
/// a peak between samples counts.
Peak peak_of(const Demand& demand, std::size_t stride) {
  Peak peak{std::max(std::abs(demand.front()), std::abs(demand.back())), 0};
  double bend_before = 0;
  for (std::size_t i = stride; i + stride < kSamples; i += stride) {
    const double here = demand[i], rise = (demand[i + stride] - demand[i - stride]) / 2;
    const double bend = demand[i + stride] - 2 * here + demand[i - stride];
    const bool inside = here > 0 ? bend < 0 : bend > 0;
    const double vertex = inside && std::abs(rise) < std::abs(bend) ? here - rise * rise / (2 * bend) : here;
    peak.largest = std::max(peak.largest, std::abs(vertex));
    if (i > stride) peak.unevenness = std::max(peak.unevenness, std::abs(bend - bend_before));
    bend_before = bend;
  }
  return peak;
}

/// Of the third difference of the samples, what is added for doubt: an error of the parabola is a sixteenth of it where
/// the next difference is small, which it is not everywhere. With a quarter, one stop in 10 000 went over a limit by
/// 0.09 %.
constexpr double kDoubt = 0.5;

class PieceCheck {
 public:
  PieceCheck(const PathView& path, const std::vector<JointLimits>& joints, const FeedRule* feed)
      : path_(path), joints_(joints), feed_(feed) {}

  /// Samples are halved until what lies between them cannot matter: five, nine, seventeen.
  double worst(const LawPiece& piece) {
    s_begin_ = piece.start.s;
    s_end_ = piece.at(piece.duration).s;
    others_ = 0;
    for (std::size_t stride = 4;; stride /= 2) {
      for (std::size_t i = 0; i < kSamples; i += stride) {
        if ((stride == 4 || i % (2 * stride) != 0) && !sample(piece, i)) return kInfinity;
      }
      double worst = others_;
      bool sure = true;
      for (std::size_t j = 0; j < joints_.size(); ++j) {
        for (const Demand* demand : {&speed_[j], &acceleration_[j], &jerk_[j]}) {
          const Peak peak = peak_of(*demand, stride);
          worst = std::max(worst, peak.largest);
          sure = sure && peak.largest + kDoubt * peak.unevenness <= 1;
        }
      }
      if (!std::isfinite(worst)) return kInfinity;
      if (sure || stride == 1) return worst;
    }
  }

 private:
  bool sample(const LawPiece& piece, std::size_t i) {
    const PathState at = piece.at(piece.duration * static_cast<double>(i) / (kSamples - 1));
    const double path_jerk = piece.kind == LawPiece::Kind::Jerk ? piece.slope : piece.slope * at.v;
    const bool last = i + 1 == kSamples;
    const double s = i == 0 ? just_inside(s_begin_, s_end_) : last ? just_inside(s_end_, s_begin_) : at.s;
    const int side = last ? -1 : 1;
    if (segment_ == nullptr || s < segment_start_ || s > segment_start_ + segment_->length()) {
      const std::size_t index = path_.find(s, side);
      segment_ = &path_.segment(index);
      segment_start_ = path_.start(index);
    }
    const double on_segment = std::clamp(s - segment_start_, 0.0, segment_->length());
    if (!(at.v >= -1e-9) || segment_->derivatives(on_segment, side, point_) != KinematicsStatus::Ok) return false;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const double d1 = point_.d[1][j], d2 = point_.d[2][j], d3 = point_.d[3][j], v = at.v;
      speed_[j][i] = d1 * v / joints_[j].max_speed;
      acceleration_[j][i] = (d2 * v * v + d1 * at.a) / joints_[j].max_acceleration;
      jerk_[j][i] = (d3 * v * v * v + 3 * d2 * v * at.a + d1 * path_jerk) / joints_[j].max_jerk;
    }
    const PathDemand& demand = segment_->demand();
    others_ = std::max(
        {others_, at.a / or_unbounded(demand.accel_rise_mm_s2), -at.a / or_unbounded(demand.accel_fall_mm_s2)});
    if (feed_ != nullptr) others_ = std::max(others_, at.v / (feed_->bound(*segment_) * 1.0005));
    return true;
  }

  const PathView& path_;
  const std::vector<JointLimits>& joints_;
  const FeedRule* feed_;
  double others_ = 0;  ///< what the path itself demands, of its bounds
  double s_begin_ = 0, s_end_ = 0;
  const PathSegment* segment_ = nullptr;  ///< of the sample before: nearly always that of the next one too
  double segment_start_ = 0;
  std::array<Demand, kMaxJoints> speed_, acceleration_, jerk_;
  JointPoint point_;
};

}  // namespace

LawExcess check_law(const PathView& path, const std::vector<JointLimits>& joints, const std::vector<LawPiece>& law,
                    const FeedRule* feed) {
  LawExcess excess;
  excess.by_piece.reserve(law.size());
  PieceCheck check(path, joints, feed);
  for (const LawPiece& piece : law) {
    excess.by_piece.push_back(check.worst(piece));
    excess.worst = std::max(excess.worst, excess.by_piece.back());
    if (!std::isfinite(excess.worst)) break;
  }
  return excess;
}

}  // namespace rmac
