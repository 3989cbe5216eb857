#include "gateway/chatter/chatter_watch.hpp"

#include <algorithm>

namespace rmac::gateway {
namespace {

/// How steady a cut is to be at a speed that is proposed, and how far that may be from the one that it has.
constexpr double kSteadyShare = 1.1;
constexpr int kMostPercent = 60;

double tooth_period_s(const ChatterWatch::Look& look, double rpm) {
  return 60 / (rpm * look.teeth);
}

std::optional<double> steady_rpm(const CutStability& stability, const ChatterWatch::Look& look) {
  for (int percent = 1; percent <= kMostPercent; ++percent) {
    for (const int sign : {1, -1}) {
      const double rpm = look.rpm * (1 + sign * percent / 100.0);
      if (look.most_rpm > 0 && rpm > look.most_rpm) continue;
      if (stability.at(tooth_period_s(look, rpm)).share >= kSteadyShare) return rpm;
    }
  }
  return std::nullopt;
}

}  // namespace

void ChatterWatch::add(const Look& look, std::span<const VibrationMode> modes) {
  const double bound = CutStability::least_share(look.cutting_n_mm, modes);
  if (bound > 1 && bound > least_) return;  // it tells nothing new
  const CutStability stability(look.cutting_n_mm, modes);
  const ChatterLimit limit = stability.at(tooth_period_s(look, look.rpm));
  least_ = std::min(least_, limit.share);
  if (limit.share >= 1) return;
  const bool goes_on = !found_.empty() && found_.back().move_id == look.move_id && found_.back().line == look.line;
  if (!goes_on) {
    if (found_.size() == kMost) return;
    found_.push_back({.line = look.line,
                      .move_id = look.move_id,
                      .t_s = look.t_s,
                      .share = std::numeric_limits<double>::infinity()});
  }
  Chatter& chatter = found_.back();
  chatter.until_s = look.t_s;
  if (limit.share >= chatter.share) return;
  chatter.share = limit.share, chatter.frequency_hz = limit.frequency_hz;
  chatter.place = look.place, chatter.rpm = look.rpm;
  chatter.steady_rpm = steady_rpm(stability, look);
}

}  // namespace rmac::gateway
