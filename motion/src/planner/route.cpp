#include "planner/route.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rmac/motion/path_builder.hpp"

namespace rmac {

double Route::on_forward(double s) const noexcept {
  if (!detour_) return s;
  return detour_->retraces ? detour_->path.begin() + detour_->path.end() - s : detour_->joins_at;
}

void Route::take(Detour detour) {
  detour_ = std::move(detour);
  turned_to_ = detour_->path.begin();
}

double Route::turn_back(double s, double distance) {
  if (beside_ || rejoins()) return 0;
  LaidPath back = forward.backward(on_forward(s), distance);
  if (back.size() == 0) return 0;
  take({std::move(back), true, 0});
  return detour_->path.end() - detour_->path.begin();
}

void Route::turn_forward(double s) {
  turned_to_ = on_forward(s);
  detour_.reset();
}

void Route::clear(double s) {
  const double place = std::max(on_forward(s), forward.farthest());
  detour_.reset();
  beside_ = false;
  forward.clear(place);
  turned_to_ = place;
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

Expected<> Route::rejoin(const PlannerModel& model, std::span<const double> joints, double speed) {
  if (!beside_) return {};
  const double s = *turned_to_;
  if (const auto place = forward.place_at(s)) {
    PathBuilder builder(model);
    builder.restart(place->joints, forward.map_at(s)->frames());
    Move away;
    away.id = place->move_id;
    away.geometry = JointTargetGeometry{{joints.begin(), joints.end()}};
    away.joint_speed_fraction = speed;
    const auto built = builder.build(away);
    if (!built) return tl::unexpected(built.error());
    if (!built->empty()) take({forward.way_to(s, *built), false, s});
  }
  beside_ = false;
  return {};
}

}  // namespace rmac
