#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "planner/published_plan.hpp"
#include "rmac/motion/plan_channel.hpp"
#include "rmac/motion/planner.hpp"

namespace rmac {

/// The plans that the servo loop follows, or may still take over, and their way there and back. Planner thread.
class PublishedPlans {
 public:
  PublishedPlans(PlanChannel& channel, double period_s) : channel_(channel), period_s_(period_s) {}

  /// The last one published, which what is planned next is based on; null before the first, and once the path was left.
  [[nodiscard]] const PublishedPlan* base() const noexcept { return alive_.empty() ? nullptr : &alive_.back(); }
  [[nodiscard]] PublishedPlan* base() noexcept { return alive_.empty() ? nullptr : &alive_.back(); }

  [[nodiscard]] double now_s(const PublishedPlan& plan, std::int64_t cycle) const noexcept {
    return static_cast<double>(cycle - plan.plan->start_cycle) * period_s_;
  }
  /// The base, which never acts then: it is the base until it is collected.
  [[nodiscard]] bool refused(const ServoProgress& progress) const noexcept;
  [[nodiscard]] bool acknowledged(const ServoProgress& progress) const noexcept;
  /// Everything that was published has come to its end.
  [[nodiscard]] bool ended(const ServoProgress& progress) const noexcept;

  /// A plan that goes on from the base: one that has not been taken over yet may still be refused.
  void go_on_from_base(Plan& plan, const ServoProgress& progress) const noexcept;
  /// Hands a plan over; false when the servo loop does not take it, for it stands still or is gone. Of `about` all but
  /// plan and law are given.
  bool publish(std::unique_ptr<Plan> plan, PublishedPlan about);
  /// The base ends as a stop asks, at its end.
  void base_stops(int better_tries);
  /// A stop is commanded, or something else.
  void commanded(bool stop) noexcept;
  /// Why nothing is planned beyond the base, as it is now.
  void tell_limit(HorizonLimit limit) noexcept;
  /// Frees what the servo loop is through with.
  void collect();
  void move_origin(double distance_mm);

  /// The servo loop left the path, and follows none of these any more.
  void abandon(const PathDeparture& departure);
  /// That plan, unless it is known no more.
  [[nodiscard]] const PublishedPlan* find(std::uint64_t id) const noexcept;
  /// Departures that are known.
  [[nodiscard]] std::uint64_t departures() const noexcept { return departures_; }

 private:
  void tell_stop() noexcept;

  PlanChannel& channel_;
  double period_s_;
  std::vector<PublishedPlan> alive_;      ///< in order of publication
  std::vector<PublishedPlan> abandoned_;  ///< when the path was left; still the follower's
  std::uint64_t departures_ = 0;
  std::uint64_t next_id_ = 1;
};

}  // namespace rmac
