#include "rmac/fieldbus/canopen/canopen_interface.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "canopen/canopen_interface_impl.hpp"
#include "canopen/drives/drive_of_node.hpp"
#include "rmac/fieldbus/can/socket_can_port.hpp"
#include "rmac/fieldbus/canopen/bus_load.hpp"

namespace rmac::fieldbus::canopen {

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
    const BootProblem problem = bus.problem_of(bus.nodes[place]);
    if (problem.kind != BootProblem::Kind::None) node.problem = describe(problem, node.node, bus.config);
    told.nodes.push_back(std::move(node));
  }
  return told;
}

std::string CanopenInterface::fault_text() const {
  return impl_->trouble.text(impl_->config.interface);
}

std::optional<std::string> CanopenInterface::silence_text(std::size_t axis) const {
  const Impl& bus = *impl_;
  const BusNode& node = bus.nodes[bus.axes[axis].node];
  const CanController now = bus.port ? bus.port->controller() : CanController{};
  if (now.link_down) {
    return fmt::format("the interface {0} is down; bring it up with systemctl restart rmac-can@{0}",
                       bus.config.interface);
  }
  const std::string controller = bus.controller_text(now);
  const BootProblem problem = bus.problem_of(node);
  const auto told = [&] { return describe(problem, node.boot.node(), bus.config); };
  if (spoke(problem.kind)) return told();
  if (node.silent_with_all.load(std::memory_order_relaxed)) {
    return fmt::format(
        "none of the {} nodes on {} answers: check the cable from the controller, its termination and bit rate, and "
        "the supply of the drives{}",
        bus.nodes.size(), bus.config.interface, controller.empty() ? "" : "; " + controller);
  }
  if (problem.kind != BootProblem::Kind::None) return told();
  if (controller.empty()) return {};
  return fmt::format("the drive does not answer, and {}: check cable, termination and bit rate, and the drive's power",
                     controller);
}

BootProblem CanopenInterface::Impl::problem_of(const BusNode& node) const {
  if (const auto told = other_master.commanded(node.boot.node(), record.run())) {
    return {.kind = BootProblem::Kind::Commanded, .object = {}, .expected = told->node, .found = told->command};
  }
  return node.trouble.problem();
}

std::string CanopenInterface::Impl::controller_text(const CanController& now) const {
  using State = CanController::State;
  if (now.state == State::Unknown || now.state == State::ErrorActive) return {};
  const std::string errors =
      now.errors ? fmt::format(" ({} transmit errors, {} receive errors)", now.errors->transmit, now.errors->receive)
                 : std::string();
  return fmt::format("the controller of {} is {}{}", config.interface, to_string(now.state), errors);
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
