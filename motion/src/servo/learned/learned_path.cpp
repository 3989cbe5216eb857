#include "rmac/motion/servo/learned_path.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

namespace rmac {
namespace {

/// So many cycles on end may be spent in moves that nobody knows: a line of 0.1 mm is passed within one.
constexpr int kMostUnknown = 10;

auto refusal(const std::string& why) {
  return failure(MinorCode::InvalidParameterValue, "learned offsets: " + why);
}

Expected<> check_moves(const LearnedPath::Parts& parts) {
  if (parts.moves.empty()) return refusal("no move");
  double last = 0;
  for (const LearnedPath::Move& move : parts.moves) {
    if (!(move.begin_mm >= last && std::isfinite(move.begin_mm))) {
      return refusal("move " + std::to_string(move.id) + " begins before the one before it, or nowhere");
    }
    last = move.begin_mm;
  }
  if (!(parts.end_mm >= last && std::isfinite(parts.end_mm))) return refusal("the last move ends before it begins");
  return {};
}

Expected<> check_knots(const LearnedPath::Parts& parts) {
  const std::size_t knots = parts.places.size();
  if (knots < 2 || knots > LearnedPath::kMostKnots) {
    return refusal(std::to_string(knots) + " knots; 2 to " + std::to_string(LearnedPath::kMostKnots) + " are possible");
  }
  if (parts.joints == 0 || parts.joints > kMaxJoints || parts.offsets.size() != knots * parts.joints) {
    return refusal("each joint needs an offset for each knot");
  }
  for (std::size_t i = 0; i < knots; ++i) {
    if (!std::isfinite(parts.places[i]) || (i > 0 && !(parts.places[i] > parts.places[i - 1]))) {
      return refusal("the places of knots must ascend; knot " + std::to_string(i) + " does not");
    }
  }
  const auto no_number = std::ranges::find_if_not(parts.offsets, [](double offset) { return std::isfinite(offset); });
  if (no_number != parts.offsets.end()) return refusal("an offset is no number");
  return {};
}

/// Through p1 and p2, with the slopes that their neighbours give (Catmull and Rom).
double cubic(double p0, double p1, double p2, double p3, double u) noexcept {
  const double a = 0.5 * (3 * (p1 - p2) + p3 - p0), b = p0 - 2.5 * p1 + 2 * p2 - 0.5 * p3, c = 0.5 * (p2 - p0);
  return ((a * u + b) * u + c) * u + p1;
}

}  // namespace

LearnedPath::LearnedPath(Parts parts) : parts_(std::move(parts)), by_id_(parts_.moves.size()) {
  std::iota(by_id_.begin(), by_id_.end(), std::size_t{0});
  std::ranges::sort(by_id_, {}, [this](std::size_t place) { return parts_.moves[place].id; });
  for (std::size_t i = 0; i < parts_.offsets.size(); ++i) {
    double& largest = largest_.at(i % parts_.joints);
    largest = std::max(largest, std::abs(parts_.offsets[i]));
    if (i < parts_.joints) continue;
    steepest_ = std::max(steepest_, std::abs(parts_.offsets[i] - parts_.offsets[i - parts_.joints]));
  }
}

Expected<LearnedPath> LearnedPath::create(Parts parts) {
  if (auto fine = check_moves(parts).and_then([&] { return check_knots(parts); }); !fine) {
    return tl::unexpected(fine.error());
  }
  LearnedPath path(std::move(parts));
  const auto id = [&path](std::size_t place) { return path.parts_.moves[place].id; };
  const auto twice = std::ranges::adjacent_find(path.by_id_, {}, id);
  if (twice != path.by_id_.end()) return refusal("two moves have the id " + std::to_string(id(*twice)));
  return path;
}

bool LearnedPath::find(Cursor& cursor, std::int64_t move_id) const noexcept {
  const auto is = [&](std::size_t place) { return place < parts_.moves.size() && parts_.moves[place].id == move_id; };
  if (is(cursor.move)) return true;
  if (is(cursor.move + 1)) {
    ++cursor.move;
    return true;
  }
  const auto id = [this](std::size_t place) { return parts_.moves[place].id; };
  const auto found = std::ranges::lower_bound(by_id_, move_id, {}, id);
  if (found == by_id_.end() || id(*found) != move_id) return false;
  cursor.move = *found;
  return true;
}

bool LearnedPath::at(Cursor& cursor, std::int64_t move_id, double s_mm, std::span<double> offsets) const noexcept {
  if (!std::isfinite(s_mm)) return cursor.on_it = false;
  if (find(cursor, move_id)) {
    // An approach that is longer than it was goes no further into the path than it did.
    const std::size_t next = cursor.move + 1;
    const double end = next < parts_.moves.size() ? parts_.moves[next].begin_mm : parts_.end_mm;
    const double along = std::min(parts_.moves[cursor.move].begin_mm + std::max(s_mm, 0.0), end);
    cursor.step_mm = cursor.on_it ? along - cursor.along_mm : 0;
    cursor.along_mm = along;
    cursor.unknown = 0;
    cursor.on_it = true;
  } else if (cursor.on_it && cursor.unknown < kMostUnknown) {
    ++cursor.unknown;
    cursor.along_mm += std::max(cursor.step_mm, 0.0);
  } else {
    return cursor.on_it = false;
  }
  interpolate(cursor.along_mm, offsets);
  return true;
}

void LearnedPath::interpolate(double along_mm, std::span<double> offsets) const noexcept {
  const std::vector<double>& places = parts_.places;
  const auto above = std::ranges::upper_bound(places, along_mm);
  const std::size_t last = places.size() - 1;
  const auto after = std::clamp(static_cast<std::size_t>(above - places.begin()), std::size_t{1}, last);
  const std::size_t before = after - 1;
  const double u = std::clamp((along_mm - places[before]) / (places[after] - places[before]), 0.0, 1.0);
  for (std::size_t j = 0; j < std::min(parts_.joints, offsets.size()); ++j) {
    const auto knot = [&](std::size_t i) { return parts_.offsets[i * parts_.joints + j]; };
    offsets[j] =
        cubic(knot(before == 0 ? 0 : before - 1), knot(before), knot(after), knot(std::min(after + 1, last)), u);
  }
}

}  // namespace rmac
