#include "gateway/api/state_json.hpp"

#include <algorithm>

namespace rmac::gateway {

namespace {

std::vector<double> first(const auto& values, std::size_t count) {
  return {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count)};
}

double in_us(std::int64_t ns) {
  return static_cast<double>(ns) / 1000;
}

/// What the topic `state` tells of the cycles' times.
nlohmann::json brief(const TimeCounts& counts) {
  return {{"median_us", in_us(counts.quantile_ns(0.5))},
          {"p999_us", in_us(counts.quantile_ns(0.999))},
          {"largest_us", in_us(counts.largest_ns)}};
}

}  // namespace

const char* to_string(Event::Kind kind) noexcept {
  switch (kind) {
    case Event::Kind::MoveStarted:
      return "MoveStarted";
    case Event::Kind::MoveDone:
      return "MoveDone";
    case Event::Kind::Hit:
      return "Hit";
    case Event::Kind::Stopped:
      return "Stopped";
    case Event::Kind::Fault:
      return "Fault";
    case Event::Kind::Authority:
      return "Authority";
    case Event::Kind::Operator:
      return "Operator";
    case Event::Kind::Mechanism:
      return "Mechanism";
    case Event::Kind::CycleStateChanged:
      return "CycleStateChanged";
    case Event::Kind::FlightRecord:
      return "FlightRecord";
    case Event::Kind::FlightRecordFailed:
      return "FlightRecordFailed";
    case Event::Kind::ToolWanted:
      return "ToolWanted";
    case Event::Kind::ToolChanged:
      return "ToolChanged";
    case Event::Kind::ToolChangeDropped:
      return "ToolChangeDropped";
    case Event::Kind::ProgramStopped:
      return "ProgramStopped";
    case Event::Kind::Bus:
      return "Bus";
    case Event::Kind::CollisionAhead:
      return "CollisionAhead";
    case Event::Kind::NotChecked:
      return "NotChecked";
  }
  return "unknown";
}

nlohmann::json event_to_json(const Event& event) {
  nlohmann::json told{{"kind", to_string(event.kind)},
                      {"t_s", event.t_s},
                      {"cycle", event.cycle},
                      {"move_id", event.move_id},
                      {"message", event.message}};
  if (!event.record.empty()) told["record"] = event.record;
  if (event.code != MinorCode::None) told["status_minor"] = static_cast<int>(event.code);
  if (event.hit) {
    const ToolPose& pose = event.hit->pose;
    told["joints"] = event.hit->joints;
    told["pose"] = {pose.tip[0], pose.tip[1], pose.tip[2], pose.axis[0], pose.axis[1], pose.axis[2]};
  }
  return told;
}

nlohmann::json state_to_json(MachinePort& machine, int moves_left, const CycleSample& sample,
                             const MachineStatus& status, const Parties& who) {
  const sdk::DeviceObject* mechanism = machine.mechanism();
  const CycleNow cycle = machine.cycle_now();
  const ToolPose& tool = sample.pose_actual;
  nlohmann::json state{{"t_s", sample.t_s},
                       {"cycle", sample.cycle},
                       {"state", to_string(sample.state)},
                       {"mode", cycle.mode},
                       {"moving", sample.moving},
                       {"move_id", sample.move_id},
                       {"s_mm", sample.s_mm},
                       {"feed_set_mm_min", sample.feed_set_mm_s * 60},
                       {"feed_actual_mm_min", sample.feed_actual_mm_s * 60},
                       {"override_percent", cycle.override_percent},
                       {"pose", {tool.tip[0], tool.tip[1], tool.tip[2], tool.axis[0], tool.axis[1], tool.axis[2]}},
                       {"joints", first(sample.position, sample.joint_count)},
                       {"joints_set", first(sample.position_set, sample.joint_count)},
                       {"held_joints", std::vector<double>(sample.position.begin() + sample.joint_count,
                                                           sample.position.begin() + sample.joint_count_with_held)},
                       {"inputs", sample.inputs},
                       {"outputs", sample.outputs},
                       {"deadline_misses", sample.deadline_misses},
                       {"wake_up", brief(machine.cycle_times().wake_up.read())},
                       {"compute", brief(machine.cycle_times().compute.read())},
                       {"bus", brief(machine.cycle_times().bus.read())},
                       {"moves_in_buffer", moves_left},
                       {"status_major", status.major},
                       {"status_minor", status.minor},
                       {"authority", who.authority},
                       {"operator", who.on_duty},
                       {"held_by", cycle.held_by},
                       {"waits_for", cycle.waits_for},
                       {"optional_stops", cycle.optional_stops},
                       {"stop_prompt", cycle.stop_prompt},
                       {"virtual", machine.device().virtual_mode()}};
  state["horizon_s"] = sample.horizon.s;
  state["horizon_limit"] = to_string(sample.horizon.limit);
  state["cleaned"] = {{"without_motion", cycle.cleaned.without_motion}, {"merged", cycle.cleaned.merged}};
  const ToolsNow tools = machine.tools().tools_now();
  state["tool"] = tools.mounted ? nlohmann::json(*tools.mounted) : nlohmann::json();
  state["tool_wanted"] = tools.wanted ? nlohmann::json(*tools.wanted) : nlohmann::json();
  state["tool_prompt"] = tools.prompt;
  const std::optional<Event>& stop = machine.last_stop();
  state["last_stop"] = stop ? event_to_json(*stop) : nlohmann::json();
  state["last_error"] =
      status.major == 0
          ? nlohmann::json()
          : nlohmann::json{{"status_minor", status.minor}, {"t_s", status.t_s}, {"message", status.message}};
  state["buses"] = machine.bus_summary();
  state["mechanism"] = mechanism == nullptr ? nlohmann::json() : nlohmann::json(mechanism->name);
  const std::size_t spindles =
      mechanism == nullptr ? 0 : std::min(mechanism->spindles.size(), sample.spindle_rpm.size());
  state["spindle_rpm"] = first(sample.spindle_rpm, spindles);
  state["spindle_torque_nm"] = first(sample.spindle_torque_nm, spindles);
  return state;
}

nlohmann::json times_to_json(const TimeCounts& counts) {
  nlohmann::json told = brief(counts);
  told["count"] = counts.count;
  told["p99_us"] = in_us(counts.quantile_ns(0.99));
  told["bins"] = nlohmann::json::array();
  for (std::size_t bin = 0; bin < TimeCounts::kBins; ++bin) {
    if (counts.bins[bin] > 0) told["bins"].push_back({in_us(TimeCounts::end_of(bin)), counts.bins[bin]});
  }
  return told;
}

}  // namespace rmac::gateway
