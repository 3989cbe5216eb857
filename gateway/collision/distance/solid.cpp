#include "gateway/collision/distance/solid.hpp"

#include <algorithm>
#include <queue>

namespace rmac::gateway {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Box = TriangleTree::Box;

constexpr double kPrecisely = 1e300;

/// What a pair of nodes, or a node and a convex solid, is worth looking at.
struct Candidate {
  double least;
  std::uint32_t first, second;
  bool operator<(const Candidate& other) const noexcept { return least > other.least; }  // the nearest goes first
};

double gap(const Box& a, const Box& b) {
  return std::sqrt(std::max(0.0, a.squaredExteriorDistance(b)));
}

Box around(const Convex& convex, const Isometry3d& pose) {
  Box box;
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
Box turned(const Box& box, const Isometry3d& pose) {
  const Vector3d middle = pose * box.center();
  const Vector3d half = pose.linear().cwiseAbs() * (box.sizes() / 2);
  return {Vector3d(middle - half), Vector3d(middle + half)};
}

/// One side of a pair as a tree of nodes; a convex solid is a single leaf.
class Side {
 public:
  Side(const Solid& solid, const Isometry3d& pose) : solid_(solid), pose_(pose) {
    if (const Convex* convex = solid.convex()) convex_box_ = around(*convex, pose);
  }
  [[nodiscard]] Box box(std::uint32_t node) const {
    return solid_.convex() != nullptr ? convex_box_ : turned(solid_.tree().nodes()[node].box, pose_);
  }
  [[nodiscard]] bool leaf(std::uint32_t node) const {
    return solid_.convex() != nullptr || solid_.tree().nodes()[node].count > 0;
  }
  [[nodiscard]] std::uint32_t child(std::uint32_t node) const { return solid_.tree().nodes()[node].first; }
  template <typename Do>
  void each(std::uint32_t node, Do look) const {
    if (const Convex* convex = solid_.convex()) return look(*convex);
    const auto& leaf = solid_.tree().nodes()[node];
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) look(solid_.tree().triangle(i));
  }

 private:
  const Solid& solid_;
  const Isometry3d& pose_;
  Box convex_box_;
};

/// Looks at leaves, the nearest first, until `look` is content with what the others have at least.
template <typename Look>
void search(const Side& first, const Side& second, Look look) {
  std::priority_queue<Candidate> open;
  open.push({gap(first.box(0), second.box(0)), 0, 0});
  while (!open.empty()) {
    const Candidate at = open.top();
    open.pop();
    const bool first_leaf = first.leaf(at.first), second_leaf = second.leaf(at.second);
    if (first_leaf && second_leaf) {
      if (!look(at)) return;
      continue;
    }
    const Box first_box = first.box(at.first), second_box = second.box(at.second);
    const bool open_first =
        second_leaf || (!first_leaf && first_box.diagonal().squaredNorm() > second_box.diagonal().squaredNorm());
    for (std::uint32_t k = 0; k < 2; ++k) {
      const std::uint32_t a = open_first ? first.child(at.first) + k : at.first;
      const std::uint32_t b = open_first ? at.second : second.child(at.second) + k;
      open.push({gap(open_first ? first.box(a) : first_box, open_first ? second_box : second.box(b)), a, b});
    }
  }
}

/// Of which one is a mesh.
Apart surface_distance(const Solid& first, const Isometry3d& first_pose, const Solid& second,
                       const Isometry3d& second_pose, double precise_mm) {
  // In the frame of a mesh, so that its own boxes need not grow.
  const bool swap = first.convex() != nullptr;
  const Isometry3d& frame = swap ? second_pose : first_pose;
  const Isometry3d a_pose = frame.inverse() * first_pose, b_pose = frame.inverse() * second_pose;
  const Side a(first, a_pose), b(second, b_pose);
  Apart best;
  best.least = best.most = 1e300;
  search(a, b, [&](const Candidate& at) {
    const double slack = std::max(0.0, best.most - precise_mm) / 2;
    if (at.least >= best.most - slack) {
      best.least = std::min(best.least, at.least);
      return false;
    }
    a.each(at.first, [&](const Convex& one) {
      b.each(at.second, [&](const Convex& other) {
        const Apart apart = distance(one, a_pose, other, b_pose, best.most);
        const double least = std::min(best.least, apart.least);
        if (apart.most < best.most) best = apart;
        best.least = least;
      });
    });
    return best.most > 0;
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
