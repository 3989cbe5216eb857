#include <utility>

#include "servo/servo_loop_impl.hpp"
#include "servo/watch/drive_watch.hpp"

namespace rmac {

ServoLoop::Impl::Impl(ServoLoopParts loop_parts)
    : parts(std::move(loop_parts)),
      wiring(*parts.actuator_map, parts.joints.size(), parts.actuators),
      state(parts, wiring),
      exchange(parts),
      inputs(parts),
      probe(parts, wiring),
      shafts(parts.actuators, parts.period_s),
      positions(parts, wiring),
      transmission(*parts.actuator_map, parts.joints),
      joints(parts, wiring, transmission),
      gantries(parts, wiring),
      homing(parts.actuators, parts.homing_timeout_s, parts.period_s),
      setpoints(parts, wiring.joint_delays(), wiring.follow_themselves()),
      motion_watch(parts),
      laws(parts.joints, parts.period_s),
      spindles(parts.spindles, parts.period_s, state),
      rest(parts.actuators.size() + parts.spindles.size(), parts.period_s),
      torques(*parts.actuator_map, parts.actuators, parts.period_s),
      aims(parts.actuators, wiring.actuator_delays(), parts.period_s) {
  if (parts.virtual_mode) joints.reflect(setpoints.position(), setpoints.velocity());
}

void ServoLoop::Impl::cycle(const ServoCommand& command, ServoReport& report) noexcept {
  state.begin_cycle();
  setpoints.begin_cycle();
  if (parts.virtual_mode) {
    move_without_drives(command);
  } else {
    receive(command);
    obey(command);
    read(command.cycles_missed);
    watch_drives(command);
    finish_reset();
    run_homing(command);
    go_live();
    choose_setpoints(command);
    watch_motion(command);
    run_laws();
    spindles.run(command);
    watch_power();
    make_setpoints_of_drives();
    write();
    exchange.send(state);
    settle();
  }
  fill(command, report);
}

void ServoLoop::Impl::move_without_drives(const ServoCommand& command) noexcept {
  obey(command);
  finish_reset();
  state.arrive_without_drives();
  choose_setpoints(command);
  joints.reflect(setpoints.position(), setpoints.velocity());
}

void ServoLoop::Impl::settle() noexcept {
  if (!state.powered()) {
    live.let_go(live.all());
    setpoints.let_go();
    laws.let_go();
  }
  if (!state.take_new_stop()) return;
  rest.begin();
  if (!state.braking()) return;
  if (const auto silent = state.actuator_given_up()) {
    live.let_go(only(wiring.joint_of(*silent)));
    setpoints.give_up(wiring.joint_of(*silent));
  }
  setpoints.begin_braking();
}

void ServoLoop::Impl::receive(const ServoCommand& command) noexcept {
  const std::uint64_t now = exchange.receive(command.outputs, state);
  const bool homes = state.state() == ServoState::Homing;
  inputs.step(now, homes ? wiring.joints_of(homing.drives()) : 0, state);
  probe.read(now);
}

void ServoLoop::Impl::obey(const ServoCommand& command) noexcept {
  const ServoState before = state.state();
  state.obey(command, setpoints.braked());
  settle();
  if (state.state() != ServoState::Homing || before == ServoState::Homing) return;
  if (homing.begin() == Homing::Progress::Over) state.homing_is_over();
  live.let_go(wiring.joints_of(homing.drives()));
}

const DriveFeedback& ServoLoop::Impl::told(std::size_t actuator) const noexcept {
  const ServoActuator& part = parts.actuators[actuator];
  return part.bus->feedback[part.axis];
}

void ServoLoop::Impl::read(std::uint64_t missed) noexcept {
  shafts.read();
  positions.step(shafts, joints.velocity(), missed);
  if (positions.late()) joints.forget_steps();
  joints.read(shafts.rad(), shafts.rad_s(), live.all(), live.all() & positions.answered(), setpoints.velocity());
  gantries.read(shafts.rad(), shafts.rad_s());
  spindles.read();
}

void ServoLoop::Impl::watch_drives(const ServoCommand& command) noexcept {
  if (state.state() == ServoState::Enabling) positions.check_standing(live.all(), state);
  if (state.powered()) {
    IndexSet in_use = state.state() == ServoState::Homing ? homing.drives() : 0;
    for (std::size_t j = 0; j < wiring.joints(); ++j) {
      if (live[j]) in_use |= wiring.actuators_of(j);
    }
    for (std::size_t i = 0; i < wiring.actuators(); ++i) {
      watch_drive(told(i), has(in_use, i), ServoFault::Part::Actuator, i, state);
    }
    for (std::size_t i = 0; i < spindles.size(); ++i) {
      const bool needed =
          state.state() == ServoState::Engaged || (state.braking() && !state.given_up(ServoFault::Part::Spindle, i));
      watch_drive(spindles.told(i), needed, ServoFault::Part::Spindle, i, state);
    }
  }
  motion_watch.deadlines().step(command.cycles_missed, state.driving(), state);
  settle();
}

bool ServoLoop::Impl::stands() const noexcept {
  return state.braking() ? setpoints.braked() : parts.virtual_mode || rest.all_reached();
}

void ServoLoop::Impl::finish_reset() noexcept {
  if (!state.resetting()) return;
  bool clear = !inputs.emergency_stop();
  if (!parts.virtual_mode) {
    for (std::size_t i = 0; i < wiring.actuators(); ++i) clear = clear && !is_faulted(told(i));
    for (std::size_t i = 0; i < spindles.size(); ++i) clear = clear && !is_faulted(spindles.told(i));
  }
  const ServoFault before = state.fault();
  state.finish_reset(stands(), clear);
  if (before.kind != ServoFault::Kind::None && state.state() == ServoState::Off) {
    const IndexSet without = positions.forgive(before);
    for (std::size_t j = 0; j < wiring.joints(); ++j) {
      if (has(without, j)) gantries.forget(wiring.actuators_of(j));
    }
  }
  settle();
}

void ServoLoop::Impl::run_homing(const ServoCommand& command) noexcept {
  if (state.state() != ServoState::Homing) return;
  const std::uint32_t completed = homing.completed();
  positions.forget(homing.drives());
  gantries.forget(homing.drives());
  const Homing::Progress progress = homing.step(command.home, shafts, state);
  if (progress == Homing::Progress::Over) state.homing_is_over();
  if (homing.completed() != completed) positions.homed();
  live.let_go(wiring.joints_of(homing.drives()));
  settle();
}

bool ServoLoop::Impl::operable(std::size_t joint) const noexcept {
  for (std::size_t i = 0; i < wiring.actuators(); ++i) {
    if (!has(wiring.actuators_of(joint), i)) continue;
    if (!positions.believes(i)) return false;
    const DriveFeedback& words = told(i);
    const bool in_mode = words.mode == DriveMode::None || words.mode == parts.actuators[i].mode;
    if (!in_mode || !operates(words)) return false;
  }
  return true;
}

void ServoLoop::Impl::engage_law(std::size_t joint, double from_effort) noexcept {
  if (wiring.follows_itself(joint)) return laws.engage_beside(joint, from_effort);
  laws.engage(joint, input(joint), from_effort);
}

void ServoLoop::Impl::go_live() noexcept {
  if (!state.driving() || state.state() == ServoState::Homing) return;
  IndexSet engaged = 0;
  for (std::size_t j = 0; j < wiring.joints(); ++j) {
    if (!live[j] && operable(j)) {
      live.take(j);
      positions.engaged(j);
      gantries.engage(j);
      setpoints.hold_at(j, joints.position()[j]);
      if (wiring.follows_itself(j)) engaged |= only(j);
      engage_law(j, laws.resting_effort(j));
    } else if (live.handed(j)) {
      gantries.go_on(j);
      engage_law(j, laws.effort()[j]);
    }
  }
  live.engaged();
  bool all = live.all() == first(wiring.joints());
  for (std::size_t i = 0; i < spindles.size(); ++i) all = all && operates(spindles.told(i));
  state.arrive(all);
  if (engaged == 0) return;
  // Drives that follow positions begin where they stand, whatever the actuator map says of that.
  std::array<double, kMaxJoints> wanted{};
  const std::span<double> aimed(wanted.data(), wiring.actuators());
  transmission.shafts_for(setpoints.positions(), aimed);
  gantries.place(aimed);
  positions.check_aims(aimed, shafts.rad(), engaged, state);
  settle();
}

void ServoLoop::Impl::choose_setpoints(const ServoCommand& command) noexcept {
  const bool program = command.program && state.follows() && !state.braking();
  setpoints.learned().step(command.setpoint, program, live.all() & ~wiring.follow_themselves());
  const Setpoints::Seen now{.plan = command.setpoint,
                            .wanted_force = command.force,
                            .position = joints.position(),
                            .velocity = joints.velocity(),
                            .force = joints.force(),
                            .effort = laws.effort(),
                            .live = live.all(),
                            .follows = state.follows() && !state.braking()};
  if (state.braking()) {
    setpoints.brake(now);
  } else {
    setpoints.step(now, state);
  }
}

JointSeen ServoLoop::Impl::seen(std::size_t joint) const noexcept {
  const ForceLoop& force_loop = setpoints.force_loop(joint);
  const std::optional<double> measured = joints.measured_effort(joint);
  const bool unbelieved = positions.jump(joint) != 0;
  return {.position = {.jump = unbelieved ? positions.jump(joint) : joints.jump(joint),
                       .step = joints.step(joint),
                       .may_stop = joints.may_stop(joint),
                       .refused = unbelieved},
          .answered = has(positions.answered(), joint),
          .velocity = joints.velocity()[joint],
          .following_error = setpoints.following_error(joint, joints.position()[joint]),
          .position_set = setpoints.position()[joint],
          .velocity_set = setpoints.velocity()[joint],
          .force = joints.force()[joint],
          .contact = force_loop.state(),
          .searched = force_loop.searched(),
          .force_hangs = force_loop.sensor_hangs(),
          .commanded = laws.effort()[joint],
          .bounces = force_loop.bounces(),
          .loop = {.effort = measured.value_or(laws.effort()[joint]),
                   .effort_measured = measured.has_value(),
                   .answer_delay = wiring.joint_delays()[joint],
                   .position = joints.position()[joint],
                   .acceleration_set = setpoints.acceleration()[joint]}};
}

void ServoLoop::Impl::watch_motion(const ServoCommand& command) noexcept {
  if (state.state() == ServoState::Engaged) inputs.hold_back(live.all(), setpoints.velocity(), state);
  for (std::size_t j = 0; j < wiring.joints(); ++j) {
    if (state.powered() && live[j]) {
      motion_watch.joint(j).step(seen(j), state);
      positions.doubt_place(j, motion_watch.joint(j).doubts_position());
      gantries.watch(j,
                     {.position = joints.position()[j],
                      .wanted = setpoints.position()[j],
                      .wanted_speed = setpoints.velocity()[j],
                      .wanted_acceleration = setpoints.acceleration()[j],
                      .effort = laws.effort()[j],
                      .answer_delay = wiring.joint_delays()[j],
                      .answered = has(positions.answered(), j)},
                     state);
    } else {
      motion_watch.joint(j).rest(has(positions.answered(), j) ? std::optional(joints.position()[j]) : std::nullopt);
    }
  }
  if (state.powered()) {
    motion_watch.torques().step(state);
  } else {
    motion_watch.torques().rest();
  }
  spindles.watch(command);
  settle();
}

ServoInput ServoLoop::Impl::input(std::size_t joint) const noexcept {
  const PositionCorrection& correction = transmission.correction(joint);
  const std::optional<double> measured = joints.measured_effort(joint);
  ServoInput seen{
      .position_setpoint = setpoints.position()[joint] + setpoints.learned().position(joint),
      .velocity_setpoint =
          setpoints.velocity()[joint] + setpoints.learned().velocity(joint) + correction.crossing_velocity(),
      .acceleration_setpoint = setpoints.acceleration()[joint] + correction.crossing_acceleration(),
      .position = joints.position()[joint] + setpoints.gone_on(joint),
      .velocity = joints.velocity()[joint] + setpoints.velocity_gone_on(joint) + correction.crossing_velocity(),
      .effort = measured.value_or(laws.effort()[joint]),
      .effort_measured = measured.has_value(),
      .period_s = parts.period_s};
  // What is amiss its drive makes good: the law is to add what the motion takes, and nothing for an error.
  if (wiring.follows_itself(joint)) {
    seen.position = seen.position_setpoint;
    seen.velocity = seen.velocity_setpoint;
  } else if (setpoints.pushes(joint)) {
    // It is where its force wants it: the law damps it.
    seen.position = seen.position_setpoint;
    seen.velocity_setpoint = seen.acceleration_setpoint = 0;
    seen.velocity = setpoints.force_loop(joint).damped(joints.velocity()[joint]);
  }
  return seen;
}

void ServoLoop::Impl::run_laws() noexcept {
  for (std::size_t j = 0; j < wiring.joints(); ++j) {
    if (!state.powered() || !laws.has_law(j)) {
      laws.let_go(j);
    } else if (live[j]) {
      const std::optional<double> beside =
          setpoints.pushes(j) ? std::optional(setpoints.force_loop(j).effort()) : std::nullopt;
      if (!laws.run(j, input(j), beside, state)) return;
      gantries.hold(j, laws.effort()[j]);
    } else if (state.braking()) {
      laws.let_go(j);
    } else {
      laws.rest(j);
    }
  }
}

void ServoLoop::Impl::watch_power() noexcept {
  if (state.enables_too_long()) {
    const auto watch = [this](const DriveFeedback& words, ServoFault::Part part, std::size_t index) {
      watch_enabled(words, parts.enable_timeout_s, part, index, state);
    };
    for (std::size_t i = 0; i < wiring.actuators(); ++i) watch(told(i), ServoFault::Part::Actuator, i);
    for (std::size_t i = 0; i < spindles.size(); ++i) watch(spindles.told(i), ServoFault::Part::Spindle, i);
  }
  settle();
  if (state.state() != ServoState::Faulted || state.braking()) return;
  rest.begin_cycle();
  for (std::size_t i = 0; i < wiring.actuators(); ++i) {
    rest.look_at_counts(i, shafts[i].counts(), parts.actuators[i].scale.counts_per_revolution);
  }
  for (std::size_t i = 0; i < spindles.size(); ++i) {
    const std::size_t drive = wiring.actuators() + i;
    if (spindles[i].has_encoder()) {
      rest.look_at_counts(drive, spindles[i].counts(), parts.spindles[i].scale.counts_per_revolution);
    } else {
      rest.look_at_speed(drive, spindles[i].rpm());
    }
  }
}

IndexSet ServoLoop::Impl::controlled() const noexcept {
  return state.powered() ? wiring.actuators_within(live.all()) : 0;
}

void ServoLoop::Impl::make_setpoints_of_drives() noexcept {
  torques.let_go();
  if (state.powered()) torques.make(joints.positions(), {laws.effort().data(), wiring.joints()}, state);
  if (state.powered() && !gantries.empty()) torques.add(gantries.torques_nm(), controlled());
  if (!wiring.all_take_torque() || torques.know_cogging()) {
    std::array<double, kMaxJoints> wanted{};
    transmission.shafts_for(setpoints.positions(), {wanted.data(), wiring.actuators()});
    gantries.place(wanted);
    torques.cancel_cogging(shafts.rad(), wanted, controlled());
    aims.step(wanted, controlled() & ~wiring.torque_drives(), state);
  }
  settle();
}

DriveWish ServoLoop::Impl::wish(ServoFault::Part part, std::size_t index) const noexcept {
  if (state.given_up(part, index)) return DriveWish::QuickStop;
  const bool unknown = part == ServoFault::Part::Actuator && !positions.believes(index) && !operates(told(index));
  if (state.powered()) return unknown ? DriveWish::Off : DriveWish::Operational;
  const std::size_t drive = part == ServoFault::Part::Spindle ? wiring.actuators() + index : index;
  const bool rests = state.state() == ServoState::Faulted && rest.reached(drive);
  return state.state() == ServoState::Off || rests ? DriveWish::Off : DriveWish::QuickStop;
}

void ServoLoop::Impl::write() noexcept {
  for (std::size_t i = 0; i < wiring.actuators(); ++i) {
    const ServoActuator& part = parts.actuators[i];
    const DriveFeedback& from = told(i);
    DriveCommand& words = part.bus->commands[part.axis];
    words.controlword =
        next_controlword(from.statusword, wish(ServoFault::Part::Actuator, i), state.resetting(), words.controlword);
    words.mode = part.mode;
    if (state.state() == ServoState::Homing) homing.command(i, words);
    // Where it stands, and not what it says of that, which may not be believed.
    words.target_position_counts =
        shafts[i].seen() ? position_word(static_cast<double>(shafts[i].counts())) : from.position_counts;
    words.target_velocity_rpm = words.velocity_offset_rpm = 0;
    if (aims.sends(i)) aims.command(i, shafts[i].rad(), words);
    words.touch_probe = probe.function(i);
    words.read_position = positions.asks(i);
    const std::int16_t torque = torque_word(part.scale, torques[i]);
    const bool alone = has(wiring.torque_drives(), i);
    words.target_torque_permille = alone ? torque : std::int16_t{0};
    words.torque_offset_permille = alone || words.mode != part.mode ? std::int16_t{0} : torque;
  }
  for (std::size_t i = 0; i < spindles.size(); ++i) {
    DriveCommand& words = parts.spindles[i].bus->commands[parts.spindles[i].axis];
    words.controlword = next_controlword(spindles.told(i).statusword, wish(ServoFault::Part::Spindle, i),
                                         state.resetting(), words.controlword);
    spindles.write(i, words);
  }
}

}  // namespace rmac
