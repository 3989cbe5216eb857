#include "gateway/collision/ahead/clear_way.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "gateway/bodies/isometry.hpp"

namespace rmac::gateway {
namespace {

using Kind = SceneBody::Kind;

constexpr double kShare = 0.05;         ///< of the clearance: motion within which nothing is looked for
constexpr double kShareBeside = 0.005;  ///< of the clearance: how far a chord may be from the path
constexpr double kArm_mm = 1000;        ///< on which a turn is taken for that
constexpr double kTouch_mm = 1e-6;      ///< solids this near meet
constexpr double kRounding_mm = 1e-5;   ///< that the place where a path ended is measured again with
/// More than the clearance by this is wanted, so that rounding takes nothing from it.
constexpr double kAmple = 1.001;
/// What begins nearer than this share of what is wanted may come nearer still by a twentieth: bodies that slide along
/// each other are measured with some noise.
constexpr double kNearly = 0.99, kNoNearer = 0.95;
constexpr std::size_t kMostLooks = 20'000;

/// How near two bodies may come that are so far apart at the begin.
double floor_from(double wanted_mm, double least_mm) {
  const double floor =
      least_mm >= kNearly * wanted_mm ? std::min(wanted_mm, least_mm) - kRounding_mm : kNoNearer * least_mm;
  return std::max(floor, kTouch_mm / 2);
}

bool joints_at(const PathSegment& segment, double s, Chord::Joints& joints) {
  JointPoint point;
  if (segment.evaluate(s, 0, 1, point) != KinematicsStatus::Ok) return false;
  std::copy_n(point.d[0].begin(), segment.joint_count(), joints.begin());
  return true;
}

/// Nothing is known from there on, and nothing runs there.
ClearWay::Checked unknown(const PathSegment& segment, double s) {
  return {s, false, Obstacle{.move_id = segment.stretch_at(s).move_id}};
}

}  // namespace

ClearWay::ClearWay(LinkChain chain, std::vector<SceneBody> bodies, const Frame& part_frame, double clearance_mm)
    : chain_(std::move(chain)),
      bodies_(std::move(bodies)),
      without_tool_(bodies_.size()),
      to_part_(to_isometry(part_frame).inverse()),
      clearance_mm_(clearance_mm),
      posture_(chain_) {
  for (std::size_t link = 0; link + 1 < chain_.link_count(); ++link) {
    const std::size_t joint = chain_.joint_behind(link);
    const LinkChain::Motion& motion = chain_.motion(joint);
    most_beside_[joint] = kShareBeside * clearance_mm_ / (motion.slides + motion.turns * kArm_mm);
  }
  has_stock_ = std::ranges::any_of(bodies_, [](const SceneBody& body) { return body.kind == Kind::Stock; });
  pair_up();
}

void ClearWay::set_tool(const Tool& tool) {
  bodies_.erase(bodies_.begin() + static_cast<std::ptrdiff_t>(without_tool_), bodies_.end());
  for (SceneBody& body : tool_bodies(tool, chain_, clearance_mm_)) bodies_.push_back(std::move(body));
  pair_up();
  begin();
}

void ClearWay::pair_up() {
  pairs_.clear();
  for (const BodyPair& pair : body_pairs(bodies_)) {
    pairs_.push_back({pair});
    pairs_.back().wanted_mm = pair.core_in_part ? kTouch_mm : kAmple * clearance_mm_;
  }
}

/// Once something was cut nobody knows here what is left of the stock.
bool ClearWay::counts(const Pair& pair) const noexcept {
  if (!pair.with_stock) return true;
  return !stock_cut_ && !(pair.cutter_in_stock && cutting_);
}

/// Beside a cutter that cuts, its shank may be as near to the stock as it gets.
double ClearWay::floor_of(const Pair& pair) const noexcept {
  return pair.with_stock && cutting_ ? std::min(pair.floor_mm, kTouch_mm) : pair.floor_mm;
}

Apart ClearWay::apart(const Pair& pair, const Chord::Joints& joints) {
  ++looks_;
  posture_.set(std::span(joints).first(chain_.link_count() - 1));
  const SceneBody &a = bodies_[pair.first], &b = bodies_[pair.second];
  return distance(a.solid, posture_.pose(a), b.solid, posture_.pose(b), 2 * clearance_mm_);
}

ClearWay::Look ClearWay::look(const Pair& pair, const Chord& chord, double at) {
  Chord::Joints joints = chord.from;
  for (std::size_t j = 0; j < joints.size(); ++j) joints[j] += at * (chord.to[j] - chord.from[j]);
  return {at, apart(pair, joints)};
}

const ClearWay::Pair* ClearWay::start_at(const Chord::Joints& joints) {
  begun_ = true;
  const Pair* meets = nullptr;
  for (Pair& pair : pairs_) {
    const double least = apart(pair, joints).least;
    // Where the machine has been already is not nearer than it was.
    if (pair.floor_mm > least) pair.floor_mm = floor_from(pair.wanted_mm, least);
    pair.margin_mm = least - pair.floor_mm;
    if (meets == nullptr && counts(pair) && least < kTouch_mm / 2) meets = &pair;
  }
  return meets;
}

std::pair<double, double> ClearWay::bound(const Pair& pair, const Chord& chord, double from, double to) {
  Chord::Joints at = chord.from, way{};
  for (std::size_t j = 0; j < at.size(); ++j) {
    at[j] += from * (chord.to[j] - chord.from[j]);
    way[j] = (to - from) * std::abs(chord.to[j] - chord.from[j]);
  }
  posture_.set(std::span(at).first(chain_.link_count() - 1));
  Posture::Radii first, second;
  posture_.radii(bodies_[pair.first], first);
  posture_.radii(bodies_[pair.second], second);
  const auto most = [&](const Chord::Joints& joints) {
    return posture_.bound(bodies_[pair.first], first, bodies_[pair.second], second, joints);
  };
  return {most(way), most(chord.beside)};
}

std::optional<double> ClearWay::leaves(const Pair& pair, const Chord& chord, const Look& from, const Look& to) {
  const double floor = floor_of(pair);
  const auto [way, beside] = bound(pair, chord, from.at, to.at);
  const bool apart_at_end = to.apart.least >= floor;
  constexpr double kShortest = 1e-9;  // of the chord: below it joints have no digits left
  const bool short_way = way <= kShare * clearance_mm_ || to.at - from.at < kShortest;
  if (apart_at_end && ((from.apart.least + to.apart.least - way) / 2 - beside >= floor || short_way))
    return std::nullopt;
  if (short_way) return from.at;
  const Look middle = look(pair, chord, (from.at + to.at) / 2);
  if (const auto first = leaves(pair, chord, from, middle)) return first;
  return leaves(pair, chord, middle, to);
}

std::optional<ClearWay::Stop> ClearWay::advance(const Chord& chord) {
  std::optional<Stop> stop;
  Chord::Joints way{};
  for (std::size_t j = 0; j < way.size(); ++j) way[j] = std::abs(chord.to[j] - chord.from[j]) + 2 * chord.beside[j];
  posture_.set(std::span(chord.from).first(chain_.link_count() - 1));
  std::vector<Posture::Radii> radii(bodies_.size());
  for (std::size_t i = 0; i < bodies_.size(); ++i) posture_.radii(bodies_[i], radii[i]);
  const Posture begin = posture_;
  for (Pair& pair : pairs_) {
    if (!counts(pair)) {
      pair.margin_mm = 0;
      continue;
    }
    pair.margin_mm -=
        begin.bound(bodies_[pair.first], radii[pair.first], bodies_[pair.second], radii[pair.second], way);
    if (pair.margin_mm > 0) continue;
    const Look from = look(pair, chord, 0), to = look(pair, chord, stop ? stop->at : 1);
    if (from.apart.least < floor_of(pair)) {
      stop = Stop{0, &pair};
    } else if (const auto at = leaves(pair, chord, from, to)) {
      stop = Stop{*at, &pair};
    }
    if (to.apart.least >= pair.wanted_mm) pair.floor_mm = floor_from(pair.wanted_mm, pair.wanted_mm);
    pair.margin_mm = to.apart.least - floor_of(pair);
  }
  return stop;
}

double ClearWay::settle(const PathSegment& segment, double from_s, double s) {
  constexpr double kFirstStep_mm = 1e-5;
  const auto all_clear = [&](double at) {
    Chord::Joints joints{};
    return joints_at(segment, at, joints) && std::ranges::all_of(pairs_, [&](const Pair& pair) {
             return !counts(pair) || apart(pair, joints).least >= floor_of(pair);
           });
  };
  for (double back = 0; s - back > from_s; back = back == 0 ? kFirstStep_mm : 2 * back) {
    if (all_clear(s - back)) return s - back;
  }
  return from_s;
}

Obstacle ClearWay::describe(const PathSegment& segment, const Pair& pair, double s) {
  constexpr int kLooks = 60;
  constexpr double kFarthest_mm = 200;
  const SceneBody &a = bodies_[pair.first], &b = bodies_[pair.second];
  const MoveStretch& stretch = segment.stretch_at(s);
  Obstacle found{.first = a.name, .second = b.name, .move_id = stretch.move_id};
  found.s_mm = stretch.s_begin_mm + stretch.s_per_length * std::max(s - stretch.begin, 0.0);
  const double far = std::min(segment.length() - s, kFarthest_mm);
  double nearest = 1e300;
  for (int i = 0; i <= kLooks; ++i) {
    Chord::Joints joints{};
    if (!joints_at(segment, s + far * i / kLooks, joints)) break;
    const Apart now = apart(pair, joints);
    const bool meet = now.most == 0;
    if (i == 0) found.distance_mm = now.most;
    if (now.most < nearest) {
      nearest = now.most;
      found.place = to_part_ * Eigen::Vector3d((now.on_first + now.on_second) / 2);
    }
    if (meet) {
      found.depth_mm =
          std::max(found.depth_mm, b.below_mm + overlap_depth(a.solid, posture_.pose(a), b.solid, posture_.pose(b)));
    } else if (nearest == 0) {
      break;
    }
  }
  return found;
}

ClearWay::Checked ClearWay::check(const PathSegment& segment, double from_s) {
  const std::size_t looks_before = looks_;
  cutting_ = !segment.demand().positioning;
  if (!begun_) {
    Chord::Joints joints{};
    if (!joints_at(segment, from_s, joints)) return unknown(segment, from_s);
    if (const Pair* const meets = start_at(joints)) {
      Obstacle obstacle = describe(segment, *meets, from_s);
      obstacle.at_begin = true;
      return {from_s, false, std::move(obstacle)};
    }
  }
  double at = from_s;
  for (const double node : segment.nodes()) {
    if (node <= at) continue;
    const std::vector<Chord> chords = chords_of(segment, at, node, most_beside_);
    if (chords.empty()) return unknown(segment, at);
    for (const Chord& chord : chords) {
      if (looks_ - looks_before > kMostLooks && chord.from_s > from_s) return {chord.from_s, false};
      const auto stop = advance(chord);
      if (!stop) continue;
      const double s = settle(segment, from_s, chord.from_s + stop->at * (chord.to_s - chord.from_s));
      return {s, false, describe(segment, *stop->pair, s)};
    }
    at = node;
  }
  stock_cut_ = stock_cut_ || cutting_;
  return {segment.length(), true};
}

}  // namespace rmac::gateway
