#include "gateway/metrology/tool_offset.hpp"

#include <cmath>

#include "rmac/motion/frame.hpp"
#include "rmac/motion/vector.hpp"

namespace rmac::gateway {
namespace {

constexpr double kCosine = 0.99619469809174555;  // of 5 degrees
constexpr double kSine = 0.087155742747658174;

struct Mean {
  double sum = 0;
  std::size_t count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  [[nodiscard]] std::optional<double> value() const {
    return count == 0 ? std::nullopt : std::optional(sum / static_cast<double>(count));
  }
};

}  // namespace

ToolOffset tool_offset(std::span<const SurfacePoint> points, const Frame& frame, const Vector& axis) {
  const Frame to_part = inverse(frame);
  Mean length, radius;
  for (const SurfacePoint& point : points) {
    const Vector at = apply_to_pose(to_part, {point.measured, axis}).tip;
    const Vector off{at[0] - point.nominal[0], at[1] - point.nominal[1], at[2] - point.nominal[2]};
    const double missing = -dot(point.normal, off);
    const double leans = dot(point.normal, axis);
    if (leans > kCosine) length.add(missing);
    if (std::abs(leans) < kSine) radius.add(missing);
  }
  return {length.value(), radius.value()};
}

}  // namespace rmac::gateway
