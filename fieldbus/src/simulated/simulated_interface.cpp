#include "rmac/fieldbus/simulated_interface.hpp"

namespace rmac::fieldbus {

namespace {

std::variant<SimulatedServoDrive, SimulatedSpindleDrive> make_drive(const SimulatedAxis& axis) {
  if (const auto* spindle = std::get_if<SpindlePlantParameters>(&axis)) return SimulatedSpindleDrive(*spindle);
  return SimulatedServoDrive(std::get<AxisPlantParameters>(axis));
}

// "Heartbeat error" (CiA 301's emergency code 8130h): what a drive reports that lost its master.
constexpr std::uint16_t kHeartbeatError = 0x8130;

}  // namespace

SimulatedInterface::SimulatedInterface(const std::vector<SimulatedAxis>& axes, double period_s)
    : injected_(axes.size()), period_s_(period_s) {
  drives_.reserve(axes.size());
  for (const SimulatedAxis& axis : axes) drives_.push_back(make_drive(axis));
}

Expected<> SimulatedInterface::start() {
  if (drives_.empty()) {
    return failure(MinorCode::InvalidParameterValue, "simulated bus: it has no axes; give it at least one");
  }
  if (!(period_s_ > 0)) {
    return failure(MinorCode::InvalidParameterValue, "simulated bus: the period must be above 0 s");
  }
  return {};
}

void SimulatedInterface::stop() noexcept {
  for (Drive& drive : drives_) {
    std::visit([](auto& d) { d.power().step(0); }, drive);
  }
}

void SimulatedInterface::act_on_injected(std::size_t axis) noexcept {
  Injected& injected = injected_[axis];
  if (const std::int32_t code = injected.error_code.exchange(0); code != 0) {
    std::visit([code](auto& drive) { drive.power().trip(static_cast<std::uint16_t>(code)); }, drives_[axis]);
  }
  const std::int32_t shift = injected.encoder_shift.exchange(0);
  if (auto* servo = std::get_if<SimulatedServoDrive>(&drives_[axis])) servo->shift_encoder(shift);
}

bool SimulatedInterface::exchange(std::span<const DriveCommand> commands, std::span<DriveFeedback> feedback) noexcept {
  const bool bus_failed = bus_failed_;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    act_on_injected(i);
    const bool heard = !bus_failed && !injected_[i].offline;
    std::visit(
        [&](auto& drive) {
          if (heard) {
            feedback[i] = drive.feedback();
            drive.advance(commands[i], period_s_);
          } else {
            feedback[i].online = false;
            if (drive.power().operational()) drive.power().trip(kHeartbeatError);
            drive.advance(DriveCommand{}, period_s_);
          }
        },
        drives_[i]);
  }
  return !bus_failed;
}

void SimulatedInterface::set_online(std::size_t axis, bool online) noexcept {
  injected_[axis].offline = !online;
}
void SimulatedInterface::trip(std::size_t axis, std::uint16_t error_code) noexcept {
  injected_[axis].error_code = error_code;
}
void SimulatedInterface::shift_encoder(std::size_t axis, std::int32_t counts) noexcept {
  injected_[axis].encoder_shift += counts;
}

AxisPlant& SimulatedInterface::plant(std::size_t axis) {
  return std::get<SimulatedServoDrive>(drives_.at(axis)).plant();
}

const SpindlePlant& SimulatedInterface::spindle(std::size_t axis) const {
  return std::get<SimulatedSpindleDrive>(drives_.at(axis)).plant();
}

std::vector<SimulatedAxis> default_simulated_axes() {
  const AxisPlantParameters table;
  AxisPlantParameters saddle;  // carries the table
  saddle.table_mass_kg = 26;
  AxisPlantParameters head;
  head.table_mass_kg = 12;
  head.gravity_nm = 0.0937;  // 12 kg on a pitch of 5 mm: 12 · 9.81 · 0.005 / 2π
  return {table, saddle, head, SpindlePlantParameters{}, table, table, table, table};
}

}  // namespace rmac::fieldbus
