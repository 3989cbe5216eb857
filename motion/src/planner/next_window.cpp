#include "planner/next_window.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "gives_way.hpp"
#include "time_law/law_check.hpp"
#include "time_law/window.hpp"

namespace rmac {
namespace {

constexpr double kShortest_mm = 1.0;
/// The last ramps brake for an end that the next window takes away: they are planned again.
constexpr double kRampsPlannedAgain = 2;

/// However many nodes a window has, it is not shorter than these ramps from the speed at its begin.
constexpr double kRampsAtLeast = 4;

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

/// Counts the nodes of a segment behind s; the place of the one that is too many, if that is there.
double place_of_many(const LaidPath& path, std::size_t segment, double s, std::size_t most, std::size_t& nodes) {
  for (const double local : path.segment(segment)->nodes()) {
    const double place = path.start(segment) + local;
    if (place > s && ++nodes >= most) return place;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

WindowEnd next_window_end(LaidPath& path, const std::vector<JointLimits>& joints, const PathState& from, double ramps,
                          double factor, std::optional<double> limit_s, std::size_t most_nodes) {
  const double s = from.s;
  Ramp weakest;
  double fastest = 0;
  for (const JointLimits& joint : joints) {
    weakest.limit(joint);
    fastest = std::max(fastest, joint.max_speed);
  }
  std::optional<WindowEnd> found;
  const std::uint64_t work = path.work();
  const auto supply = [&] { return path.work() == work && path.supply(); };
  double v = 0, reach = kShortest_mm;
  // Where the path bends to and fro, full speed is far away.
  const double least = s + kRampsAtLeast * weakest.length(from.v);
  std::size_t nodes = 0;
  double s_many = std::numeric_limits<double>::infinity();
  const std::size_t first = path.view().find(s + kSamePlace, 1);
  for (std::size_t i = first; !found; ++i) {
    if (i >= path.size() && !supply()) break;
    if (i > first && path.rest_after(i - 1)) {  // what follows it came only now, as from a gate that was waited for
      found = WindowEnd{path.end(i - 1), true};
      break;
    }
    v = std::max(v, std::min(path.segment(i)->demand().feed_mm_s * std::max(factor, 1.0), 2 * fastest));
    reach = std::max(reach, ramps * weakest.length(v));
    if (nodes < most_nodes) s_many = place_of_many(path, i, std::max(s, least), most_nodes, nodes);
    const bool enough = path.end(i) - s > 2 * reach || nodes >= most_nodes;
    // Whether the path goes on without rest is known once its next segment is there.
    if (i + 1 == path.size() && !path.rest_after(i) && !enough) supply();
    if (path.rest_after(i) || enough) found = WindowEnd{path.end(i), path.rest_after(i)};
  }
  WindowEnd end = found.value_or(WindowEnd{path.end(), false, 0, path.can_supply()});
  end.in_work = end.in_work || path.work() != work;
  const auto sooner = [&end](double at, bool hard) { end = {at, hard, 0, end.in_work}; };
  if (limit_s && *limit_s <= end.s) sooner(*limit_s, true);
  if (end.s - s > 1.5 * reach) sooner(s + reach, false);
  if (end.s > s_many) sooner(s_many, false);
  end.planned_again = reach / ramps * kRampsPlannedAgain;
  return end;
}

std::optional<std::vector<LawPiece>> law_from_rest(const PathView& path, const std::vector<JointLimits>& joints,
                                                   double s, WindowEnd& end, const FeedRule& feed,
                                                   std::size_t attempt) {
  constexpr std::array<double, kAttemptsFromRest> kParts{1, 0.5, 0.2, 0.07, 0.021};
  const double nearer = s + kParts[attempt] * (end.s - s);
  if (attempt > 0) end = {nearer, false, end.planned_again};
  if (attempt == 0 || nearer - s >= 100 * kSamePlace) {
    long work_left = kMostWorkOnLaw;
    if (auto law = plan_window(path, joints, {{s, 0, 0}, end.s, feed, nullptr, false, true, &work_left})) return law;
  }
  if (attempt + 1 < kAttemptsFromRest || gives_way()) return std::nullopt;
  auto law = cautious_law(path, joints, s, end.s, feed);
  if (check_law(path, joints, law, nullptr).worst <= 1.0) return law;
  return std::nullopt;
}

}  // namespace rmac
