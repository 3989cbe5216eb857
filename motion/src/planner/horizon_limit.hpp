#pragma once

#include "planner/published_plan.hpp"
#include "planner/route.hpp"
#include "rmac/motion/follower/horizon.hpp"
#include "rmac/motion/planner.hpp"

namespace rmac {

/// What the planner is told to do.
struct Commanded {
  PathCommand command = PathCommand::Stop;
  double override_factor = 1;
  double limit_s = 0;         ///< path length at which RunOne ends
  bool rest_follows = false;  ///< behind what is queued comes what needs the machine at rest
};

/// Why nothing is planned beyond path length `planned_to` of the path that is travelled; never `Enough`, for that is a
/// question of time. `under_way`: the plan that leads there; nullptr where the machine rests.
[[nodiscard]] HorizonLimit horizon_limit(const Route& route, const Commanded& commanded, double planned_to,
                                         const PublishedPlan* under_way);

}  // namespace rmac
