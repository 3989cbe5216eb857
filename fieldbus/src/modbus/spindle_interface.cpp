#include "rmac/fieldbus/modbus/spindle_interface.hpp"

#include <fmt/format.h>

#include <deque>
#include <utility>

#include "modbus/spindle_station.hpp"
#include "rmac/fieldbus/drive_state_machine.hpp"
#include "rmac/motion/drive_power.hpp"

namespace rmac::fieldbus::modbus {

struct SpindleInterface::Impl {
  struct Axis {
    explicit Axis(SpindleConfig config) : station(std::move(config)) {}
    SpindleStation station;
    DriveStateMachine power;
    std::uint16_t controlword = 0;  ///< of the cycle before
  };

  Now clock;
  std::chrono::milliseconds stale;
  std::chrono::milliseconds busy;
  std::chrono::milliseconds boot_timeout;
  std::deque<Axis> axes;  ///< stations stay where they are
  std::unique_ptr<Line> line;

  /// What was read last holds while it is new, and somewhat longer while the drive answers that it is busy.
  [[nodiscard]] bool counts(const SpindleStation::Report& report, Clock::time_point now) const noexcept {
    constexpr auto kNever = Clock::time_point::min();
    if (report.asked == kNever) return false;
    const bool says_busy = report.busy != kNever && now - report.busy <= stale;
    return now - report.asked <= stale || (says_busy && now - report.asked <= busy);
  }

  /// What the station reported last, and whether that counts; a drive that fell out or tripped is without power.
  std::pair<SpindleStation::Report, bool> look_at(Axis& axis, Clock::time_point now) const noexcept {
    const SpindleStation::Report report = axis.station.report();
    const bool fresh = counts(report, now);
    if (!fresh || report.dropped) axis.power.step(0);
    if (fresh && report.tripped) axis.power.trip(report.error_code);
    return {report, fresh};
  }

  [[nodiscard]] DriveFeedback feedback_of(Axis& axis, Clock::time_point now) const noexcept {
    const auto [report, fresh] = look_at(axis, now);
    return {.statusword = axis.power.statusword(),
            .error_code = axis.power.error_code(),
            .velocity_rpm = fresh ? report.rpm : 0,
            .online = fresh};
  }

  /// True when the drive is to be told something new.
  [[nodiscard]] bool command(Axis& axis, const DriveCommand& command, Clock::time_point now) const noexcept {
    const bool reset = (command.controlword & ~axis.controlword & controlword::kFaultReset) != 0;
    axis.controlword = command.controlword;
    if (reset) axis.station.request_reset();
    axis.power.step(command.controlword);
    look_at(axis, now);
    return axis.station.command(
        axis.power.operational() ? static_cast<std::int32_t>(std::lround(command.target_velocity_rpm)) : 0);
  }
};

SpindleInterface::SpindleInterface(SpindleLineConfig config)
    : impl_(new Impl{config.line.now, config.stale, config.busy, config.boot_timeout, {}, {}}) {
  std::vector<Station*> stations;
  for (SpindleConfig& axis : config.axes) {
    impl_->axes.emplace_back(std::move(axis));
    stations.push_back(&impl_->axes.back().station);
  }
  impl_->line = std::make_unique<Line>(std::move(config.line), std::move(stations));
}

SpindleInterface::~SpindleInterface() {
  stop();
}

std::size_t SpindleInterface::axis_count() const noexcept {
  return impl_->axes.size();
}

Expected<> SpindleInterface::start() {
  stop();
  return impl_->line->start(impl_->boot_timeout);
}

void SpindleInterface::stop() noexcept {
  impl_->line->stop();
  for (Impl::Axis& axis : impl_->axes) {
    axis.station.clear();
    axis.power = {};
    axis.controlword = 0;
  }
}

bool SpindleInterface::receive(std::span<DriveFeedback> feedback) noexcept {
  const Clock::time_point now = impl_->clock();
  for (std::size_t i = 0; i < impl_->axes.size(); ++i) feedback[i] = impl_->feedback_of(impl_->axes[i], now);
  return true;
}

bool SpindleInterface::send(std::span<const DriveCommand> commands) noexcept {
  const Clock::time_point now = impl_->clock();
  bool news = false;
  for (std::size_t i = 0; i < impl_->axes.size(); ++i) {
    news = impl_->command(impl_->axes[i], commands[i], now) || news;
  }
  if (news) impl_->line->wake();
  return true;
}

std::string SpindleInterface::fault_text(std::size_t axis, std::uint16_t error_code) const {
  if (axis >= impl_->axes.size()) return "unknown";
  const SpindleMap& map = impl_->axes[axis].station.map();
  const auto text = map.fault_texts.find(error_code);
  return fmt::format("{}: {}", map.name, text != map.fault_texts.end() ? text->second : "see its manual");
}

std::optional<std::string> SpindleInterface::silence_text(std::size_t axis) const {
  auto text = impl_->line->trouble(axis);
  if (text) text->insert(0, "the drive ");
  return text;
}

LineReport SpindleInterface::line_report() const {
  return impl_->line->report();
}

LineCounters SpindleInterface::counters() const noexcept {
  return impl_->line->counters();
}

}  // namespace rmac::fieldbus::modbus
