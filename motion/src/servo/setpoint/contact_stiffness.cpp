#include "servo/setpoint/contact_stiffness.hpp"

#include <cmath>

namespace rmac {
namespace {

/// What is faster tells nothing, as the joint and its load swing against each other there; nor what is slower, as
/// friction creeps.
constexpr double kFast_s = 0.004, kSlow_s = 0.04;
constexpr double kLeastWay = 0.002;  ///< mm or deg; less is noise of encoders
constexpr double kEnoughWay = 0.01;  ///< root of the sum of squares
/// So long the joint comes upon a surface, and for the second at most if it does so slowly. From then on the surface
/// moves too, as it waves, which makes it look softer.
constexpr double kComes_s = 0.05, kComesSlowly_s = 0.3;
constexpr double kMemory_s = 0.1;  ///< of motion; at rest nothing is forgotten

}  // namespace

ContactStiffness::ContactStiffness(double period_s) noexcept : period_s_(period_s) {}

void ContactStiffness::step(double position, double force) noexcept {
  touching_s_ += period_s_;
  if (!begun_) {
    begun_ = true;
    fast_position_ = slow_position_ = position;
    fast_force_ = slow_force_ = force;
    return;
  }
  const double fast = period_s_ / (period_s_ + kFast_s), part = period_s_ / kSlow_s;
  fast_position_ += fast * (position - fast_position_);
  fast_force_ += fast * (force - fast_force_);
  const double way = fast_position_ - slow_position_, change = fast_force_ - slow_force_;
  // At first all that the joint went since it came upon the surface tells, however slowly it went.
  const bool comes = touching_s_ < (found_ ? kComes_s : kComesSlowly_s);
  if (found_ || !comes) {
    slow_position_ += part * way;
    slow_force_ += part * change;
  }
  if (std::abs(way) < kLeastWay) return;
  const double kept = 1 - period_s_ / kMemory_s;
  way_squared_ = kept * way_squared_ + way * way;
  way_force_ = kept * way_force_ + way * change;
  if (way_squared_ < kEnoughWay * kEnoughWay || way_force_ <= 0) return;
  const double seen = way_force_ / way_squared_;
  if (comes || (found_ && seen > *found_)) found_ = seen;
}

}  // namespace rmac
