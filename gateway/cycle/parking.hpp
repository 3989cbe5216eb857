#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "gateway/cycle/machine_cycle.hpp"

namespace rmac::gateway {

/// The program that is set aside: what was held, and goes on from its place later, in the frames in force then. Gateway
/// thread: the parked program is that thread's alone, and no lock's.
class Parking {
 public:
  struct Program {
    std::string mechanism;
    bool virtual_mode = false;
    std::deque<ProgramStep> steps;
    sdk::CycleMode mode = sdk::CycleMode::Automatic;
    StandingWishes::TurnedOff turned_off;
    double override_percent = 100;
    ToolPose place;                    ///< part frame; where the first step goes on
    std::vector<double> place_joints;  ///< under the frames that were in force
  };

  explicit Parking(MachineCycle& cycle) : cycle_(cycle) {}

  /// Sets the queue aside; the spindles and `outputs_off` (the coolant) go off.
  [[nodiscard]] Expected<> park(std::uint64_t outputs_off);
  [[nodiscard]] const std::optional<Program>& parked() const noexcept { return parked_; }
  /// Queues the way to where the first step goes on, and what is left of that step. From rest, with an empty queue.
  [[nodiscard]] Expected<> add_rest_of(const ProgramStep& first);
  /// All steps are queued again: holds them, as before. False when a stop emptied the queue meanwhile.
  [[nodiscard]] bool hold_taken_up();
  /// Empties the queue of what was taken up in part.
  void drop_taken_up();
  /// Forgets the parked program, if there is one, and tells why.
  void drop(const std::string& why);

 private:
  [[nodiscard]] Expected<> check_references() EXCLUDES(cycle_.lock);
  [[nodiscard]] Expected<> check_held(const ServoStatus& now) REQUIRES(cycle_.lock);

  MachineCycle& cycle_;
  std::optional<Program> parked_;
};

}  // namespace rmac::gateway
