#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "gateway/controller/controller_impl.hpp"
#include "gateway/events/fault_text.hpp"
#include "gateway/mechanism/standing.hpp"

namespace rmac::gateway {
namespace {

/// The servo thread answers within cycles, drives within the loop's own time-out; beyond this something hangs.
constexpr std::chrono::seconds kPatience{10};
constexpr std::chrono::microseconds kLookAgain{100};

}  // namespace

ModuleLoader Controller::Impl::loader(const std::string& mechanism_folder) const {
  std::vector<std::filesystem::path> folders;
  if (!mechanism_folder.empty()) folders.emplace_back(mechanism_folder);
  folders.insert(folders.end(), options.module_folders.begin(), options.module_folders.end());
  return ModuleLoader(std::move(folders));
}

AssemblyOptions Controller::Impl::assembly_options(bool in_virtual_mode) const {
  return {in_virtual_mode, options.period_s, options.stop_categories, options.max_cycles_lost};
}

void Controller::Impl::drain() {
  // No further than now: in virtual time the servo thread could go on as fast as it is followed.
  const std::int64_t newest = link->history.newest();
  CycleSample sample;
  for (auto cycle = std::max(link->delivered.load() + 1, link->history.oldest()); cycle <= newest; ++cycle) {
    if (link->history.read(cycle, sample)) waiting_samples.push_back(sample);
  }
  link->delivered.store(newest);
}

template <typename Reached>
bool Controller::Impl::wait_for(Reached&& reached) {
  const auto give_up = std::chrono::steady_clock::now() + kPatience;
  while (!reached()) {
    if (std::chrono::steady_clock::now() > give_up) return false;
    drain();  // in virtual time a full ring would keep the servo thread from answering
    if (options.stepped) {
      thread.step();
    } else {
      std::this_thread::sleep_for(kLookAgain);
    }
  }
  return true;
}

Expected<> Controller::Impl::fit_for_change(const char* what) {
  if (!running) return failure(MinorCode::Other, fmt::format("{}: the controller is not running; start it", what));
  const CycleState state = supervisor.state();
  if (is_faulted(state)) {
    return failure(MinorCode::Other,
                   fmt::format("{}: the machine is {}; remove the cause and reset first", what, to_string(state)));
  }
  return {};
}

Expected<> Controller::Impl::ready_for_change(const char* what) {
  return fit_for_change(what).and_then([&] { return supervisor.require_rest(what); });
}

Expected<> Controller::Impl::ask_servo_thread(SwapRequest& request) {
  link->swap.store(&request, std::memory_order_release);
  const auto answered = [&] { return request.result.load(std::memory_order_acquire) != SwapRequest::Result::Waiting; };
  if (!wait_for(answered)) {
    // Taken back unless the servo thread got hold of it just now; then its answer is certain, and near.
    if (link->swap.exchange(nullptr, std::memory_order_acq_rel) == &request) {
      return failure(MinorCode::ResponseTimeout, "the servo thread does not run cycles, so nothing can be put in");
    }
    while (!answered()) std::this_thread::yield();
  }
  if (request.result.load(std::memory_order_acquire) == SwapRequest::Result::Refused) {
    return failure(MinorCode::Other, "the machine is moving; a mechanism is put in at rest only");
  }
  return {};
}

Expected<> Controller::Impl::swap(Mechanism* next) {
  SwapRequest request;
  request.next = next;
  request.generation = generation + 1;
  return ask_servo_thread(request).map([this] { ++generation; });
}

Expected<> Controller::Impl::switch_to(std::shared_ptr<Mechanism> next, bool keep_running) {
  if (auto swapped = swap(next.get()); !swapped) return swapped;
  in_force = next;
  const auto old = supervisor.install(std::move(next), generation, keep_running);
  if (!wait_for([&] { return link->status.read().generation == generation; })) {
    return failure(MinorCode::ResponseTimeout, "the servo thread does not report on the mechanism that was put in");
  }
  return {};
}

Expected<> Controller::Impl::power_on() {
  supervisor.wish([](ServoWishes& wishes) { wishes.power = true; });
  const bool settled = wait_for([&] {
    const ServoStatus now = link->status.read();
    return now.follows || now.state == ServoState::Faulted;
  });
  const ServoStatus now = link->status.read();
  if (settled && now.follows) return {};
  return failure(MinorCode::Other, settled ? describe(now.fault, in_force.get())
                                           : "the drives were not enabled in time; check their power");
}

Expected<> Controller::Impl::clear_servo_fault() {
  supervisor.wish([](ServoWishes& wishes) {
    wishes.power = false;
    wishes.reset = true;
  });
  (void)wait_for([&, since = link->status.read().t_s] {
    const ServoStatus now = link->status.read();
    // A loop that was put in just now needs some cycles to notice its drives' fault, and to hear that it is to be
    // reset.
    const double waited_s = now.t_s - since;
    return (waited_s > 0.02 && now.state == ServoState::Off) || waited_s > 1.0;
  });
  const ServoStatus now = link->status.read();
  supervisor.wish([](ServoWishes& wishes) { wishes.reset = false; });
  if (now.state != ServoState::Faulted) return {};
  const bool pressed = now.fault.kind == ServoFault::Kind::EmergencyStop;
  return failure(pressed ? MinorCode::EmergencyStop : MinorCode::Other,
                 fmt::format("the fault is still there: {}", describe(now.fault, in_force.get())));
}

std::string Controller::Impl::put_back(const sdk::DeviceObject& device, bool virtual_before) {
  // The loop that was in force has handed its drives over and cannot take them back; one like it can.
  auto again = assemble(device, assembly_options(virtual_before), loader(folder_in_force), registry);
  if (!again) return again.error().message;
  const auto restored = switch_to(std::move(*again), false).and_then([&] { return clear_servo_fault(); }).and_then([&] {
    return power_on();
  });
  if (!restored) return restored.error().message;
  leave_fault();  // the failed attempt faulted the machine; the old mechanism is well
  return {};
}

void Controller::Impl::leave_fault() {
  (void)supervisor.command([](CycleSequencer& cycle, const CycleObservation&) {
    return is_faulted(cycle.state()) ? cycle.reset() : Expected<>{};
  });
}

Expected<> Controller::Impl::apply(const sdk::DeviceObject& device, ConfigDraft::Extent extent) {
  if (extent == ConfigDraft::Extent::Loops) {
    const std::vector<std::size_t> joints = joints_with_other_loops(device);
    if (!joints.empty()) return change_loops(device, joints);
  }
  return put_in(device, extent == ConfigDraft::Extent::Mechanism);
}

Expected<> Controller::Impl::put_in(const sdk::DeviceObject& device, bool fresh) {
  if (auto ready = ready_for_change("putting in a configuration"); !ready) return ready;
  // The same machine in another role: part and tool are where they were, and what its outputs hold stays held.
  const bool role =
      fresh && in_force && device.machine() == in_force->device.machine() && device.name != in_force->device.name;
  const Frames frames_before = supervisor.wishes().frames;
  if (role) (void)cam.keep_mounted();  // before the table is read that says so
  auto tools = rack.read(device.machine());
  if (!tools) return tl::unexpected(tools.error());
  const bool virtual_before = in_force && in_force->virtual_mode();
  const bool on_its_buses = fresh || !in_force || virtual_mode ||
                            same_choice(in_force->device.digital_control_interface, device.digital_control_interface);
  if (!on_its_buses) return exchange_interface(device);
  auto before = in_force;
  auto next = assemble(device, assembly_options(virtual_mode), loader(folder), registry);
  std::optional<std::vector<double>> standing;
  if (next && before) {
    const ServoStatus now = link->status.read();
    standing = standing_after(*before, {now.position_set.data(), now.axis_count}, **next);
  }
  auto may_go_in = !next      ? Expected<>(tl::unexpected(next.error()))
                   : standing ? check_standing(device, *standing, fresh)
                              : Expected<>{};
  if (!may_go_in) {
    next = tl::unexpected(may_go_in.error());  // gives its buses back
    registry.stop_unused();
    return may_go_in;
  }
  if (fresh) {
    supervisor.wish([](ServoWishes& wishes) { wishes.spindle_rpm.fill(0); });
  }
  auto done = switch_to(std::move(*next), !fresh);
  if (done) done = power_on();
  if (done && !standing) {
    const ServoStatus now = link->status.read();
    done = check_standing(device, {now.position_set.data(), now.axis_count}, true);
  }
  if (!done) {
    std::string message = done.error().message;
    if (in_force != before) {
      if (before) {
        const std::string trouble = put_back(before->device, virtual_before);
        message += trouble.empty() ? fmt::format("; {} is in force again", before->device.name)
                                   : fmt::format("; and {} could not be put back: {}", before->device.name, trouble);
      } else if (auto out = take_out(); !out) {
        message += "; and it could not be taken out again: " + out.error().message;
      } else {
        leave_fault();  // nothing is in force that could be at fault
      }
    }
    tell_cam(in_force ? &in_force->device : nullptr, false);
    before.reset();
    registry.stop_unused();
    return failure(done.error().code, message);
  }
  before.reset();
  folder_in_force = folder;
  if (fresh) {
    if (!role) {
      supervisor.wish([](ServoWishes& wishes) { wishes.outputs = 0; });
      supervisor.set_frames({});
      supervisor.parking().drop(device.name + " was loaded anew");
    }
    const auto keeps = !virtual_mode     ? ToolRack::Keeps::Everything
                       : options.stepped ? ToolRack::Keeps::Nothing
                                         : ToolRack::Keeps::Tools;
    (void)cam.keep_mounted();  // of the mechanism before
    rack.adopt(device.machine(), std::move(*tools), keeps);
  }
  bound_spindles(device);
  tell_cam(&in_force->device, fresh);
  if (role) supervisor.set_frames(frames_before);
  draft.discard(&in_force->device);
  registry.stop_unused();
  tell_of_mechanism(
      fmt::format("{} is {}{}", device.name, fresh ? "loaded" : "configured", virtual_mode ? " in virtual mode" : ""));
  return {};
}

/// A spindle that turns faster than it may now slows down, and feed does not wait for the speed that it had.
void Controller::Impl::bound_spindles(const sdk::DeviceObject& device) {
  supervisor.wish([&](ServoWishes& wishes) {
    for (std::size_t i = 0; i < kMaxSpindles; ++i) {
      const double bound = i < device.spindles.size() ? device.spindles[i].max_speed_rpm : 0;
      wishes.spindle_rpm[i] = std::clamp(wishes.spindle_rpm[i], -bound, bound);
    }
  });
}

void Controller::Impl::tell_cam(const sdk::DeviceObject* device, bool fresh) {
  cam.mechanism_changed(device, fresh);
  measuring.mechanism_changed(device, fresh);
}

void Controller::Impl::tell_of_mechanism(std::string message) {
  const ServoStatus now = link->status.read();
  supervisor.report({Event::Kind::Mechanism, now.t_s, 0, std::move(message), now.progress.cycle, {}});
}

Expected<> Controller::Impl::switch_off() {
  supervisor.wish([](ServoWishes& wishes) {
    wishes.power = false;
    wishes.reset = false;
    wishes.spindle_rpm.fill(0);
  });
  // Some cycles, so that the drives hear of it before the bus stops.
  (void)wait_for([&, since = link->status.read().t_s] {
    const ServoStatus now = link->status.read();
    return now.state == ServoState::Off || now.t_s - since > 0.1;
  });
  return swap(nullptr).map([&] { (void)supervisor.install(nullptr, generation, false); });
}

Expected<> Controller::Impl::take_out() {
  if (!in_force) return {};
  const CycleState state = supervisor.state();
  if (!is_faulted(state)) {
    if (auto rest = supervisor.require_rest("unloading"); !rest) return rest;
  }
  supervisor.wish([](ServoWishes& wishes) { wishes.outputs = 0; });
  const std::string name = in_force->device.name;
  if (auto off = switch_off(); !off) return off;
  (void)cam.keep_mounted();
  supervisor.parking().drop(name + " was unloaded");
  tell_cam(nullptr, true);
  in_force.reset();
  draft.discard(nullptr);
  registry.stop_unused();
  tell_of_mechanism(name + " is unloaded");
  return {};
}

Expected<> Controller::Impl::reset() {
  const CycleState state = supervisor.state();
  if (!is_faulted(state)) {
    return failure(MinorCode::Other,
                   fmt::format("reset: there is no fault to reset, the machine is {}", to_string(state)));
  }
  if (in_force && link->status.read().state == ServoState::Faulted) {
    if (auto cleared = clear_servo_fault(); !cleared) return cleared;
  }
  if (in_force) {
    // What was planned begins where the machine no longer is.
    if (auto switched = switch_to(in_force->with_empty_path(), true); !switched) return switched;
    tell_cam(&in_force->device, false);
  }
  auto left = supervisor.command([](CycleSequencer& cycle, const CycleObservation&) { return cycle.reset(); });
  if (left && in_force) left = power_on();
  return left;
}

void Controller::Impl::come_to_rest() noexcept {
  // Ending cannot fail: whatever does not work, the threads end and the buses stop.
  try {
    (void)cam.stop_now();
    (void)wait_for([&] {
      const CycleState state = supervisor.state();
      return state == CycleState::Idle || is_faulted(state);
    });
    (void)take_out();
  } catch (...) {
  }
}

}  // namespace rmac::gateway
