#include "rmac/fieldbus/canopen/canopen_interface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <set>

#include "canopen/bus_axis.hpp"
#include "canopen/bus_node.hpp"
#include "canopen/bus_trouble.hpp"
#include "canopen/drives/drive_of_node.hpp"
#include "canopen/pdo.hpp"
#include "canopen/watch/bus_record.hpp"
#include "rmac/fieldbus/can/socket_can_port.hpp"
#include "rmac/fieldbus/canopen/bus_load.hpp"

namespace rmac::fieldbus::canopen {
namespace {

/// More frames than this in one cycle are left for the next: the cycle has a deadline.
constexpr int kMostFramesPerCycle = 512;

}  // namespace

struct CanopenInterface::Impl {
  Impl(CanopenConfig configuration, OpenPort opener) : config(std::move(configuration)), open(std::move(opener)) {
    for (const AxisConfig& axis : config.axes) {
      auto at = std::find_if(nodes.begin(), nodes.end(), [&](const BusNode& n) { return n.boot.node() == axis.node; });
      const auto place = static_cast<std::size_t>(at - nodes.begin());
      if (at == nodes.end()) nodes.emplace_back(config, axis);
      const auto same = [&](std::size_t other) { return setpoint_id(axes[other].config) == setpoint_id(axis); };
      if (std::none_of(rpdos.begin(), rpdos.end(), same)) rpdos.push_back(axes.size());
      axes.push_back(BusAxis::of(axis, place));
    }
  }

  [[nodiscard]] std::vector<std::uint16_t> wanted() const {
    std::vector<std::uint16_t> ids;
    for (const BusNode& node : nodes) {
      for (const std::uint16_t base : {kEmergencyId, kSdoAnswerId, kHeartbeatId}) {
        ids.push_back(static_cast<std::uint16_t>(base + node.boot.node()));
      }
    }
    for (const BusAxis& axis : axes) {
      for (const BusAxis::Answer& answer : axis.answers) ids.push_back(answer.id);
    }
    if (config.sync == SyncOrder::External) ids.push_back(kSyncId);
    return ids;
  }

  // Off the cycle
  [[nodiscard]] Expected<> boot_all();
  [[nodiscard]] std::string problems() const;
  void reset_all() noexcept;

  // On the cycle
  void fetch(std::chrono::nanoseconds now) noexcept;
  void take(const CanFrame& frame, std::chrono::nanoseconds now) noexcept;
  void take_answer(BusAxis& axis, BusAxis::Answer& answer, const CanFrame& frame) noexcept;
  /// A SYNC is on the bus, whoever sent it.
  void count_sync() noexcept {
    for (BusAxis& axis : axes) axis.sync();
  }
  void watch(std::chrono::nanoseconds now) noexcept;
  void ask_positions(std::span<const DriveCommand> commands, std::chrono::nanoseconds now) noexcept;
  void take_positions() noexcept;
  void send_asides(std::chrono::nanoseconds now) noexcept;
  /// Of a node that was lost.
  void forget_answers(const BusNode& node) noexcept;
  void fill(std::span<DriveFeedback> feedback) noexcept;
  [[nodiscard]] bool send(const CanFrame& frame) noexcept;
  [[nodiscard]] bool send_setpoints(std::size_t first, std::span<const DriveCommand> commands) noexcept;
  [[nodiscard]] bool send_more_setpoints(std::span<const DriveCommand> commands) noexcept;
  [[nodiscard]] bool send_cycle(std::span<const DriveCommand> commands, std::chrono::nanoseconds now) noexcept;

