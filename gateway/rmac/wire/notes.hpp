#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gateway/state/cycle_state.hpp"
#include "gateway/state/event.hpp"

namespace rmac::cli {

/// What an appliance pushes to who subscribed to it.
inline constexpr const char* kEventsTopic = "events";
inline constexpr const char* kStateTopic = "state";
inline constexpr const char* kJointsTopic = "joints";

/// What the `events` topic tells. Keys: docs/protocol.md.
struct EventNote {
  std::string kind;
  double t_s = 0;
  std::int64_t move_id = 0, cycle = 0;
  std::string message, record;  ///< record: name of the flight record that shows it

  [[nodiscard]] bool is(gateway::Event::Kind wanted) const;
};

/// What the `state` topic tells. mm, deg, mm/min, rpm.
struct StateNote {
  std::string state, mode;           ///< of the cycle; mode of its last start
  std::string mechanism, authority;  ///< empty: none loaded; nobody holds it
  std::string on_duty, held_by;      ///< operator there, and who holds the machine as one; empty: nobody
  std::string waits_for;             ///< what a cycle that runs waits for; empty: it does not
  bool moving = false, virtual_mode = false;
  std::int64_t move_id = 0;
  int moves_in_buffer = 0, status_minor = 0;
  double t_s = 0, feed_actual = 0, feed_set = 0, override_percent = 0;
  std::string horizon_limit;  ///< why motion is planned no further than `horizon_s`; empty: the appliance does not tell
  double horizon_s = 0;
  std::vector<double> pose, joints, held_joints, spindle_rpm;
  std::vector<double> joints_set;  ///< where they are sent; empty: the appliance does not tell
  std::int64_t deadline_misses = 0;
  double wake_up_p999_us = 0;  ///< of the servo thread, after its cycle was due
  int tool_wanted = 0;         ///< by the tool change that comes next
  std::string tool_prompt;     ///< what a person is asked to do for it; empty: nothing
  std::string stop_prompt;     ///< what a person is to see to before the program goes on; empty: nothing
  EventNote last_stop;         ///< without a kind: none, or it is over
  EventNote last_error;        ///< without a message: none

  [[nodiscard]] bool is(gateway::CycleState wanted) const { return state == gateway::to_string(wanted); }
  [[nodiscard]] bool faulted() const {
    return is(gateway::CycleState::Faulted) || is(gateway::CycleState::EmergencyStop);
  }
  /// What a faulted machine has queued stays until its reset, and moves nothing.
  [[nodiscard]] bool at_rest() const { return !moving && (moves_in_buffer == 0 || faulted()); }
};

/// One cycle of the `joints` topic. mm, deg; feed mm/s.
struct JointSample {
  double t_s = 0;
  std::int64_t cycle = 0, move_id = 0;
  bool moving = false;
  double s_mm = 0, feed_mm_s = 0;
  std::vector<double> pose, position_set, velocity_set, acceleration_set, position, following_error;
};

[[nodiscard]] EventNote read_event(const nlohmann::json& params);
[[nodiscard]] StateNote read_state(const nlohmann::json& params);
[[nodiscard]] std::vector<JointSample> read_joints(const nlohmann::json& params);

}  // namespace rmac::cli
