#include <algorithm>

#include "canopen/canopen_interface_impl.hpp"
#include "canopen/drives/drive_of_node.hpp"
#include "canopen/pdo.hpp"

namespace rmac::fieldbus::canopen {
namespace {

/// More frames than this in one cycle are left for the next: the cycle has a deadline.
constexpr int kMostFramesPerCycle = 512;

}  // namespace

bool CanopenInterface::receive(std::span<DriveFeedback> feedback) noexcept {
  Impl& bus = *impl_;
  if (!bus.running) {
    std::fill(feedback.begin(), feedback.end(), DriveFeedback{});
    return true;
  }
  const std::chrono::nanoseconds now = bus.port->now();
  if (bus.fresh) {
    for (BusNode& node : bus.nodes) node.heard = now;
    for (BusAxis& axis : bus.axes) {
      axis.feedback = {};
      axis.forget();
      for (BusAxis::Answer& answer : axis.answers) answer.unanswered = 0;
    }
    for (BusNode& node : bus.nodes) node.was_present = false;
    bus.next_heartbeat = bus.next_time = now;
  }
  ++bus.counters.cycles;
  bus.fetch(now);
  // What another master said before, nobody knows when.
  if (std::exchange(bus.fresh, false)) bus.other_master.forget();
  bus.watch(now);
  bus.take_positions();
  bus.fill(feedback);
  bus.note_silence(feedback);
  const bool sound = bus.sound(now);
  bus.synced = bus.config.sync != SyncOrder::First || bus.send(sync_frame());
  return sound;
}

bool CanopenInterface::send(std::span<const DriveCommand> commands) noexcept {
  Impl& bus = *impl_;
  if (!bus.running) return true;
  const std::chrono::nanoseconds now = bus.port->now();
  const bool sent = bus.send_cycle(commands, now);
  bus.ask_positions(commands, now);
  bus.send_asides(now);
  bus.record.note(bus.counters, bus.port->health(), now);
  if (!bus.sound(now)) return false;
  if (!sent) bus.trouble.note(bus.port->health(), bus.counters.unsent);
  return sent;
}

bool CanopenInterface::Impl::sound(std::chrono::nanoseconds now) noexcept {
  const CanHealth health = port->health();
  const bool other_sync = other_master.sends_sync(now);
  if (health.usable() && !other_sync) return true;
  trouble.note(health, counters.unsent, other_sync);
  return false;
}

void CanopenInterface::Impl::fetch(std::chrono::nanoseconds now) noexcept {
  CanFrame frame;
  for (int i = 0; i < kMostFramesPerCycle && port->receive(frame); ++i) take(frame, now);
}

void CanopenInterface::Impl::take(const CanFrame& frame, std::chrono::nanoseconds now) noexcept {
  if (frame.id == kNmtId) return other_master.command(frame, record.since_start(now));
  if (frame.id == kSyncId) {
    if (config.sync != SyncOrder::External) other_master.sync(now);
    return count_sync();
  }
  for (BusAxis& axis : axes) {
    for (BusAxis::Answer& answer : axis.answers) {
      if (frame.id == answer.id) return take_answer(axis, answer, frame);
    }
  }
  for (BusNode& node : nodes) {
    const std::uint8_t id = node.boot.node();
    if (frame.id == kEmergencyId + id || frame.id == kSdoAnswerId + id || frame.id == kHeartbeatId + id) {
      if (node.take(frame, now, record.since_start(now), counters)) forget_answers(node);
      return;
    }
  }
}

void CanopenInterface::Impl::take_answer(BusAxis& axis, BusAxis::Answer& answer, const CanFrame& frame) noexcept {
  BusNode& node = nodes[axis.node];
  if (!node.boot.watched()) return answer.count.restart();
  if (answer.count.take(frame) && node.boot.reading(answer.transmission_type) == kEverySync) {
    return node.boot.answered_twice();
  }
  if (!node.up) return;
  if (frame.id == node.measured) node.record.answer(frame.stamp);
  if (!unpack_answers(axis.config, answer.contents, frame, axis.feedback)) {
    ++counters.short_answers;
    return;
  }
  answer.unanswered = 0;
  answer.answered = true;
}

void CanopenInterface::Impl::watch(std::chrono::nanoseconds now) noexcept {
  for (BusNode& node : nodes) {
    if (node.watch(now, config.heartbeat_deadline(), counters)) forget_answers(node);
  }
}

void CanopenInterface::Impl::forget_answers(const BusNode& node) noexcept {
  for (BusAxis& axis : axes) {
    if (&nodes[axis.node] == &node) axis.forget();
  }
}

void CanopenInterface::Impl::fill(std::span<DriveFeedback> feedback) noexcept {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    BusAxis& axis = axes[i];
    BusNode& node = nodes[axis.node];
    const bool missed = axis.answered() && axis.unanswered() > 0;
    if (missed) {
      ++counters.missed_answers;
      node.record.missed();
    }
    feedback[i] = axis.feedback;
    feedback[i].statusword = status_by(node.boot.plan().drive, axis.feedback);
    feedback[i].missed = missed;
    feedback[i].online = node.up && axis.answered() && axis.unanswered() <= config.missed_answers;
    if (!axis.tells(0x603F)) feedback[i].error_code = node.error_code;
  }
}

