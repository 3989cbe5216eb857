#include "rmac/fieldbus/simulated_interface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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
  for (const SimulatedAxis& axis : axes) {
    drives_.push_back(make_drive(axis));
    const auto* servo = std::get_if<AxisPlantParameters>(&axis);
    modes_.push_back(servo != nullptr ? servo->mode : DriveMode::ProfileVelocity);
  }
  sent_.resize(axes.size());
  heard_.resize(axes.size());
}

Expected<> SimulatedInterface::start() {
  if (drives_.empty()) {
    return failure(MinorCode::InvalidParameterValue, "simulated bus: it has no axes; give it at least one");
  }
  if (!(period_s_ > 0)) {
    return failure(MinorCode::InvalidParameterValue, "simulated bus: the period must be above 0 s");
  }
  // Answers that were on their way when it stopped are no answers to what is sent from now on.
  for (std::vector<DriveFeedback>& answers : before_) std::fill(answers.begin(), answers.end(), DriveFeedback{});
  std::fill(sent_.begin(), sent_.end(), DriveCommand{});
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
  if (auto* const spindle = std::get_if<SimulatedSpindleDrive>(&drives_[axis])) spindle->load(injected.push_nm);
  auto* const servo = std::get_if<SimulatedServoDrive>(&drives_[axis]);
  if (servo == nullptr) return;
  servo->shift_encoder(shift);
  servo->freeze_encoder(injected.frozen);
  const double runaway = injected.runaway_nm;
  // A drive that was switched off is repaired before it comes back.
  if (!servo->power().operational()) injected.runaway_nm = 0;
  servo->run_away(runaway == 0 ? std::nullopt : std::optional(runaway));
  servo->plant().push(injected.push_nm);
}

void SimulatedInterface::move_surface() noexcept {
  if (!contact_) return;
  const double rad_per_mm = 2 * std::numbers::pi / contact_->pitch_mm;
  const double x = plant(contact_->along).load_rad() / rad_per_mm;
  const double wave = contact_->wave_mm * std::sin(2 * std::numbers::pi * x / contact_->wave_length_mm);
  // N·m a rad from N a mm: once for the force's arm, once for the way.
  const double to_shaft = 1e-3 / (rad_per_mm * rad_per_mm);
  plant(contact_->axis)
      .touch({.stiffness_nm_rad = contact_->stiffness_n_mm * to_shaft,
              .damping_nm_s_rad = contact_->damping_n_s_mm * to_shaft,
              .surface_rad = (contact_->surface_mm + contact_->slope * x + wave) * rad_per_mm});
}

void SimulatedInterface::read_sensor(std::size_t axis, DriveFeedback& words) noexcept {
  words.sensor_valid = !sensor_lost_;
  if (!contact_ || contact_->axis != axis) return;
  const double force_n = plant(contact_->axis).contact_nm() * 2 * std::numbers::pi / (contact_->pitch_mm * 1e-3);
  words.sensor_counts = static_cast<std::int32_t>(std::lround(-force_n * contact_->counts_per_newton));
}

void SimulatedInterface::set_answer_delay(int cycles) {
  std::vector<DriveFeedback> silence(drives_.size());
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    silence[i].load_counts = std::visit([](const auto& drive) { return drive.feedback().load_counts; }, drives_[i]);
  }
  before_.assign(static_cast<std::size_t>(cycles), silence);
}

bool SimulatedInterface::receive(std::span<DriveFeedback> feedback) noexcept {
  bus_fails_now_ = bus_failed_;
  move_surface();
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    act_on_injected(i);
    heard_[i] = static_cast<char>(!bus_fails_now_ && !injected_[i].offline);
    std::visit(
        [&](const auto& drive) {
          if (heard_[i] != 0) {
            feedback[i] = drive.feedback();
            read_sensor(i, feedback[i]);
          } else {
            feedback[i].online = false;
            feedback[i].load_counts = drive.feedback().load_counts;  // what nobody sends goes on
          }
        },
        drives_[i]);
  }
  if (!before_.empty()) {
    std::swap_ranges(before_.front().begin(), before_.front().end(), feedback.begin());
    std::rotate(before_.begin(), before_.begin() + 1, before_.end());
  }
  return !bus_fails_now_;
}

bool SimulatedInterface::send(std::span<const DriveCommand> commands) noexcept {
  const std::span<const DriveCommand> acts = before_.empty() ? sent_ : commands;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    std::visit(
        [&](auto& drive) {
          if (heard_[i] == 0 && drive.power().operational()) drive.power().trip(kHeartbeatError);
          drive.advance(heard_[i] != 0 ? acts[i] : DriveCommand{}, period_s_);
        },
        drives_[i]);
  }
  std::copy(commands.begin(), commands.end(), sent_.begin());
  return !bus_fails_now_;
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

void SimulatedInterface::freeze_encoder(std::size_t axis, bool frozen) noexcept {
  injected_[axis].frozen = frozen;
}
void SimulatedInterface::run_away(std::size_t axis, double torque_nm) noexcept {
  injected_[axis].runaway_nm = torque_nm;
}
void SimulatedInterface::push(std::size_t axis, double torque_nm) noexcept {
  injected_[axis].push_nm = torque_nm;
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
