#include "gateway/collision/checker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rmac::gateway {
namespace {

using Kind = SceneBody::Kind;

constexpr double kShare = 0.1;          ///< of the clearance: motion within which nothing is looked for
constexpr double kShareOfDepth = 0.02;  ///< that it may be deeper than told
constexpr double kNeverMeasured = 1e300;

}  // namespace

CollisionChecker::CollisionChecker(LinkChain chain, std::vector<SceneBody> bodies, const Frame& part_frame,
                                   double clearance_mm)
    : chain_(std::move(chain)),
      bodies_(std::move(bodies)),
      without_tool_(bodies_.size()),
      clearance_mm_(clearance_mm),
      findings_(part_frame),
      posture_(chain_),
      between_(chain_) {
  pair_up();
}

void CollisionChecker::set_tool(const Tool& tool) {
  bodies_.erase(bodies_.begin() + static_cast<std::ptrdiff_t>(without_tool_), bodies_.end());
  for (SceneBody& body : tool_bodies(tool, chain_, clearance_mm_)) bodies_.push_back(std::move(body));
  pair_up();
}

void CollisionChecker::pair_up() {
  pairs_.clear();
  for (const BodyPair& pair : body_pairs(bodies_)) {
    pairs_.push_back({pair});
    pairs_.back().near_mm = pair.core_in_part ? 0 : clearance_mm_;
  }
}

void CollisionChecker::advance(double t_s, std::span<const double> joints, const MoveNow& move) {
  const bool first = !begun_;
  if (first) from_.assign(joints.begin(), joints.end()), way_ = at_ = from_, from_s_ = t_s;
  begun_ = true;
  bool moves = first;
  for (std::size_t j = 0; j < from_.size(); ++j) {
    way_[j] = joints[j] - from_[j];
    moves = moves || way_[j] != 0;
  }
  const bool same_kind = move.cutting == move_.cutting;
  move_ = move;
  to_s_ = t_s;
  std::vector<double>& length = at_;
  posture_.set(from_);
  radii_.resize(bodies_.size());
  for (std::size_t i = 0; i < bodies_.size(); ++i) posture_.radii(bodies_[i], radii_[i]);
  for (Pair& pair : pairs_) {
    // Once something was cut nobody knows here what is left of the stock on the way of the cutting part.
    const bool counts = !(pair.cutter_in_stock && (move.cutting || stock_cut_)) &&
                        !(pair.tool_in_stock && stock_followed_ && stock_cut_);
    if (!counts) {
      pair.finding = nullptr;
      pair.margin_mm = 0;
      pair.here.reset();
      continue;
    }
    if (!moves && same_kind) continue;
    for (std::size_t j = 0; j < way_.size(); ++j) length[j] = std::abs(way_[j]);
    const double moved =
        posture_.bound(bodies_[pair.first], radii_[pair.first], bodies_[pair.second], radii_[pair.second], length);
    pair.margin_mm -= moved;
    pair.unmeasured_mm += moved;
    if (pair.margin_mm > 0) {
      pair.here.reset();
      continue;
    }
    const Look from = pair.here ? Look{0, *pair.here} : look(pair, 0), to = look(pair, 1);
    note(pair, from);
    examine(pair, from, to);
    pair.margin_mm = to.apart.least - pair.near_mm;
    pair.here = to.apart;
    if (to.apart.most >= clearance_mm_) pair.finding = nullptr;
  }
  if (move.cutting && moves && !std::exchange(stock_cut_, true)) forget_what_was_near_stock();
  from_.assign(joints.begin(), joints.end());
  from_s_ = t_s;
}

/// What is found from here on is another finding, as it may be that nothing is left there to meet.
void CollisionChecker::forget_what_was_near_stock() {
  for (Pair& pair : pairs_) {
    if (!pair.with_stock) continue;
    pair.finding = nullptr;
    pair.unmeasured_mm = kNeverMeasured;
  }
}

CollisionChecker::Look CollisionChecker::look(const Pair& pair, double at) {
  for (std::size_t j = 0; j < from_.size(); ++j) at_[j] = from_[j] + at * way_[j];
  between_.set(at_);
  ++distances_;
  const SceneBody &a = bodies_[pair.first], &b = bodies_[pair.second];
  return {at, distance(a.solid, between_.pose(a), b.solid, between_.pose(b), 2 * clearance_mm_)};
}

void CollisionChecker::examine(Pair& pair, const Look& from, const Look& to) {
  for (std::size_t j = 0; j < from_.size(); ++j) at_[j] = from_[j] + from.at * way_[j];
  between_.set(at_);
  for (std::size_t j = 0; j < from_.size(); ++j) at_[j] = std::abs(way_[j]) * (to.at - from.at);
  Posture::Radii first, second;
  between_.radii(bodies_[pair.first], first);
  between_.radii(bodies_[pair.second], second);
  const double way = between_.bound(bodies_[pair.first], first, bodies_[pair.second], second, at_);
  const bool meet = from.apart.most == 0 && to.apart.most == 0;
  const double least = (from.apart.least + to.apart.least - way) / 2;
  constexpr double kShortest = 1e-9;  // of the way: below it joints have no digits left
  if (!meet && least < pair.near_mm && way > kShare * clearance_mm_ && to.at - from.at > kShortest) {
    const Look middle = look(pair, (from.at + to.at) / 2);
    examine(pair, from, middle);
    examine(pair, middle, to);
    return;
  }
  note(pair, to);
}

void CollisionChecker::note(Pair& pair, const Look& look) {
  const SceneBody &a = bodies_[pair.first], &b = bodies_[pair.second];
  if (look.apart.most > 0 && look.apart.most >= pair.near_mm) return;
  const bool meet = look.apart.most == 0;
  if (pair.finding == nullptr) {
    pair.finding =
        findings_.of(a.name, b.name, from_s_, move_, {.possible = pair.with_stock && stock_cut_, .meet = meet});
    if (pair.finding == nullptr) return;
  }
  // Depth costs far more than to see that they meet: it is measured again when it may be another.
  if (meet && pair.unmeasured_mm > std::max(kShare * clearance_mm_, kShareOfDepth * pair.depth_mm)) {
    for (std::size_t j = 0; j < from_.size(); ++j) at_[j] = from_[j] + look.at * way_[j];
    between_.set(at_);
    pair.depth_mm = b.below_mm + overlap_depth(a.solid, between_.pose(a), b.solid, between_.pose(b));
    pair.unmeasured_mm = 0;
  }
  if (!meet) pair.unmeasured_mm = kNeverMeasured;
  findings_.see(*pair.finding, look.apart, meet ? pair.depth_mm : 0, from_s_ + look.at * (to_s_ - from_s_), move_);
}

}  // namespace rmac::gateway
