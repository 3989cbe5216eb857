#include "gateway/collision/distance/solid.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace rmac::gateway {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kPrecisely = 1e300;

/// A pair of nodes, or of a node and a convex solid, and how far they are apart at least.
struct Candidate {
  double least;
  std::uint32_t first, second;
};

double gap(const AlignedBox3d& a, const AlignedBox3d& b) {
  return std::sqrt(std::max(0.0, a.squaredExteriorDistance(b)));
}

AlignedBox3d around(const Convex& convex, const Isometry3d& pose) {
  AlignedBox3d box;
  for (int c = 0; c < 3; ++c) {
    for (const double sign : {1.0, -1.0}) {
      const Vector3d direction = sign * Vector3d::Unit(c);
      const Vector3d point = pose * convex.support(pose.linear().transpose() * direction);
      box.extend(Vector3d(point + direction * convex.rounded()));
    }
  }
  return box;
}

/// The box, along other axes, around a box.
AlignedBox3d turned(const AlignedBox3d& box, const Isometry3d& pose) {
  const Vector3d middle = pose * box.center();
  const Vector3d half = pose.linear().cwiseAbs() * (box.sizes() / 2);
  return {Vector3d(middle - half), Vector3d(middle + half)};
}

/// How far a convex solid reaches along a unit direction.
double reach_of(const Convex& convex, const Isometry3d& pose, const Vector3d& direction) {
  const Vector3d own = pose.linear().transpose() * direction;
  return own.dot(convex.support(own)) + convex.rounded() + direction.dot(pose.translation());
}

/// One side of a pair as a tree of nodes; a convex solid is a single leaf.
class Side {
 public:
  Side(const Solid& solid, const Isometry3d& pose) : solid_(solid), pose_(pose) {
    if (const Convex* convex = solid.convex()) convex_box_ = around(*convex, pose);
  }
  [[nodiscard]] AlignedBox3d box(std::uint32_t node) const {
    return solid_.convex() != nullptr ? convex_box_ : turned(solid_.tree().nodes()[node].box, pose_);
  }
  [[nodiscard]] bool leaf(std::uint32_t node) const {
    return solid_.convex() != nullptr || solid_.tree().nodes()[node].count > 0;
  }
  [[nodiscard]] std::uint32_t child(std::uint32_t node) const { return solid_.tree().nodes()[node].first; }
  /// The unit direction along which `reach` asks.
  void aim(const Vector3d& direction) {
    direction_ = direction;
    own_ = pose_.linear().transpose() * direction;
    own_size_ = own_.cwiseAbs() / 2;
    moved_ = direction.dot(pose_.translation());
    if (const Convex* convex = solid_.convex()) convex_reach_ = reach_of(*convex, pose_, direction);
  }
  [[nodiscard]] const Vector3d& direction() const noexcept { return direction_; }
  /// How far a node, or the convex solid, reaches.
  [[nodiscard]] double reach(std::uint32_t node) const {
    if (solid_.convex() != nullptr) return convex_reach_;
    const AlignedBox3d& box = solid_.tree().nodes()[node].box;
    return own_.dot(box.center()) + own_size_.dot(box.sizes()) + moved_;
  }
  template <typename Do>
  void each(std::uint32_t node, Do look) const {
    if (const Convex* convex = solid_.convex()) return look(*convex);
    const auto& leaf = solid_.tree().nodes()[node];
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) look(solid_.tree().triangle(i));
  }

 private:
  const Solid& solid_;
  const Isometry3d& pose_;
  AlignedBox3d convex_box_;
  Vector3d direction_ = Vector3d::Zero(), own_ = Vector3d::Zero(), own_size_ = Vector3d::Zero();
  double moved_ = 0, convex_reach_ = 0;
};

/// Looks at pairs of leaves, of each two branches the nearer first. `skip` says of a pair that it is not worth it.
template <typename Skip, typename Look>
void search(const Side& first, const Side& second, const Candidate& at, const Skip& skip, const Look& look) {
  if (skip(at)) return;
  const bool first_leaf = first.leaf(at.first), second_leaf = second.leaf(at.second);
  if (first_leaf && second_leaf) return look(at);
  const AlignedBox3d first_box = first.box(at.first), second_box = second.box(at.second);
  const bool open_first =
      second_leaf || (!first_leaf && first_box.sizes().squaredNorm() > second_box.sizes().squaredNorm());
  std::array<Candidate, 2> branches;
  for (std::uint32_t k = 0; k < 2; ++k) {
    const std::uint32_t a = open_first ? first.child(at.first) + k : at.first;
    const std::uint32_t b = open_first ? at.second : second.child(at.second) + k;
    branches[k] = {gap(open_first ? first.box(a) : first_box, open_first ? second_box : second.box(b)), a, b};
  }
  if (branches[1].least < branches[0].least) std::swap(branches[0], branches[1]);
  for (const Candidate& branch : branches) search(first, second, branch, skip, look);
}