  CanopenConfig config;
  OpenPort open;
  std::unique_ptr<CanPort> port;
  std::deque<BusNode> nodes;
  std::vector<BusAxis> axes;
  std::vector<std::size_t> rpdos;  ///< the first axis of each
  CanopenCounters counters;
  BusRecord record;
  std::vector<std::string> notes;  ///< of the start
  BusTrouble trouble;
  std::chrono::nanoseconds next_heartbeat{0};
  std::chrono::nanoseconds next_time{0};
  std::size_t aside = 0;  ///< whose turn it is to send a frame beside those of the cycle
  bool running = false;
  bool fresh = false;  ///< no cycle since start
};

CanopenInterface::CanopenInterface(CanopenConfig config, OpenPort open)
    : impl_(std::make_unique<Impl>(std::move(config), std::move(open))) {}

CanopenInterface::~CanopenInterface() {
  stop();
}

std::size_t CanopenInterface::axis_count() const noexcept {
  return impl_->axes.size();
}

std::uint32_t CanopenInterface::input_bits(std::size_t axis) const noexcept {
  return impl_->axes[axis].tells(0x60FD) ? ~std::uint32_t{0} : 0;
}

DriveMode CanopenInterface::mode(std::size_t axis) const noexcept {
  return impl_->axes[axis].config.mode;
}

int CanopenInterface::answer_delay(std::size_t axis) const noexcept {
  const BusAxis& of = impl_->axes[axis];
  if (of.config.answer_delay) return *of.config.answer_delay;
  const DriveDescription* drive = impl_->nodes[of.node].boot.plan().drive;
  return drive == nullptr ? 1 : drive->manners.answer_delay;
}

bool CanopenInterface::tells_torque(std::size_t axis) const noexcept {
  return impl_->axes[axis].tells(0x6077);
}

bool CanopenInterface::takes_torque_offset(std::size_t axis) const noexcept {
  return impl_->axes[axis].is_told(0x60B2);
}

bool CanopenInterface::reads_positions(std::size_t axis) const noexcept {
  return impl_->axes[axis].tells(0x6064);
}

double CanopenInterface::counts_per_revolution(std::size_t axis) const noexcept {
  const BusAxis& of = impl_->axes[axis];
  return impl_->nodes[of.node].counts_per_revolution(of.config.axis_in_node);
}

bool CanopenInterface::latches(std::size_t axis, TouchProbeEdge edge) const noexcept {
  const BusAxis& of = impl_->axes[axis];
  return of.is_told(0x60B8) && of.tells(0x60B9) &&
         of.tells(static_cast<std::uint16_t>(0x60BA + static_cast<int>(edge)));
}

const CanopenCounters& CanopenInterface::counters() const noexcept {
  return impl_->counters;
}

Expected<> CanopenInterface::start() {
  Impl& bus = *impl_;
  bus.running = false;  // one that runs begins anew: the boot resets its nodes, whatever they do
  if (auto fits = check_bus_load(bus.config); !fits) return fits;
  auto port = bus.open(bus.wanted(), frames_of_cycle(bus.config));
  if (!port) return tl::unexpected(port.error());
  bus.port = std::move(*port);
  bus.counters = {};
  bus.record.start(bus.port->now());
  if (auto booted = bus.boot_all(); !booted) {
    bus.reset_all();
    bus.port.reset();
    return booted;
  }
  bus.running = bus.fresh = true;
  return {};
}

Expected<> CanopenInterface::Impl::boot_all() {
  notes = config.drives ? config.drives->unreadable : std::vector<std::string>();
  for (BusNode& node : nodes) {
    node.start(port->now());
  }
  const auto settled = [](const BusNode& node) {
    return node.boot.state() == NodeBoot::State::Operational || node.boot.state() == NodeBoot::State::Failed;
  };
  std::chrono::nanoseconds next_sync = port->now();
  while (!std::all_of(nodes.begin(), nodes.end(), settled)) {
    fetch(port->now());
    // What drives answer to SYNC shows whether one of them is two.
    if (config.sync != SyncOrder::External && port->now() >= next_sync) {
      if (port->send(sync_frame())) count_sync();
      next_sync = std::max(next_sync + config.period, port->now());
    }
    for (BusNode& node : nodes) {
      CanFrame frame;
      while (node.boot.next_frame(port->now(), frame)) port->send(frame);
      if (node.asks(port->now())) port->send(guard_frame(node.boot.node()));
    }
    port->wait(std::chrono::milliseconds(1));
  }
  const bool all = std::all_of(nodes.begin(), nodes.end(),
                               [](const BusNode& node) { return node.boot.state() == NodeBoot::State::Operational; });
  if (!all) return failure(MinorCode::CommTimeout, problems());
  for (BusNode& node : nodes) {
    node.up = true;
    node.error_code = node.boot.error_code();
    for (const BootProblem& refused : node.boot.notes()) {
      notes.push_back(describe_note(refused, node.boot.node(), config));
    }
    if (const DriveDescription* drive = node.boot.plan().drive; drive != nullptr) {
      for (std::string& remark : remarks(*drive, node.boot.node())) notes.push_back(std::move(remark));
    }
  }
  return {};
}

std::string CanopenInterface::Impl::problems() const {
  std::string text;
  for (const BusNode& node : nodes) {
    if (node.boot.state() != NodeBoot::State::Failed) continue;
    text += (text.empty() ? "" : "; ") + describe(node.boot.problem(), node.boot.node(), config);
  }
  const CanHealth health = port->health();
  if (health.bus_off || health.queue_full > 0) {
    text += "; the interface gets no frame onto the bus: check cable, termination and bit rate";
  }
  if (health.link_down) text += "; the interface went down meanwhile";
  return text;
}

void CanopenInterface::Impl::reset_all() noexcept {
  // Resetting its communication also ends a node's watch over this master (CiA 301, 7.3.2.2.1).
  for (const BusNode& node : nodes) port->send(nmt_frame(NmtCommand::ResetCommunication, node.boot.node()));
}

void CanopenInterface::stop() noexcept {
  Impl& bus = *impl_;
  if (!bus.running) return;
  bus.running = false;
  for (const BusAxis& axis : bus.axes) {
    bus.port->send(pack_setpoints(axis.config, DriveCommand{}));
    if (!axis.config.more_setpoints.empty()) bus.port->send(pack_more_setpoints(axis.config, DriveCommand{}));
  }
  if (bus.config.sync != SyncOrder::External) bus.port->send(sync_frame());
  const std::chrono::nanoseconds until = bus.port->now() + 2 * bus.config.period;
  while (bus.port->now() < until) {
    bus.port->wait(until - bus.port->now());
    CanFrame ignored;
    while (bus.port->now() < until && bus.port->receive(ignored)) {
    }
  }
  bus.reset_all();
  bus.port.reset();
}

bool CanopenInterface::exchange(std::span<const DriveCommand> commands, std::span<DriveFeedback> feedback) noexcept {
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
    bus.next_heartbeat = bus.next_time = now;
    bus.fresh = false;
  }
  ++bus.counters.cycles;
  bus.fetch(now);
  bus.watch(now);
  bus.take_positions();
  bus.fill(feedback);
  const bool sent = bus.send_cycle(commands, now);
  bus.ask_positions(commands, now);
  bus.send_asides(now);
  const CanHealth health = bus.port->health();
  bus.record.note(bus.counters, health, now);
  if (sent && health.usable()) return true;
  bus.trouble.note(health, bus.counters.unsent);
  return false;
}

