#include "planner/horizon_limit.hpp"

namespace rmac {

HorizonLimit horizon_limit(const Route& route, const Commanded& commanded, double planned_to,
                           const PublishedPlan* under_way) {
  if (commanded.command == PathCommand::Stop || route.beside()) return HorizonLimit::Stop;
  // An override of 0 is obeyed by a stop.
  if (commanded.override_factor <= 0) return HorizonLimit::Override;
  if (under_way != nullptr && under_way->purpose.stops) return HorizonLimit::Stop;
  const bool back = commanded.command == PathCommand::Retrace;
  if (route.retraces() != back) return back ? HorizonLimit::Stop : HorizonLimit::Rest;  // it turns round at rest
  // Nothing is added to what only brakes for another override, or was planned for another one.
  if (under_way != nullptr &&
      (under_way->override_factor != commanded.override_factor || under_way->purpose.better_tries > 0))
    return HorizonLimit::Override;
  const bool one = commanded.command == PathCommand::RunOne && !route.on_detour();
  if (one && planned_to >= commanded.limit_s - kSamePlace) return HorizonLimit::Rest;
  const LaidPath& path = route.path();
  if (planned_to < path.end() - kSamePlace || path.can_supply()) return HorizonLimit::Planning;
  if (route.on_detour()) return HorizonLimit::Rest;
  if (path.gate.blocked()) return HorizonLimit::Rest;
  if (path.has_more()) return HorizonLimit::HeldBack;
  return commanded.rest_follows ? HorizonLimit::Rest : HorizonLimit::Queue;
}

}  // namespace rmac
