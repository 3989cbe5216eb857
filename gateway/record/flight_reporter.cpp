#include "gateway/record/flight_reporter.hpp"

#include <fmt/format.h>

#include "rmac/sdk/servo_law_names.hpp"

namespace rmac::gateway {

FlightReporter::FlightReporter(const FlightRecorderOptions& options, double period_s, CycleHistory& history,
                               std::function<nlohmann::json()> buses_now)
    : buses_now_(std::move(buses_now)) {
  if (options.wanted()) recorder_ = std::make_unique<FlightRecorder>(options, period_s, history);
}

Expected<std::string> FlightReporter::record(FlightCause cause, const Event& event, const sdk::DeviceObject* device) {
  if (!recorder_) {
    return failure(MinorCode::Other, "no flight records are made; give flight_recorder seconds above 0 in rmacd.json");
  }
  if (device == nullptr) return failure(MinorCode::Other, "there is nothing to record: no mechanism is loaded");
  FlightHead head;
  head.cause = cause;
  head.message = event.message;
  head.cycle = event.cycle;
  head.t_s = event.t_s;
  if (buses_now_) head.buses = buses_now_();
  head.mechanism = device->name;
  for (std::size_t j = 0; j < device->joint_count_with_held(); ++j) {
    const sdk::Joint& joint = joint_at(*device, j);
    head.joints.push_back({joint.limits.name, joint.limits.type == JointType::Rotary ? "deg" : "mm",
                           sdk::servo_law_module(joint.servo_law.name), joint.gains, joint.servo_law.numbers,
                           joint.limits.max_speed, joint.limits.max_acceleration, joint.max_effort,
                           joint.mechanics.resonances, joint.mechanics.low_pass_hz});
  }
  for (const sdk::Actuator& actuator : device->actuators) {
    head.actuators.push_back({actuator.scale, actuator.cogging});
  }
  return recorder_->request(std::move(head));
}

void FlightReporter::annotate(Event& event, const sdk::DeviceObject* device) {
  if (event.kind != Event::Kind::Fault || !recorder_) return;
  if (auto name = record(FlightCause::Fault, event, device)) {
    event.record = std::move(*name);
  } else {
    event.message += "; it is not recorded: " + name.error().message;
  }
}

std::vector<Event> FlightReporter::take_events() {
  std::vector<Event> events;
  if (!recorder_) return events;
  for (const auto& [head, written] : recorder_->take_outcomes()) {
    Event& event = events.emplace_back(Event{Event::Kind::FlightRecord, head.t_s, 0, {}, head.cycle, head.name});
    if (written) {
      event.message = fmt::format("flight record {}: cycles {} to {}", head.name, head.first_cycle, head.last_cycle);
      continue;
    }
    event.kind = Event::Kind::FlightRecordFailed;
    event.message = fmt::format(
        "flight record {} was not written: {}; free its disk, or choose another folder with "
        "flight_recorder in rmacd.json. The machine is not touched by it",
        head.name, written.error().message);
  }
  return events;
}

}  // namespace rmac::gateway
