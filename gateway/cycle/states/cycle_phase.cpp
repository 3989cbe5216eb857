#include "gateway/cycle/states/cycle_phase.hpp"

namespace rmac::gateway {

CycleState CyclePhase::state() const noexcept {
  struct Name {
    CycleState operator()(const Idle&) const noexcept { return CycleState::Idle; }
    CycleState operator()(const Running&) const noexcept { return CycleState::Running; }
    CycleState operator()(const Holding&) const noexcept { return CycleState::Holding; }
    CycleState operator()(const Stopping&) const noexcept { return CycleState::Stopping; }
    CycleState operator()(const Faulted& faulted) const noexcept {
      return faulted.emergency_stop ? CycleState::EmergencyStop : CycleState::Faulted;
    }
  };
  return std::visit(Name{}, state_);
}

OperatorRef CyclePhase::held_by() const noexcept {
  if (const Retrace* const back = runs<Retrace>()) return back->held_by;
  return std::visit(
      [](const auto& state) -> OperatorRef {
        if constexpr (requires { state.held_by; }) return state.held_by;
        return {};
      },
      state_);
}

bool CyclePhase::positions() const noexcept {
  if (runs<Positioning>() || runs<Jog>() || runs<Homing>() || holds<Positioning>() || holds<Jog>()) return true;
  const Stopping* const stopping = in<Stopping>();
  return stopping != nullptr && stopping->end == StopEnd::DropPositioning;
}

bool CyclePhase::ends_search() const noexcept {
  if (const Program* const running = runs<Program>()) return running->search_ends;
  if (const Program* const held = holds<Program>()) return held->search_ends;
  const Stopping* const stopping = in<Stopping>();
  return stopping != nullptr && stopping->end == StopEnd::DropSearch;
}

bool CyclePhase::empties_queue() const noexcept {
  const Stopping* const stopping = in<Stopping>();
  return stopping != nullptr && (stopping->end == StopEnd::EmptyQueue || stopping->end == StopEnd::DropPositioning);
}

void CyclePhase::hold() noexcept {
  if (in<Running>() == nullptr) return;
  if (runs<Homing>()) {
    stop(StopCause::JogEnded);
  } else if (const Jog* const jog = runs<Jog>()) {
    state_ = Holding{*jog};
  } else if (runs<Positioning>()) {
    state_ = Holding{Positioning{}};
  } else {
    state_ = Holding{Program{ends_search()}, held_by()};  // a retrace ends
  }
}

void CyclePhase::hold_for(const OperatorRef& who) noexcept {
  hold();
  std::visit(
      [&who](auto& state) {
        if constexpr (requires { state.held_by; }) state.held_by = who;
      },
      state_);
}

bool CyclePhase::let_go() noexcept {
  if (!held_by()) return false;
  if (runs<Retrace>()) {
    run(Retrace{});
  } else {
    hold_for({});
  }
  return true;
}

void CyclePhase::resume() noexcept {
  const Holding* const holding = in<Holding>();
  if (holding == nullptr) return;
  state_ = std::visit([](const auto& held) { return Running{held}; }, holding->what);
}

void CyclePhase::stop(StopCause cause) noexcept {
  if (in<Running>() == nullptr && in<Holding>() == nullptr) return;
  state_ = Stopping{cause,
                    positions()     ? StopEnd::DropPositioning
                    : ends_search() ? StopEnd::DropSearch
                                    : StopEnd::KeepQueue,
                    held_by()};
}

void CyclePhase::stop_and_clear(StopCause cause) noexcept {
  if (in<Faulted>() != nullptr) return;
  state_ = Stopping{cause, positions() ? StopEnd::DropPositioning : StopEnd::EmptyQueue, held_by()};
}

void CyclePhase::touch() noexcept {
  if (positions()) {
    state_ = Stopping{StopCause::HitByHand, StopEnd::DropPositioning, held_by()};
  } else if (runs<Program>()) {
    run(Program{.search_ends = true});
  } else if (holds<Program>() || runs<Retrace>()) {
    state_ = Holding{Program{.search_ends = true}, held_by()};
  } else if (const Stopping* const stopping = in<Stopping>(); stopping && stopping->end == StopEnd::KeepQueue) {
    state_ = Stopping{stopping->cause, StopEnd::DropSearch, held_by()};
  }
  // An idle machine has come to its search's end: nothing is left to drop.
}

void CyclePhase::forget_search() noexcept {
  if (!ends_search()) return;
  if (runs<Program>()) {
    run(Program{});
  } else if (const Stopping* const stopping = in<Stopping>()) {
    state_ = Stopping{stopping->cause, StopEnd::KeepQueue, held_by()};
  } else {
    hold_program();
  }
}

void CyclePhase::fault(bool emergency_stop) noexcept {
  if (state() != CycleState::EmergencyStop) state_ = Faulted{emergency_stop, held_by()};
}

}  // namespace rmac::gateway
