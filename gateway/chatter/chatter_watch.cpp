#include "gateway/chatter/chatter_watch.hpp"

#include <algorithm>
#include <cmath>

namespace rmac::gateway {
namespace {

/// How steady a cut is to be at a speed that is proposed, and how far that may be from the one that it has.
constexpr double kSteadyShare = 1.1;
constexpr int kMostPercent = 60;

/// What the mean over a turn leaves out is told from half of it on.
constexpr double kUneven = 0.5;
/// A cut that bears so many times what it takes by the mean is steady all the same.
constexpr double kFarFromIt = 4;

/// Two cuts are the same where they differ by no more.
constexpr double kSame = 0.02;
/// A speed is looked for again where a cut has become worse by as much.
constexpr double kWorse = 0.9;

double tooth_period_s(const ChatterWatch::Look& look, double rpm) {
  return 60 / (rpm * look.teeth);
}

/// How far the chips' change in a moment is off its mean, as a share of that.
double unevenness_of(const ChatterWatch::Look& look) {
  double most = 0;
  for (const Eigen::Matrix3d& each : look.over_pitch_n_mm) most = std::max(most, (each - look.cutting_n_mm).norm());
  return most / look.cutting_n_mm.norm();
}

/// The nearest speed at which a cut is steady.
std::optional<double> steady_rpm(const ChatterWatch::Look& look, const CutStability& by_mean,
                                 const CutInTime* in_time) {
  // In time each takes milliseconds: the nearest ones, then others.
  const auto next = [&](int percent) { return percent + (in_time != nullptr ? std::max(1, percent / 3) : 1); };
  for (int percent = 1; percent <= kMostPercent; percent = next(percent)) {
    for (const int sign : {1, -1}) {
      const double rpm = std::round(look.rpm * (1 + sign * percent / 100.0));
      if (rpm < 1 || rpm == look.rpm || (look.most_rpm > 0 && rpm > look.most_rpm)) continue;
      const double period_s = tooth_period_s(look, rpm);
      // What the mean says is far off is not tried in time.
      if (by_mean.at(period_s).share < (in_time != nullptr ? kSteadyShare / 2 : kSteadyShare)) continue;
      if (in_time == nullptr) return rpm;
      if (in_time->can_tell(kSteadyShare, period_s) && !in_time->grows(kSteadyShare, period_s)) return rpm;
    }
  }
  return std::nullopt;
}

bool same(double a, double b) {
  return std::abs(a - b) <= kSame * std::abs(b);
}

}  // namespace

double ChatterWatch::ratio_in_time(const Look& look, double unevenness, double by_mean, const CutInTime& cut) {
  const bool known =
      look.rpm == in_time_.rpm && same(by_mean, in_time_.by_mean) && same(unevenness, in_time_.unevenness);
  if (known) return in_time_.ratio;
  const double limit = cut.limit(by_mean, tooth_period_s(look, look.rpm));
  in_time_ = {.by_mean = by_mean, .unevenness = unevenness, .rpm = look.rpm, .ratio = limit / by_mean};
  return in_time_.ratio;
}

void ChatterWatch::add(const Look& look, std::span<const VibrationMode> modes) {
  double strongest = look.cutting_n_mm.norm();
  for (const Eigen::Matrix3d& each : look.over_pitch_n_mm) strongest = std::max(strongest, each.norm());
  const double bound = CutStability::least_share(strongest, modes);
  if (bound > 1 && bound > least_) return;  // it tells nothing new
  const CutStability stability(look.cutting_n_mm, modes);
  ChatterLimit limit = stability.at(tooth_period_s(look, look.rpm));
  const double unevenness = unevenness_of(look);
  const CutInTime cut(look.over_pitch_n_mm, modes);
  const bool in_time =
      unevenness > kUneven && limit.share < kFarFromIt && cut.can_tell(limit.share, tooth_period_s(look, look.rpm));
  if (in_time) limit.share *= ratio_in_time(look, unevenness, limit.share, cut);
  least_ = std::min(least_, limit.share);
  if (limit.share >= 1) return;
  const bool goes_on = !found_.empty() && found_.back().move_id == look.move_id && found_.back().line == look.line;
  if (!goes_on) {
    if (found_.size() == kMost) return;
    proposed_at_ = std::numeric_limits<double>::infinity();
    found_.push_back({.line = look.line,
                      .move_id = look.move_id,
                      .t_s = look.t_s,
                      .share = std::numeric_limits<double>::infinity()});
  }
  Chatter& chatter = found_.back();
  chatter.until_s = look.t_s;
  if (limit.share >= chatter.share) return;
  chatter.share = limit.share, chatter.frequency_hz = limit.frequency_hz;
  chatter.most_t_s = look.t_s, chatter.place = look.place, chatter.rpm = look.rpm;
  if (limit.share > kWorse * proposed_at_) return;
  proposed_at_ = limit.share;
  chatter.steady_rpm = steady_rpm(look, stability, in_time ? &cut : nullptr);
}

}  // namespace rmac::gateway