std::vector<std::string> CanopenInterface::start_notes() const {
  return impl_->notes;
}

BusReport CanopenInterface::report() const {
  const Impl& bus = *impl_;
  BusReport told = bus.record.report();
  told.interface = bus.config.interface;
  if (bus.port) told.controller = bus.port->controller();
  for (std::size_t place = 0; place < bus.nodes.size(); ++place) {
    NodeReport node = bus.nodes[place].record.report(bus.record.run());
    node.node = bus.nodes[place].boot.node();
    for (std::size_t axis = 0; axis < bus.axes.size(); ++axis) {
      if (bus.axes[axis].node == place) node.axes.push_back(axis);
    }
    node.problem = silence_text(node.axes.front());
    told.nodes.push_back(std::move(node));
  }
  return told;
}

std::string CanopenInterface::fault_text() const {
  return impl_->trouble.text(impl_->config.interface);
}

std::optional<std::string> CanopenInterface::silence_text(std::size_t axis) const {
  const BusNode& node = impl_->nodes[impl_->axes[axis].node];
  const BootProblem problem = node.trouble.problem();
  if (problem.kind == BootProblem::Kind::None) return {};
  return describe(problem, node.boot.node(), impl_->config);
}

void CanopenInterface::Impl::fetch(std::chrono::nanoseconds now) noexcept {
  CanFrame frame;
  for (int i = 0; i < kMostFramesPerCycle && port->receive(frame); ++i) take(frame, now);
}

void CanopenInterface::Impl::take(const CanFrame& frame, std::chrono::nanoseconds now) noexcept {
  if (frame.id == kSyncId) return count_sync();  // asked for where another node produces it
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

bool CanopenInterface::Impl::send(const CanFrame& frame) noexcept {
  const bool sent = port->send(frame);
  if (!sent) ++counters.unsent;
  return sent;
}

bool CanopenInterface::Impl::send_cycle(std::span<const DriveCommand> commands, std::chrono::nanoseconds now) noexcept {
  bool all = config.sync != SyncOrder::First || send(sync_frame());
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

std::shared_ptr<CanopenInterface> make_socketcan_interface(CanopenConfig config) {
  const std::string interface = config.interface;
  return std::make_shared<CanopenInterface>(
      std::move(config),
      [interface](std::span<const std::uint16_t> wanted,
                  std::size_t queue_frames) -> Expected<std::unique_ptr<CanPort>> {
        return SocketCanPort::open(interface, wanted, queue_frames).map([](std::unique_ptr<SocketCanPort> port) {
          return std::unique_ptr<CanPort>(std::move(port));
        });
      });
}

}  // namespace rmac::fieldbus::canopen
