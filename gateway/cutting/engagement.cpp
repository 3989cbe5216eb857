#include "gateway/cutting/engagement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "gateway/material/sweep/axis_frame.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr int kMostSlices = 24;
constexpr double kLeastStep = pi / 180, kMostStep = pi / 30;
/// Before the tool's surface: strokes of bent ways may have taken more by half of it.
constexpr double kBefore_mm = 0.01;
/// A point of the surface is R/2 times the square of how it faces the way from a wall along that.
constexpr double kShareOfWall = 0.25;
constexpr double kUpright = 1 - 1e-9;  ///< of the axis along one of the lattice's
constexpr double kFacing = 1e-6;
constexpr int kNewtonSteps = 3;
constexpr double kSteep = 0.1;
/// Of the corner radius: places of the surface that are steeper than 45° are higher.
constexpr double kLowestShare = 0.1;

Eigen::Index index(std::size_t axis) {
  return static_cast<Eigen::Index>(axis);
}

class Finder {
 public:
  Finder(const EndMill& mill, const DexelGrid& grid, const ToolAt& tool, const Vector3d& way, double ahead_mm)
      : mill_(mill),
        grid_(grid),
        layout_(grid.layout()),
        axis_(tool.axis),
        way_(way.normalized()),
        tip_(tool.tip + ahead_mm * way_),
        pitch_(*std::ranges::max_element(layout_.pitch)) {
    const Vector3d across = way_ - way_.dot(axis_) * axis_;
    // A tool that only plunges has no feed across its axis from which angles would count.
    x_ = across.norm() > kFacing ? Vector3d(across.normalized()) : Vector3d(across_axis(axis_).row(0));
    y_ = axis_.cross(x_);
    const double step = std::clamp(pitch_ / mill.radius_mm(), kLeastStep, kMostStep);
    places_ = 2 * static_cast<int>(std::ceil(pi / step));
  }

  [[nodiscard]] Engagement find() const {
    Engagement found;
    const std::vector<double> heights = slice_ends();
    for (std::size_t i = 1; i < heights.size(); ++i) {
      EngagedSlice slice{
          .from_mm = heights[i - 1], .to_mm = heights[i], .arcs = arcs((heights[i - 1] + heights[i]) / 2)};
      if (slice.arcs.empty()) continue;
      if (!found.slices.empty() && found.slices.back().to_mm == slice.from_mm &&
          found.slices.back().arcs == slice.arcs) {
        found.slices.back().to_mm = slice.to_mm;
      } else {
        found.slices.push_back(std::move(slice));
      }
    }
    found.face = way_.dot(axis_) < -kFacing && face_meets();
    return found;
  }

 private:
  /// Heights above the tip. Where the tool stands upright on the lattice slices are layers of it, in which material is
  /// known at one height.
  [[nodiscard]] std::vector<double> slice_ends() const {
    double top = 0;
    Eigen::Index upright = 0;
    const bool is_upright = axis_.cwiseAbs().maxCoeff(&upright) > kUpright;
    for (int corner = 0; corner < 8; ++corner) {
      Vector3d at;
      for (std::size_t a = 0; a < 3; ++a) {
        at[index(a)] = layout_.low[a] + ((corner >> a & 1) != 0 ? layout_.pitch[a] * layout_.count[a] : 0);
      }
      top = std::max(top, (at - tip_).dot(axis_));
    }
    top = std::min(top, mill_.cutting_length_mm());
    std::vector<double> ends{0};
    if (top <= 0) return ends;
    const auto a = static_cast<std::size_t>(upright);
    const double pitch = is_upright ? layout_.pitch[a] : pitch_;
    const double apart = pitch * std::ceil(engaged_top(top, pitch) / pitch / kMostSlices);
    if (apart <= 0) return ends;
    // The first end above the tip that lies between two layers.
    const double layers = (layout_.low[a] - tip_[upright]) * (axis_[upright] > 0 ? 1 : -1) / pitch;
    double next = is_upright ? pitch * (layers - std::floor(layers)) : apart;
    while (next < top) {
      if (next > ends.back() + kFacing) ends.push_back(next);
      next += apart;
    }
    ends.push_back(top);
    return ends;
  }

  /// Above it nothing is in material, to a layer or two.
  [[nodiscard]] double engaged_top(double top, double pitch) const {
    constexpr int kLook = 48;
    for (int layer = static_cast<int>(top / pitch - 0.5); layer >= 0; --layer) {
      const double z = (layer + 0.5) * pitch;
      for (int i = 0; i < kLook; ++i) {
        if (meets(2 * pi * (i + 0.5) / kLook, z)) return std::min(top, z + 2 * pitch);
      }
    }
    return top;  // what is thinner than these looks are apart may be anywhere
  }

  [[nodiscard]] std::vector<Arc> arcs(double z) const {
    std::vector<Arc> found;
    bool before = false;
    for (int i = 0; i < places_; ++i) {
      const double from = 2 * pi * i / places_, to = 2 * pi * (i + 1) / places_;
      const bool now = meets((from + to) / 2, z);
      if (now && before) {
        found.back().exit = to;
      } else if (now) {
        found.push_back({from, to});
      }
      before = now;
    }
    // One that goes over the place where the circle begins.
    if (found.size() > 1 && found.front().entry == 0 && before) {
      found.back().exit += found.front().exit;
      found.erase(found.begin());
    }
    return found;
  }

