#include "servo/setpoint/contact_search.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {
namespace {

/// A joint of some kilograms that is thrown back comes down again within the first; in contact for the second, it
/// stays.
constexpr double kBounce_s = 0.02, kSettled_s = 0.01;
/// Who bounces for so long draws back for so long.
constexpr double kMostBouncing_s = 0.2, kDrawsBack_s = 0.05;
/// What presses for longer while it draws back is a sensor that hangs.
constexpr double kMostLettingGo_s = 1;
constexpr double kGentlest = 1.0 / 64;  ///< part of the approach speed

}  // namespace

ContactSearch::ContactSearch(const ForceControl& control, double period_s) noexcept
    : control_(control), period_s_(period_s) {}

void ContactSearch::step(double wanted, double measured, double velocity) noexcept {
  if (wanted == 0) return hold(measured);
  if (towards_ * wanted < 0) restart();  // what it touched is behind it
  towards_ = std::copysign(1.0, wanted);
  draws_back_s_ = std::max(0.0, draws_back_s_ - period_s_);
  const ContactState before = state_;
  state_ = next(towards_ * measured);
  if (state_ == ContactState::Touching) {
    touched_s_ = before == state_ ? touched_s_ + period_s_ : 0;
    if (settled()) unsettled_s_ = 0, part_ = 1;
  } else {
    if (before != state_) searched_ = 0;
    if (before == ContactState::Touching) lost_s_ = 0;
    searched_ += std::abs(velocity) * period_s_;
    lost_s_ += period_s_;
  }
  if (settled() || (state_ == ContactState::Approaching && !bounces())) {
    unsettled_s_ = 0;
  } else if ((unsettled_s_ += period_s_) > kMostBouncing_s) {
    state_ = ContactState::Approaching;
    unsettled_s_ = 0;
    draws_back_s_ = kDrawsBack_s;
    part_ = std::max(part_ / 2, kGentlest);
  }
}

void ContactSearch::hold(double measured) noexcept {
  const double letting_go = letting_go_s_ + period_s_;
  const bool touches = towards_ * measured >= control_.contact_force / 2 && letting_go < kMostLettingGo_s;
  const double left = touches ? draws_back_s_ : std::max(0.0, draws_back_s_ - period_s_);
  const double towards = towards_;
  restart();
  draws_back_s_ = left;
  letting_go_s_ = letting_go;
  towards_ = towards;
}

void ContactSearch::let_go() noexcept {
  draws_back_s_ = kDrawsBack_s;
  letting_go_s_ = 0;
}

ContactState ContactSearch::next(double pushed) const noexcept {
  const double least = state_ == ContactState::Touching ? control_.contact_force / 2 : control_.contact_force;
  return pushed >= least && draws_back_s_ == 0 ? ContactState::Touching : ContactState::Approaching;
}

double ContactSearch::velocity() const noexcept {
  if (state_ == ContactState::Holding && draws_back_s_ == 0) return 0;
  return (draws_back_s_ > 0 ? -1 : part_) * towards_ * control_.approach_speed;
}

bool ContactSearch::settled() const noexcept {
  return state_ == ContactState::Touching && touched_s_ >= kSettled_s;
}

bool ContactSearch::bounces() const noexcept {
  return state_ == ContactState::Approaching && lost_s_ < kBounce_s && draws_back_s_ == 0;
}

}  // namespace rmac
