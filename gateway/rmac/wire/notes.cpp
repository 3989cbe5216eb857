#include "gateway/rmac/wire/notes.hpp"

#include <string_view>

#include "gateway/api/state_json.hpp"

namespace rmac::cli {

namespace {

// A key that an older or newer appliance does not send leaves its default: watching must not end for want of one value.
template <typename T>
void read(const nlohmann::json& object, std::string_view key, T& value) {
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
  read(params, "kind", event.kind);
  read(params, "t_s", event.t_s);
  read(params, "move_id", event.move_id);
  read(params, "cycle", event.cycle);
  read(params, "message", event.message);
  read(params, "record", event.record);
  return event;
}

StateNote read_state(const nlohmann::json& params) {
  StateNote state;
  read(params, "state", state.state);
  read(params, "mode", state.mode);
  read(params, "mechanism", state.mechanism);
  read(params, "authority", state.authority);
  read(params, "operator", state.on_duty);
  read(params, "held_by", state.held_by);
  read(params, "waits_for", state.waits_for);
  read(params, "moving", state.moving);
  read(params, "virtual", state.virtual_mode);
  read(params, "move_id", state.move_id);
  read(params, "moves_in_buffer", state.moves_in_buffer);
  read(params, "status_minor", state.status_minor);
  read(params, "t_s", state.t_s);
  read(params, "feed_actual_mm_min", state.feed_actual);
  read(params, "feed_set_mm_min", state.feed_set);
  read(params, "override_percent", state.override_percent);
  read(params, "horizon_s", state.horizon_s);
  read(params, "horizon_limit", state.horizon_limit);
  read(params, "pose", state.pose);
  read(params, "joints", state.joints);
  read(params, "held_joints", state.held_joints);
  read(params, "spindle_rpm", state.spindle_rpm);
  read(params, "deadline_misses", state.deadline_misses);
  if (const auto late = params.find("wake_up"); late != params.end()) read(*late, "p999_us", state.wake_up_p999_us);
  read(params, "tool_wanted", state.tool_wanted);
  read(params, "tool_prompt", state.tool_prompt);
  read(params, "stop_prompt", state.stop_prompt);
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
    read(entry, "t_s", sample.t_s);
    read(entry, "cycle", sample.cycle);
    read(entry, "move_id", sample.move_id);
    read(entry, "s_mm", sample.s_mm);
    read(entry, "feed_mm_s", sample.feed_mm_s);
    read(entry, "moving", sample.moving);
    read(entry, "pose", sample.pose);
    read(entry, "q", sample.position_set);
    read(entry, "qd", sample.velocity_set);
    read(entry, "qdd", sample.acceleration_set);
    read(entry, "a", sample.position);
    samples.push_back(std::move(sample));
  }
  return samples;
}

}  // namespace rmac::cli
