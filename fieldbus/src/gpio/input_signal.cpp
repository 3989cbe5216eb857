#include "rmac/fieldbus/gpio/input_signal.hpp"

namespace rmac::fieldbus::gpio {

void InputSignal::begin(std::size_t contact, bool active, Time now) noexcept {
  contact_[contact] = active;
  active_ = any();
  active_since_ = now;
  // What rests when the lines are claimed has rested before.
  rests_since_ = now - debounce_;
  disagree_since_ = now;
}

void InputSignal::edge(std::size_t contact, bool active, Time at) noexcept {
  if (contact_[contact] == active) set(contact, !active, at);
  set(contact, active, at);
}

void InputSignal::set(std::size_t contact, bool active, Time at) noexcept {
  const bool disagreed = disagree();
  // It may have rested long enough since it was last asked.
  static_cast<void>(this->active(at));
  contact_[contact] = active;
  if (disagree() && !disagreed) disagree_since_ = at;
  if (any()) {
    if (!active_) active_since_ = at;
    active_ = true;
  } else {
    rests_since_ = at;
  }
}

bool InputSignal::active(Time now) noexcept {
  if (!any() && now - rests_since_ >= debounce_) active_ = false;
  return active_;
}

}  // namespace rmac::fieldbus::gpio
