#include "planner/published_plans.hpp"

#include <algorithm>
#include <iterator>

namespace rmac {

bool PublishedPlans::refused(const ServoProgress& progress) const noexcept {
  return base() != nullptr && progress.last_refused == base()->plan->id;
}

bool PublishedPlans::acknowledged(const ServoProgress& progress) const noexcept {
  return base() == nullptr || progress.accepted_plan >= base()->plan->id || refused(progress);
}

bool PublishedPlans::ended(const ServoProgress& progress) const noexcept {
  if (base() == nullptr) return true;
  return acknowledged(progress) && !refused(progress) && now_s(*base(), progress.cycle) >= base()->plan->end_time_s;
}

void PublishedPlans::go_on_from_base(Plan& plan, const ServoProgress& progress) const noexcept {
  if (!acknowledged(progress)) plan.latest_cycle = std::min(plan.latest_cycle, base()->plan->latest_cycle);
}

bool PublishedPlans::publish(std::unique_ptr<Plan> plan, PublishedPlan about) {
  plan->id = next_id_;
  plan->departures = departures_;
  about.law = plan->law;
  about.plan = std::move(plan);
  if (!channel_.published.push(about.plan.get())) return false;
  ++next_id_;
  alive_.push_back(std::move(about));
  if (base()->purpose.stops) tell_stop();
  return true;
}

void PublishedPlans::base_stops(int better_tries) {
  base()->purpose = {true, better_tries};
  tell_stop();
}

/// The first of the stops that follow each other: those behind it are better ones, and it may be under way still.
void PublishedPlans::tell_stop() noexcept {
  std::size_t first = alive_.size();
  while (first > 0 && alive_[first - 1].purpose.stops) --first;
  channel_.stopping.store(first < alive_.size() ? alive_[first].plan->id : 0, std::memory_order_release);
}

void PublishedPlans::commanded(bool stop) noexcept {
  // A stop that is under way still, though something else was commanded meanwhile, is the one that is asked for.
  if (stop) {
    tell_stop();
  } else {
    channel_.stopping.store(0, std::memory_order_release);
  }
}

void PublishedPlans::tell_limit(HorizonLimit limit) noexcept {
  channel_.horizon.tell(base() == nullptr ? 0 : base()->plan->id, limit);
}

void PublishedPlans::collect() {
  const Plan* plan = nullptr;
  while (channel_.retired.pop(plan)) {
    for (auto* plans : {&alive_, &abandoned_})
      std::erase_if(*plans, [&](const PublishedPlan& p) { return p.plan.get() == plan; });
  }
}

void PublishedPlans::move_origin(double distance_mm) {
  for (PublishedPlan& p : alive_) p.move_origin(distance_mm);
}

void PublishedPlans::abandon(const PathDeparture& departure) {
  departures_ = departure.count;
  std::move(alive_.begin(), alive_.end(), std::back_inserter(abandoned_));
  alive_.clear();
}

const PublishedPlan* PublishedPlans::find(std::uint64_t id) const noexcept {
  const auto found =
      std::find_if(alive_.begin(), alive_.end(), [&](const PublishedPlan& p) { return p.plan->id == id; });
  return found == alive_.end() ? nullptr : &*found;
}

}  // namespace rmac
