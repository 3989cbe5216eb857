#pragma once

#include <string>

#include "rmac/motion/error.hpp"
#include "rmac/motion/force_control.hpp"
#include "servo/setpoint/contact_effort.hpp"
#include "servo/setpoint/contact_search.hpp"
#include "servo/setpoint/contact_stiffness.hpp"

namespace rmac {

/// The loop that keeps a joint's contact force (docs/servo.md, "Force"). It goes by velocities of the position's
/// setpoint until there is contact, and on a soft part from then on too. On a stiff one it pushes: by an effort beside
/// that of the joint's law, which is left to damp. Real-time safe.
class ForceLoop {
 public:
  /// `soft`: stiffness up to which the position loop does; of a joint whose drives close its loop themselves it does
  /// for any. N/mm or N·m/deg.
  ForceLoop(const ForceControl& control, double period_s, double soft) noexcept
      : control_(control),
        period_s_(period_s),
        soft_(soft),
        search_(control, period_s),
        effort_(period_s),
        stiffness_(period_s) {}

  struct Seen {
    double wanted = 0;  ///< what the joint is to push with; 0: it is to hold its position
    double measured = 0;
    double position = 0, velocity = 0;  ///< measured
    int bounded = 0;                    ///< sign of the effort that the joint is pushed with as hard as it may be; or 0
  };
  /// One cycle.
  void step(const Seen& seen) noexcept;
  /// That the joint's setpoint is to have.
  [[nodiscard]] double velocity() const noexcept { return velocity_; }
  /// The joint is pushed by effort: it is wanted where it is, and its law damps it.
  [[nodiscard]] bool pushes() const noexcept { return pushes_; }
  /// Beside the law's.
  [[nodiscard]] double effort() const noexcept { return added_; }
  /// What the law is to take for the joint's velocity while it pushes.
  [[nodiscard]] double damped(double velocity) const noexcept;
  [[nodiscard]] ContactState state() const noexcept { return search_.state(); }
  /// It comes upon a part, and contact does not last yet.
  [[nodiscard]] bool bounces() const noexcept {
    return search_.bounces() || (state() == ContactState::Touching && !search_.settled());
  }
  /// It is pushed ever more, or less, and its measured force stays the same.
  [[nodiscard]] bool sensor_hangs() const noexcept;
  /// Way without contact, from the start or from where it was lost.
  [[nodiscard]] double searched() const noexcept { return search_.searched(); }
  /// Begins anew, at rest.
  void restart() noexcept;

 private:
  [[nodiscard]] double target(const Seen& seen) noexcept;
  /// Of what touches: whether it is to be pushed.
  void choose() noexcept;
  void push(const Seen& seen) noexcept;
  /// Of what touches, as far as is known.
  [[nodiscard]] double stiff() const noexcept;
  /// The gain, a unit of stiffness: at most what was given.
  [[nodiscard]] double gain() const noexcept;

  ForceControl control_;
  double period_s_;
  double soft_;
  ContactSearch search_;
  double velocity_ = 0;
  double integral_ = 0;  ///< velocity
  bool pushes_ = false;
  ContactEffort effort_;
  double added_ = 0;                           ///< effort
  double reading_ = 0, added_at_reading_ = 0;  ///< the last force that was another than before it
  ContactStiffness stiffness_;
};

/// What makes no sense in `control`, named; `who` is the joint.
[[nodiscard]] Expected<> check_force_control(const ForceControl& control, const std::string& who);

}  // namespace rmac
