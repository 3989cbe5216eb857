#pragma once

#include <limits>

#include "rmac/motion/force_control.hpp"

namespace rmac {

/// Whether a joint touches, and how it comes to do so. One that bounces off a part for long draws back, and comes again
/// at half the speed. Real-time safe.
class ContactSearch {
 public:
  ContactSearch(const ForceControl& control, double period_s) noexcept;

  /// One cycle: what the joint is wanted to push with, what it does, and the velocity that it went with.
  void step(double wanted, double measured, double velocity) noexcept;
  [[nodiscard]] ContactState state() const noexcept { return state_; }
  /// By which contact is looked for, or let go of; 0: the joint holds.
  [[nodiscard]] double velocity() const noexcept;
  /// Where no force is wanted: draws back from what it touches, and a little further.
  void let_go() noexcept;
  /// Contact has lasted for longer than one bounce.
  [[nodiscard]] bool settled() const noexcept;
  /// Contact was lost a moment ago, and most likely comes back by itself.
  [[nodiscard]] bool bounces() const noexcept;
  /// Way without contact, from the start or from where it was lost.
  [[nodiscard]] double searched() const noexcept { return searched_; }
  /// Begins anew, at rest.
  void restart() noexcept { *this = ContactSearch(control_, period_s_); }

 private:
  void hold(double measured) noexcept;
  [[nodiscard]] ContactState next(double pushed) const noexcept;

  ForceControl control_;
  double period_s_;
  ContactState state_ = ContactState::Holding;
  double towards_ = 1;  ///< sign of the wanted force
  double searched_ = 0;
  double touched_s_ = 0;                                     ///< since contact began the last time
  double lost_s_ = std::numeric_limits<double>::infinity();  ///< since it was lost
  double unsettled_s_ = 0;                                   ///< since the first contact of those that did not last
  double draws_back_s_ = 0;                                  ///< that are left of it
  double letting_go_s_ = 0;                                  ///< since `let_go`
  double part_ = 1;                                          ///< of the approach speed
};

}  // namespace rmac
