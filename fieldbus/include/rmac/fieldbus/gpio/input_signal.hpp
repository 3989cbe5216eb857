#pragma once

#include <array>

#include "rmac/fieldbus/gpio/line_port.hpp"

namespace rmac::fieldbus::gpio {

/// One input: a switch with one contact, or with two that say the same (one closes when the other opens). It is active
/// from the first edge on that says so, and rests when all its contacts have rested for as long as the debounce time:
/// a switch that bounces is one that acts at once and lets go late. No edge is too short to count.
class InputSignal {
 public:
  /// `contacts`: 1 or 2. Two that disagree for longer than `disagreement` have a broken wire between them.
  InputSignal(std::size_t contacts, Time debounce, Time disagreement) noexcept
      : contacts_(contacts), debounce_(debounce), disagreement_(disagreement) {}

  /// What a contact is when the lines are claimed.
  void begin(std::size_t contact, bool active, Time now) noexcept;
  /// An edge of a contact, which is active after it or not. One that leaves the contact as it was known hides another
  /// edge before it.
  void edge(std::size_t contact, bool active, Time at) noexcept;

  /// Edges until `now` were told.
  [[nodiscard]] bool active(Time now) noexcept;
  /// Since when it has been active, on the clock of its edges, while it is.
  [[nodiscard]] Time active_since() const noexcept { return active_since_; }
  [[nodiscard]] bool broken(Time now) const noexcept { return disagree() && now - disagree_since_ > disagreement_; }

 private:
  [[nodiscard]] bool any() const noexcept { return contact_[0] || (contacts_ == 2 && contact_[1]); }
  [[nodiscard]] bool disagree() const noexcept { return contacts_ == 2 && contact_[0] != contact_[1]; }
  void set(std::size_t contact, bool active, Time at) noexcept;

  std::size_t contacts_;
  Time debounce_;
  Time disagreement_;
  std::array<bool, 2> contact_{};
  bool active_ = false;
  Time active_since_{};
  Time rests_since_{};
  Time disagree_since_{};
};

}  // namespace rmac::fieldbus::gpio
