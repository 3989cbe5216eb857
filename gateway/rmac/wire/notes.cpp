#include "gateway/rmac/wire/notes.hpp"

#include <string_view>

#include "gateway/api/state_json.hpp"

namespace rmac::cli {

namespace {

// A key that an older or newer appliance does not send leaves its default: watching must not end for want of one value.
template <typename T>
void read_key(const nlohmann::json& object, std::string_view key, T& value) {
  if (const auto entry = object.find(key); entry != object.end() && !entry->is_null()) {
    try {
      entry->get_to(value);
    } catch (const nlohmann::json::exception&) {
      // Same: another type than expected.
    }
  }
}

}  // namespace

bool EventNote::is(gateway::Event::Kind wanted) const {
  return kind == gateway::to_string(wanted);
}

EventNote read_event(const nlohmann::json& params) {
  EventNote event;
  read_key(params, "kind", event.kind);
  read_key(params, "t_s", event.t_s);
  read_key(params, "move_id", event.move_id);
  read_key(params, "cycle", event.cycle);
  read_key(params, "message", event.message);
  read_key(params, "record", event.record);
  return event;
}

StateNote read_state(const nlohmann::json& params) {
  StateNote state;
  read_key(params, "state", state.state);
  read_key(params, "mode", state.mode);
  read_key(params, "mechanism", state.mechanism);
  read_key(params, "authority", state.authority);
  read_key(params, "operator", state.on_duty);
  read_key(params, "held_by", state.held_by);
  read_key(params, "waits_for", state.waits_for);
  read_key(params, "moving", state.moving);
  read_key(params, "virtual", state.virtual_mode);
  read_key(params, "move_id", state.move_id);
  read_key(params, "moves_in_buffer", state.moves_in_buffer);
  read_key(params, "status_minor", state.status_minor);
  read_key(params, "t_s", state.t_s);
  read_key(params, "feed_actual_mm_min", state.feed_actual);
  read_key(params, "feed_set_mm_min", state.feed_set);
  read_key(params, "override_percent", state.override_percent);
  read_key(params, "horizon_s", state.horizon_s);
  read_key(params, "horizon_limit", state.horizon_limit);
  read_key(params, "pose", state.pose);
  read_key(params, "joints", state.joints);
  read_key(params, "joints_set", state.joints_set);
  read_key(params, "held_joints", state.held_joints);
  read_key(params, "spindle_rpm", state.spindle_rpm);
  read_key(params, "deadline_misses", state.deadline_misses);
  if (const auto late = params.find("wake_up"); late != params.end()) read_key(*late, "p999_us", state.wake_up_p999_us);
  read_key(params, "tool_wanted", state.tool_wanted);
  read_key(params, "tool_prompt", state.tool_prompt);
  read_key(params, "stop_prompt", state.stop_prompt);
  if (const auto stop = params.find("last_stop"); stop != params.end() && stop->is_object()) {
    state.last_stop = read_event(*stop);
  }
  if (const auto error = params.find("last_error"); error != params.end() && error->is_object()) {
    state.last_error = read_event(*error);
  }
  return state;
}

std::vector<JointSample> read_joints(const nlohmann::json& params) {
  std::vector<JointSample> samples;
  const auto list = params.find("samples");
  if (list == params.end()) {
    return samples;
  }
  for (const auto& entry : *list) {
    JointSample sample;
    read_key(entry, "t_s", sample.t_s);
    read_key(entry, "cycle", sample.cycle);
    read_key(entry, "move_id", sample.move_id);
    read_key(entry, "s_mm", sample.s_mm);
    read_key(entry, "feed_mm_s", sample.feed_mm_s);
    read_key(entry, "moving", sample.moving);
    read_key(entry, "pose", sample.pose);
    read_key(entry, "q", sample.position_set);
    read_key(entry, "qd", sample.velocity_set);
    read_key(entry, "qdd", sample.acceleration_set);
    read_key(entry, "a", sample.position);
    read_key(entry, "error", sample.following_error);
    samples.push_back(std::move(sample));
  }
  return samples;
}

}  // namespace rmac::cli
