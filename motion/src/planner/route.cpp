#include "planner/route.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rmac/motion/path_builder.hpp"

namespace rmac {

double Route::on_forward(double s) const noexcept {
  if (!detour_) return s;
  return detour_->retraces ? detour_->place - std::max(s - detour_->meets_at, 0.0) : detour_->place;
}

void Route::take(Detour detour) {
  detour_ = std::move(detour);
  turn_to(detour_->path.begin());
}

Expected<double> Route::turn_back(double s, double distance, const WayBack& way) {
  if (rejoins()) leave(s);
  const double place = beside_ ? *turned_to_ : on_forward(s);
  LaidPath back = forward.backward(place, distance);
  if (back.size() == 0) return 0;
  const double begin = back.begin(), length = back.end() - begin;
  return away(way).map([&](const PathSegments& segments) {
    back.lead_in(segments);
    take({std::move(back), true, begin, place});
    beside_ = false;
    return length;
  });
}

Expected<> Route::rejoin(const WayBack& way) {
  if (!beside_) return {};
  return away(way).map([&](const PathSegments& segments) {
    if (!segments.empty()) {
      LaidPath to = forward.place(*turned_to_);
      to.lead_in(segments);
      take({std::move(to), false, *turned_to_, *turned_to_});
    }
    beside_ = false;
  });
}

Expected<PathSegments> Route::away(const WayBack& way) const {
  const auto place = beside_ ? forward.place_at(*turned_to_) : std::nullopt;
  if (!place) return PathSegments{};
  PathBuilder builder(way.model);
  builder.restart(place->joints, forward.map_at(*turned_to_)->frames());
  Move move;
  move.id = place->move_id;
  move.geometry = JointTargetGeometry{{way.from.begin(), way.from.end()}};
  move.joint_speed_fraction = way.speed;
  return builder.build(move);
}

void Route::turn_forward(double s) {
  turn_to(on_forward(s));
  detour_.reset();
}

void Route::clear(double s) {
  const double place = std::max(on_forward(s), forward.farthest());
  detour_.reset();
  beside_ = false;
  forward.clear(place);
  turn_to(place);
}

void Route::leave(double s) {
  turn_forward(s);
  beside_ = true;
}

double Route::distance_to(std::span<const double> joints) const {
  const auto place = beside_ ? forward.place_at(*turned_to_) : std::nullopt;
  double most = 0;
  for (std::size_t j = 0; place && j < joints.size(); ++j) {
    most = std::max(most, std::abs(joints[j] - place->joints[j]));
  }
  return most;
}

}  // namespace rmac
