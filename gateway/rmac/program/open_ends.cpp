#include "gateway/rmac/program/open_ends.hpp"

#include <algorithm>
#include <cmath>

namespace rmac::cli {

namespace {

// The appliance takes a start within 1e-3 mm of its queue's end.
constexpr double kNearMm = 2e-3;

const nlohmann::json* member(const nlohmann::json& object, const char* name) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(name);
  return found == object.end() ? nullptr : &*found;
}

std::optional<OpenEnds::Point> point(const nlohmann::json* numbers) {
  if (numbers == nullptr || !numbers->is_array() || numbers->size() < 3) return std::nullopt;
  OpenEnds::Point place{};
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (!(*numbers)[i].is_number()) return std::nullopt;
    place[i] = (*numbers)[i].get<double>();
  }
  return place;
}

std::optional<OpenEnds::Point> place_of(const nlohmann::json* pose) {
  return pose == nullptr ? std::nullopt : point(member(*pose, "p"));
}

OpenEnds::Reach ends_of(const nlohmann::json& curve) {
  const nlohmann::json* points = member(curve, "points");
  if (points == nullptr || !points->is_array() || points->empty()) return {};
  return {point(&points->front()), point(&points->back())};
}

bool near(const OpenEnds::Point& a, const OpenEnds::Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) < kNearMm;
}

}  // namespace

OpenEnds::Reach OpenEnds::of(const nlohmann::json& params) {
  if (const auto* curve = member(params, "Nurbs")) return ends_of(*curve);
  if (const auto* curve = member(params, "NurbsND")) {
    const auto* space = member(*curve, "space");
    return space != nullptr && *space == "pose" ? ends_of(*curve) : Reach{};
  }
  if (const auto* target = member(params, "TargetFrame")) return {std::nullopt, place_of(target)};
  return {place_of(member(params, "StartPoint")), place_of(member(params, "EndPoint"))};
}

bool OpenEnds::may_follow(const Reach& move) const {
  if (ends_.size() == 1) return true;
  if (!move.begin) return false;
  // The last one is where it is to begin.
  return std::all_of(ends_.begin(), ends_.end() - 1, [&](const auto& end) { return end && !near(*end, *move.begin); });
}

void OpenEnds::sent(const Reach& move) {
  ends_.push_back(move.end);
}

void OpenEnds::answered() {
  if (ends_.size() > 1) ends_.pop_front();
}

void OpenEnds::forget() {
  std::ranges::fill(ends_, std::nullopt);
}

}  // namespace rmac::cli
