#pragma once

#include <cstdint>
#include <utility>
#include <variant>

#include "gateway/state/cycle_state.hpp"
#include "gateway/state/operator.hpp"
#include "gateway/state/stop_cause.hpp"

namespace rmac::gateway {

/// Where the cycle is, and what runs there: one alternative at a time, so that a retrace that is held, a homing that is
/// faulted or an idle machine that is about to empty its queue cannot be written down. An operator's hold is a part of
/// each state in which nothing but a way back runs: a program that runs under one cannot be written down either.
class CyclePhase {
 public:
  // What runs.
  struct Program {
    bool search_ends = false;  ///< the probe touched: at rest the rest of the queue, a search, is dropped
  };
  struct Positioning {};
  /// Lasts while it is renewed.
  struct Jog {
    double until_s = 0;
  };
  struct Retrace {
    OperatorRef held_by{};  ///< who holds it at its end
  };
  struct Homing {
    std::uint32_t homings_before = 0;
  };
  /// What is done at the end of a stop. What is left of a jog is no part of a program: it is always dropped.
  enum class StopEnd : std::uint8_t { KeepQueue, DropSearch, EmptyQueue, DropPositioning };

  struct Idle {
    OperatorRef held_by;  ///< here and below: the operator before whose word nothing starts; null: there is none
  };
  struct Running {
    std::variant<Program, Positioning, Jog, Retrace, Homing> what;
  };
  struct Holding {
    std::variant<Program, Positioning, Jog> what;
    OperatorRef held_by{};
  };
  struct Stopping {
    StopCause cause = StopCause::CycleStop;
    StopEnd end = StopEnd::KeepQueue;
    OperatorRef held_by{};
  };
  struct Faulted {
    bool emergency_stop = false;
    OperatorRef held_by{};
  };

  [[nodiscard]] CycleState state() const noexcept;
  template <typename State>
  [[nodiscard]] const State* in() const noexcept {
    return std::get_if<State>(&state_);
  }
  /// What runs, if it is a `What`.
  template <typename What>
  [[nodiscard]] const What* runs() const noexcept {
    const Running* const running = in<Running>();
    return running == nullptr ? nullptr : std::get_if<What>(&running->what);
  }
  /// What is held, if it is a `What`.
  template <typename What>
  [[nodiscard]] const What* holds() const noexcept {
    const Holding* const holding = in<Holding>();
    return holding == nullptr ? nullptr : std::get_if<What>(&holding->what);
  }
  /// The operator who holds the machine; null: none does.
  [[nodiscard]] OperatorRef held_by() const noexcept;
  /// A jog that lasts while it is renewed is under way, and not yet told to stop.
  [[nodiscard]] bool jogs() const noexcept { return runs<Jog>() != nullptr; }
  [[nodiscard]] bool homes() const noexcept { return runs<Homing>() != nullptr; }
  /// A move outside of the cycle runs, is held, or comes to rest.
  [[nodiscard]] bool positions() const noexcept;
  /// The probe touched, and the search under way comes to rest.
  [[nodiscard]] bool ends_search() const noexcept;
  /// A stop is under way at whose end the queue is emptied.
  [[nodiscard]] bool empties_queue() const noexcept;

  template <typename What>
  void run(What what) noexcept {
    state_ = Running{std::move(what)};
  }
  /// What is held becomes a program, a search with its end.
  void run_program() noexcept { run(Program{ends_search()}); }
  void hold_program() noexcept { state_ = Holding{Program{}, held_by()}; }
  /// Holds what runs; a homing, which has no path to go on with, stops. Without effect elsewhere.
  void hold() noexcept;
  /// The same, and from now on nothing starts before the operator's word, whatever the state.
  void hold_for(const OperatorRef& who) noexcept;
  /// The operator's hold becomes one of the program's, where there is one; nothing moves. True when there was one.
  bool let_go() noexcept;
  /// What is held runs on. Without effect elsewhere.
  void resume() noexcept;
  /// Stops what runs or is held. Without effect elsewhere.
  void stop(StopCause cause) noexcept;
  /// Stops from anywhere but a fault, and empties the queue.
  void stop_and_clear(StopCause cause) noexcept;
  /// The probe has touched.
  void touch() noexcept;
  /// The search under way, if it was to end, is gone.
  void forget_search() noexcept;
  /// An emergency stop is not made less by a fault.
  void fault(bool emergency_stop) noexcept;
  void rest() noexcept { state_ = Idle{held_by()}; }

 private:
  std::variant<Idle, Running, Holding, Stopping, Faulted> state_;
};

}  // namespace rmac::gateway