void CanopenInterface::Impl::note_silence(std::span<const DriveFeedback> feedback) noexcept {
  const bool all_silent = nodes.size() > 1 && std::none_of(feedback.begin(), feedback.end(),
                                                           [](const auto& words) { return words.online; });
  for (std::size_t place = 0; place < nodes.size(); ++place) {
    BusNode& node = nodes[place];
    bool online = true;
    for (std::size_t i = 0; i < axes.size(); ++i) online = online && (axes[i].node != place || feedback[i].online);
    node.was_present = node.was_present || online;
    if (!online && node.was_present) node.silent_with_all.store(all_silent, std::memory_order_relaxed);
  }
}

bool CanopenInterface::Impl::send(const CanFrame& frame) noexcept {
  const bool sent = port->send(frame);
  if (!sent) ++counters.unsent;
  return sent;
}

bool CanopenInterface::Impl::send_cycle(std::span<const DriveCommand> commands, std::chrono::nanoseconds now) noexcept {
  bool all = synced;
  for (const std::size_t first : rpdos) all = send_setpoints(first, commands) && all;
  all = send_more_setpoints(commands) && all;
  if (config.sync == SyncOrder::Last) all = send(sync_frame()) && all;
  if (config.sync != SyncOrder::External) count_sync();
  for (BusAxis& axis : axes) {
    for (BusAxis::Answer& answer : axis.answers) ++answer.unanswered;
  }
  if (now >= next_heartbeat) {
    all = send(heartbeat_frame(config.master_node, NmtState::Operational)) && all;
    next_heartbeat = std::max(next_heartbeat + config.heartbeat, now);
  }
  for (BusNode& node : nodes) {
    if (node.asks(now)) all = send(guard_frame(node.boot.node())) && all;
  }
  if (config.time_interval.count() > 0 && now >= next_time) {
    all = send(time_frame(std::chrono::system_clock::now())) && all;
    next_time = std::max(next_time + config.time_interval, now);
  }
  return all;
}

/// The frame of an axis and of those that share it. Nothing is queued for a node that is away: what it would find there
/// on its return is old. In a frame that another needs its words are zeros, which enable nothing.
bool CanopenInterface::Impl::send_setpoints(std::size_t first, std::span<const DriveCommand> commands) noexcept {
  CanFrame frame = pack_setpoints(axes[first].config, DriveCommand{});
  bool any = false;
  for (std::size_t i = first; i < axes.size(); ++i) {
    if (setpoint_id(axes[i].config) != frame.id || !nodes[axes[i].node].up) continue;
    add_setpoints(frame, pack_setpoints(axes[i].config, commands[i]));
    any = true;
  }
  return !any || send(frame);
}

bool CanopenInterface::Impl::send_more_setpoints(std::span<const DriveCommand> commands) noexcept {
  bool all = true;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (axes[i].config.more_setpoints.empty() || !nodes[axes[i].node].up) continue;
    all = send(pack_more_setpoints(axes[i].config, commands[i])) && all;
  }
  return all;
}

void CanopenInterface::Impl::ask_positions(std::span<const DriveCommand> commands,
                                           std::chrono::nanoseconds now) noexcept {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    BusNode& node = nodes[axes[i].node];
    if (!commands[i].read_position || !node.up || node.told_position || node.positions.busy()) continue;
    const auto offset = static_cast<std::uint16_t>(kAxisOffset * axes[i].config.axis_in_node);
    node.positions.begin(i, of_axis({0x6064, 0}, offset), node.boot.plan().patience.sdo_timeout, now);
  }
}

void CanopenInterface::Impl::take_positions() noexcept {
  for (BusNode& node : nodes) {
    const auto reading = node.positions.take();
    node.told_position = reading.has_value();
    if (!reading) continue;
    DriveFeedback& words = axes[reading->axis].feedback;
    // A drive that refuses to tell it by SDO is left to its PDOs.
    words.position_read_counts = reading->counts.value_or(words.position_counts);
    ++words.position_reads;
  }
}

/// One frame a cycle, in turn, so that bringing up a node, or reading a position, takes little from the cycles of the
/// others.
void CanopenInterface::Impl::send_asides(std::chrono::nanoseconds now) noexcept {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    aside = (aside + 1) % nodes.size();
    BusNode& node = nodes[aside];
    CanFrame frame;
    if (node.up ? node.positions.next_frame(now, frame) : node.boot.next_frame(now, frame)) {
      port->send(frame);
      return;
    }
  }
}

}  // namespace rmac::fieldbus::canopen