  [[nodiscard]] bool meets(double angle, double z) const {
    const EndMill::Place place = mill_.at(mill_.profile_at(z));
    const Vector3d out = std::sin(angle) * x_ + std::cos(angle) * y_;
    const Vector3d normal = place.sin_k * out - place.cos_k * axis_;
    if (normal.dot(way_) <= kFacing) return false;
    const Vector3d at = tip_ + place.z_mm * axis_ + place.radius_mm * out;
    Eigen::Index along = 0;
    normal.cwiseAbs().maxCoeff(&along);
    auto there = on_ray(at, normal, along);
    // The nearest ray may pass below the tool: then the next one is meant.
    const double lowest = kLowestShare * mill_.corner_radius_mm();
    if (there && place.z_mm >= lowest && (there->at - tip_).dot(axis_) < lowest) {
      there = on_ray(at + pitch_ * axis_, normal, along);
    }
    if (!there) return false;
    const auto axis = static_cast<std::size_t>(along);
    const double facing = there->normal.dot(way_);
    // Nearer where the surface goes along a wall, which is not before it.
    const double before = std::min(kBefore_mm, kShareOfWall * mill_.radius_mm() * facing * facing);
    const double place_on_ray = there->at[along] + std::copysign(before, normal[along]) - layout_.low[axis];
    return grid_.holds(axis, there->ray, static_cast<float>(place_on_ray));
  }

  struct OnRay {
    std::size_t ray = 0;
    Vector3d at{0, 0, 0}, normal{0, 0, 0};
  };
  /// Where the ray next to a place of the surface leaves the tool; none where the lattice has no such ray.
  [[nodiscard]] std::optional<OnRay> on_ray(Vector3d at, const Vector3d& normal, Eigen::Index along) const {
    const auto axis = static_cast<std::size_t>(along);
    const auto line = line_at(at, axis);
    if (!line) return std::nullopt;
    for (std::size_t which = 0; which < 2; ++which) {
      const std::size_t a = DexelLayout::across(axis, which);
      const double there = layout_.line(a, (*line)[which]);
      at[along] -= normal[index(a)] / normal[along] * (there - at[index(a)]);
      at[index(a)] = there;
    }
    Vector3d steepest = normal;
    for (int i = 0; i < kNewtonSteps; ++i) {
      const double beyond = outside(at, steepest);
      if (std::abs(steepest[along]) < kSteep) break;  // it left the surface: a corner
      at[along] -= beyond / steepest[along];
    }
    return OnRay{grid_.ray(axis, (*line)[0], (*line)[1]), at, steepest};
  }

  /// The lines across `axis` that are nearest to a place; none where the lattice has none there.
  [[nodiscard]] std::optional<std::array<std::size_t, 2>> line_at(const Vector3d& at, std::size_t axis) const {
    std::array<std::size_t, 2> line{};
    for (std::size_t which = 0; which < 2; ++which) {
      const std::size_t a = DexelLayout::across(axis, which);
      const double cell = std::floor((at[index(a)] - layout_.low[a]) / layout_.pitch[a]);
      if (cell < 0 || cell >= layout_.count[a]) return std::nullopt;
      line[which] = static_cast<std::size_t>(cell);
    }
    return line;
  }

  /// How far a point is outside of the tool, and in which direction that grows.
  [[nodiscard]] double outside(const Vector3d& at, Vector3d& steepest) const {
    const Vector3d from_tip = at - tip_;
    const double z = from_tip.dot(axis_);
    const Vector3d flat = from_tip - z * axis_;
    const double radius = flat.norm(), corner = mill_.corner_radius_mm();
    const Vector3d out = radius > 0 ? Vector3d(flat / radius) : x_;
    if (z >= corner) {
      steepest = out;
      return radius - mill_.radius_mm();
    }
    const double r = std::max(0.0, radius - (mill_.radius_mm() - corner)), h = z - corner, length = std::hypot(r, h);
    steepest = (r * out + h * axis_) / length;
    return length - corner;
  }

  [[nodiscard]] bool face_meets() const {
    constexpr int kLook = 8;
    const double flat = mill_.radius_mm() - mill_.corner_radius_mm();
    if (flat <= pitch_) return false;
    for (int i = 0; i < kLook; ++i) {
      const double angle = 2 * pi * i / kLook;
      const Vector3d at = tip_ + flat / 2 * (std::sin(angle) * x_ + std::cos(angle) * y_);
      if (holds(at)) return true;
    }
    return false;
  }

  [[nodiscard]] bool holds(const Vector3d& at) const {
    Eigen::Index along = 0;
    axis_.cwiseAbs().maxCoeff(&along);
    const auto axis = static_cast<std::size_t>(along);
    const auto line = line_at(at, axis);
    return line && grid_.holds(axis, grid_.ray(axis, (*line)[0], (*line)[1]),
                               static_cast<float>(at[along] - layout_.low[axis]));
  }

  const EndMill& mill_;
  const DexelGrid& grid_;
  const DexelLayout& layout_;
  Vector3d axis_, way_, tip_, x_, y_;
  double pitch_;
  int places_ = 0;  ///< around the tool
};

}  // namespace

Engagement engagement_of(const EndMill& mill, const DexelGrid& grid, const ToolAt& tool, const Vector3d& way,
                         double ahead_mm) {
  return Finder(mill, grid, tool, way, ahead_mm).find();
}

}  // namespace rmac::gateway
