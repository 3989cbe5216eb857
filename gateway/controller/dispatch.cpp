#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "gateway/controller/controller_impl.hpp"
#include "gateway/events/fault_text.hpp"
#include "rmac/sdk/servo_law_names.hpp"

namespace rmac::gateway {

void Controller::Impl::tell(Event event) {
  if (event.kind == Event::Kind::Fault && recorder) {
    if (auto name = record(FlightCause::Fault, event)) {
      event.record = std::move(*name);
    } else {
      event.message += "; it is not recorded: " + name.error().message;
    }
  }
  if (event.kind == Event::Kind::Fault || event.kind == Event::Kind::Stopped) last_stop = event;
  if (event.kind == Event::Kind::ToolChanged || event.kind == Event::Kind::ToolChangeDropped) {
    if (auto kept = cam.keep_mounted(); !kept) event.message += "; that is not kept: " + kept.error().message;
  }
  for (const auto& listener : event_listeners) listener(event);
}

void Controller::Impl::deliver_samples_until(std::int64_t cycle) {
  while (!waiting_samples.empty() && waiting_samples.front().cycle <= cycle) {
    const CycleSample sample = waiting_samples.front();
    waiting_samples.pop_front();
    tell_events_before(sample.cycle);
    for (const auto& listener : sample_listeners) listener(sample);
    ledger.read(sample, [this](const Event& event) { tell(event); });
    measuring.read(sample, [this](Event event) { tell(std::move(event)); });
  }
}

void Controller::Impl::take_events(const std::vector<Event>& events) {
  FaultRecord record;
  while (link->faults.pop(record)) {
    const Mechanism* mechanism = in_force && record.generation == generation ? in_force.get() : nullptr;
    waiting_events.push_back({Event::Kind::Fault,
                              record.t_s,
                              record.move_id,
                              describe(record.fault, mechanism),
                              record.cycle,
                              {},
                              code_of(record.fault.kind)});
  }
  waiting_events.insert(waiting_events.end(), events.begin(), events.end());
  std::ranges::stable_sort(waiting_events, {}, &Event::cycle);
}

void Controller::Impl::tell_events_before(std::int64_t cycle) {
  while (!waiting_events.empty() && waiting_events.front().cycle < cycle) {
    Event event = std::move(waiting_events.front());
    waiting_events.pop_front();
    tell(std::move(event));
  }
}

Expected<std::string> Controller::Impl::record(FlightCause cause, const Event& event) {
  if (!recorder) {
    return failure(MinorCode::Other, "no flight records are made; give flight_recorder seconds above 0 in rmacd.json");
  }
  if (!in_force) return failure(MinorCode::Other, "there is nothing to record: no mechanism is loaded");
  FlightHead head;
  head.cause = cause;
  head.message = event.message;
  head.cycle = event.cycle;
  head.t_s = event.t_s;
  head.mechanism = in_force->device.name;
  for (const auto* joints : {&in_force->device.joints, &in_force->device.held_joints}) {
    for (const sdk::Joint& joint : *joints) {
      head.joints.push_back({joint.limits.name, joint.limits.type == JointType::Rotary ? "deg" : "mm",
                             sdk::servo_law_module(joint.servo_law.name), joint.gains, joint.servo_law.numbers,
                             joint.limits.max_speed, joint.limits.max_acceleration, joint.max_effort});
    }
  }
  return recorder->request(std::move(head));
}

void Controller::Impl::tell_records() {
  if (!recorder) return;
  for (const auto& [head, written] : recorder->take_outcomes()) {
    Event event{Event::Kind::FlightRecord, head.t_s, 0, {}, head.cycle, head.name};
    if (written) {
      event.message = fmt::format("flight record {}: cycles {} to {}", head.name, head.first_cycle, head.last_cycle);
    } else {
      event.kind = Event::Kind::FlightRecordFailed;
      event.message = fmt::format(
          "flight record {} was not written: {}; free its disk, or choose another folder with "
          "flight_recorder in rmacd.json. The machine is not touched by it",
          head.name, written.error().message);
    }
    tell(std::move(event));
  }
}

void Controller::Impl::dispatch() {
  // News first, samples second: then every sample that a piece of news follows from is among them, and told before it.
  const MotionSupervisor::News news = supervisor.take_news();
  drain();
  take_events(news.events);
  using Kind = QueueChange::Kind;
  for (const QueueChange& change : news.queue) {
    if (change.kind == Kind::Added || change.kind == Kind::Still) {
      ledger.add(change.move_id, change.kind == Kind::Still, change.part);
      continue;
    }
    deliver_samples_until(change.cycle);
    if (change.kind == Kind::Cleared) {
      ledger.clear();
    } else {
      ledger.restart();
    }
  }
  constexpr auto kAll = std::numeric_limits<std::int64_t>::max();
  deliver_samples_until(kAll);
  tell_events_before(kAll);
  tell_records();
  measuring.advance();
}

}  // namespace rmac::gateway
