#include "planner/next_window.hpp"

#include <algorithm>
#include <limits>

#include "time_law/law_check.hpp"
#include "time_law/window.hpp"

namespace rmac {
namespace {

constexpr double kShortest_mm = 1.0;
/// The last ramps brake for an end that the next window takes away: they are planned again.
constexpr double kRampsPlannedAgain = 2;

/// Bounds of acceleration and jerk in which the weakest joint rules.
struct Ramp {
  double acceleration = std::numeric_limits<double>::infinity();
  double jerk = std::numeric_limits<double>::infinity();

  void limit(const JointLimits& joint) {
    acceleration = std::min(acceleration, joint.max_acceleration);
    jerk = std::min(jerk, joint.max_jerk);
  }
  [[nodiscard]] double length(double v) const { return ramp_length(v, acceleration, jerk); }
};

}  // namespace

WindowEnd next_window_end(LaidPath& path, const std::vector<JointLimits>& joints, double s, double ramps, double factor,
                          std::optional<double> limit_s) {
  Ramp weakest;
  double fastest = 0;
  for (const JointLimits& joint : joints) {
    weakest.limit(joint);
    fastest = std::max(fastest, joint.max_speed);
  }
  std::optional<WindowEnd> found;
  double v = 0, reach = kShortest_mm;
  for (std::size_t i = path.view().find(s + kSamePlace, 1); !found; ++i) {
    if (i >= path.size() && !path.supply()) break;
    v = std::max(v, std::min(path.segment(i)->demand().feed_mm_s * std::max(factor, 1.0), 2 * fastest));
    reach = std::max(reach, ramps * weakest.length(v));
    const bool enough = path.end(i) - s > 2 * reach;
    // Whether the path goes on without rest is known once its next segment is there.
    if (i + 1 == path.size() && !path.rest_after(i) && !enough) path.supply();
    if (path.rest_after(i) || enough) found = WindowEnd{path.end(i), path.rest_after(i)};
  }
  WindowEnd end = found.value_or(WindowEnd{path.end(), false});
  if (limit_s && *limit_s <= end.s) end = {*limit_s, true};
  if (end.s - s > 1.5 * reach) end = {s + reach, false};
  end.planned_again = reach / ramps * kRampsPlannedAgain;
  return end;
}

std::optional<std::vector<LawPiece>> law_from_rest(const PathView& path, const std::vector<JointLimits>& joints,
                                                   double s, WindowEnd& end, const FeedRule& feed) {
  const auto law_to = [&](double s_end) {
    return plan_window(path, joints, {{s, 0, 0}, s_end, feed, nullptr, false, true});
  };
  if (auto law = law_to(end.s)) return law;
  for (const double part : {0.5, 0.4, 0.35, 0.3}) {
    const double nearer = s + part * (end.s - s);
    if (nearer - s < 100 * kSamePlace) break;
    end = {nearer, false, end.planned_again};
    if (auto law = law_to(end.s)) return law;
  }
  auto law = cautious_law(path, joints, s, end.s, feed);
  if (check_law(path, joints, law, nullptr).worst <= 1.0) return law;
  return std::nullopt;
}

}  // namespace rmac