/// Of which one is a mesh.
Apart surface_distance(const Solid& first, const Isometry3d& first_pose, const Solid& second,
                       const Isometry3d& second_pose, double precise_mm) {
  // In the frame of a mesh, so that its own boxes need not grow.
  const bool swap = first.convex() != nullptr;
  const Isometry3d& frame = swap ? second_pose : first_pose;
  const Isometry3d a_pose = frame.inverse() * first_pose, b_pose = frame.inverse() * second_pose;
  Side a(first, a_pose), b(second, b_pose);
  Apart best;
  best.least = best.most = 1e300;
  // Both aim at each other where they are nearest so far: what lies beyond a plane across that is not looked at.
  const auto not_worth = [&](double least) {
    const double slack = std::max(0.0, best.most - precise_mm) / 2;
    if (best.most > 0 && least < best.most - slack) return false;
    best.least = std::min(best.least, least);
    return true;
  };
  const auto skip = [&](const Candidate& at) {
    return not_worth(at.least) || not_worth(-a.reach(at.first) - b.reach(at.second));
  };
  search(a, b, {gap(a.box(0), b.box(0)), 0, 0}, skip, [&](const Candidate& at) {
    a.each(at.first, [&](const Convex& one) {
      double one_reach = reach_of(one, a_pose, a.direction());
      b.each(at.second, [&](const Convex& other) {
        if (best.most == 0 || not_worth(-one_reach - reach_of(other, b_pose, b.direction()))) return;
        const Apart apart = distance(one, a_pose, other, b_pose, best.most, a.direction());
        const double least = std::min(best.least, apart.least);
        if (apart.most < best.most) {
          best = apart;
          if (best.most > 0) {
            a.aim((best.on_second - best.on_first) / best.most);
            b.aim((best.on_first - best.on_second) / best.most);
            one_reach = reach_of(one, a_pose, a.direction());  // along the same line as the others' from here on
          }
        }
        best.least = least;
      });
    });
  });
  best.least = std::min(best.least, best.most);
  best.on_first = frame * best.on_first;
  best.on_second = frame * best.on_second;
  return best;
}

/// Surfaces that do not meet: whether one solid is inside of the other all the same.
bool encloses(const Solid& outer, const Isometry3d& outer_pose, const Solid& inner, const Isometry3d& inner_pose) {
  const Vector3d point =
      outer_pose.inverse() * (inner_pose * (inner.convex() != nullptr ? inner.middle() : inner.tree().corner()));
  if (const Convex* convex = outer.convex()) {
    return distance(*convex, Isometry3d::Identity(), Convex::sphere(0), Isometry3d(Eigen::Translation3d(point))).most ==
           0;
  }
  return outer.tree().encloses(point);
}

/// Points of a solid, of which the deepest in another is looked for.
std::vector<Vector3d> points_of(const Solid& solid) {
  constexpr std::size_t kMost = 400;
  constexpr int kSide = 6;  // of a grid of directions
  std::vector<Vector3d> points;
  if (const Convex* convex = solid.convex()) {
    const auto add = [&](const Vector3d& direction) {
      points.push_back(convex->support(direction) + direction.normalized() * convex->rounded());
    };
    points.push_back(convex->middle());
    for (int i = 0; i < kSide * kSide * kSide; ++i) {
      add(Vector3d(i % kSide, i / kSide % kSide, i / kSide / kSide) - Vector3d::Constant((kSide - 1) / 2.0));
    }
    for (int c = 0; c < 3; ++c) add(Vector3d::Unit(c)), add(-Vector3d::Unit(c));
    return points;
  }
  const std::size_t step = solid.tree().size() / kMost + 1;
  for (std::size_t i = 0; i < solid.tree().size(); i += step) points.push_back(solid.tree().corner(i));
  return points;
}

/// How deep the deepest of the points of one solid is inside of the other.
double deepest_point(const Solid& one, const Isometry3d& one_pose, const Solid& other, const Isometry3d& other_pose) {
  const Isometry3d to_other = other_pose.inverse() * one_pose;
  const Solid dot(Convex::sphere(0));
  double deepest = 0;
  for (const Vector3d& point : points_of(one)) {
    const Isometry3d at(Eigen::Translation3d(to_other * point));
    if (other.convex() != nullptr) {
      if (distance(*dot.convex(), at, *other.convex(), Isometry3d::Identity()).most > 0) continue;
      deepest = std::max(deepest, overlap_depth(*dot.convex(), at, *other.convex(), Isometry3d::Identity()));
    } else if (other.tree().encloses(at.translation())) {
      deepest = std::max(deepest, surface_distance(dot, at, other, Isometry3d::Identity(), kPrecisely).most);
    }
  }
  return deepest;
}

}  // namespace

Apart distance(const Solid& first, const Isometry3d& first_pose, const Solid& second, const Isometry3d& second_pose,
               double precise_mm) {
  if (first.convex() != nullptr && second.convex() != nullptr) {
    return distance(*first.convex(), first_pose, *second.convex(), second_pose);
  }
  Apart apart = surface_distance(first, first_pose, second, second_pose, precise_mm);
  const double middles = (first_pose * first.middle() - second_pose * second.middle()).norm();
  if (apart.most == 0 || middles > first.reach() + second.reach()) return apart;
  if (encloses(first, first_pose, second, second_pose) || encloses(second, second_pose, first, first_pose)) {
    apart.least = apart.most = 0;
  }
  return apart;
}

double overlap_depth(const Solid& first, const Isometry3d& first_pose, const Solid& second,
                     const Isometry3d& second_pose) {
  if (first.convex() != nullptr && second.convex() != nullptr) {
    return overlap_depth(*first.convex(), first_pose, *second.convex(), second_pose);
  }
  return std::max(deepest_point(first, first_pose, second, second_pose),
                  deepest_point(second, second_pose, first, first_pose));
}

}  // namespace rmac::gateway
