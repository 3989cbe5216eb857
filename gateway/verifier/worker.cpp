#include "gateway/verifier/worker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "gateway/bodies/link_chain.hpp"
#include "gateway/buses/built_in_interfaces.hpp"
#include "gateway/buses/bus_registry.hpp"
#include "gateway/mechanism/device_check.hpp"
#include "gateway/rmac_config/config_draft.hpp"
#include "gateway/rmac_config/verified_bounds.hpp"
#include "gateway/verification/checks/actuator_map_check.hpp"
#include "gateway/verification/checks/kinematics_check.hpp"
#include "gateway/verification/checks/port_calls.hpp"
#include "gateway/verification/checks/reach_check.hpp"
#include "gateway/verification/checks/servo_law_check.hpp"
#include "gateway/verifier/planned_moves.hpp"
#include "gateway/verifier/samples.hpp"
#include "gateway/verifier/servo_loop_check.hpp"
#include "gateway/verifier/watched_ports.hpp"
#include "rmac/sdk/device_driver.hpp"
#include "rmac/sdk/servo_law_names.hpp"

namespace rmac::verifier {
namespace {

using gateway::OpenModule;
using Tell = std::function<void()>;

tl::unexpected<CounterExample> refused(const char* check, const Error& error) {
  return found(check, error.message, -1, {});
}

std::size_t open_files() {
  std::error_code ignored;
  const std::filesystem::directory_iterator files("/proc/self/fd", ignored);
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

/// Objects made and destroyed a thousand times leave nothing behind. `use` works each one as it is off the cycle.
Checked check_leaks(const OpenModule& module, const sdk::ModuleChoice& choice, Watch& watch,
                    const std::function<void(void*)>& use) {
  constexpr int kWarmUp = 20, kTimes = 1000;
  constexpr std::size_t kNoise_bytes = 4096;
  std::size_t before = 0, files_before = 0;
  for (int i = 0; i < kWarmUp + kTimes; ++i) {
    if (i == kWarmUp) {
      files_before = open_files();
      before = heap_in_use();
    }
    watch.step("create");
    auto made = module.create(choice);
    if (!made) return refused("create and destroy", made.error());
    if (use) use(made->object.get());
    watch.step("destroy");
  }
  const std::size_t after = heap_in_use(), files_after = open_files();
  if (files_after > files_before) {
    return found("leaks",
                 fmt::format("after {} objects there are {} open files more", kTimes, files_after - files_before), -1,
                 {});
  }
  if (after > before + kNoise_bytes) {
    return found("leaks",
                 fmt::format("{} objects made and destroyed leave {} bytes behind, {} each", kTimes, after - before,
                             (after - before) / kTimes),
                 -1, {});
  }
  return {};
}

/// A module whose code stays mapped after it is closed would go on running when its next build is loaded.
Checked check_unmapped() {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    if (line.find("/rmac-module-") != std::string::npos) {
      return found("unloading",
                   "its code stays mapped after it is closed, and would run in place of its next build; "
                   "compile it with -fno-gnu-unique and let nothing of it register itself for good",
                   -1, {});
    }
  }
  return {};
}

/// Notes what a check came to; false when it refuses the module.
bool take(const Checked& checked, const std::string& name, ModuleReport& report, const Tell& tell) {
  if (checked) {
    report.passed.push_back(name);
  } else {
    report.refusal = checked.error();
  }
  tell();
  return checked.has_value();
}

/// What every kind of module is checked for, around what `check` does with its port.
template <typename Port, typename Check>
void check_module(const Task& task, const sdk::ModuleChoice& choice, Watch& watch, ModuleReport& report,
                  const Tell& tell, const std::function<void(void*)>& use, Check&& check) {
  watch.step("loading");
  auto module = task.loader.open(choice.name, gateway::kKindOf<Port>);
  if (!module) {
    take(refused("loading", module.error()), "", report, tell);
    return;
  }
  report.build_id = module->descriptor->build_id;
  take({}, fmt::format("it loads, and fits module ABI {}", sdk::kModuleAbi), report, tell);
  watch.step("create");
  auto made = module->create(choice);
  if (!made) {
    take(refused("create", made.error()), "", report, tell);
    return;
  }
  auto object = std::static_pointer_cast<Port>(made->object);
  made->object.reset();
  const bool fine = check(object);
  watch.step("destroy");
  object.reset();
  if (!fine || !take(check_leaks(*module, choice, watch, use), "1000 objects leave no memory and no file behind",
                     report, tell)) {
    return;
  }
  watch.step("unloading");
  *module = OpenModule{};
  take(check_unmapped(), "it is gone once it is closed", report, tell);
}

Misdeed misdeed_of(const Watch& watch) {
  return [&watch] { return watch.misdeed(); };
}

constexpr const char* kRealTime = "on the cycle it neither allocates nor locks nor calls the system";

/// That a port keeps nothing between its calls.
bool take_stateless(std::vector<PortCall> calls, Watch& watch, ModuleReport& report, const Tell& tell) {
  StatelessCase given{std::move(calls)};
  given.misdeed = misdeed_of(watch);
  given.makes_calls = [&watch](const char* function, const std::function<void()>& make) {
    watch.calls_on_cycle(function, make);
  };
  watch.step("calls that are repeated");
  const auto made = check_stateless(given);
  return take(made ? Checked() : Checked(tl::unexpected(made.error())),
              fmt::format("the same call has the same answer, {} calls of each function later and beside another "
                          "thread's",
                          made.value_or(0)),
              report, tell);
}

/// How the calls of a port without state were made, none of which was found wanting.
bool take_conduct(const Watch& watch, ModuleReport& report, const Tell& tell) {
  if (!take(watch.misdeed(), kRealTime, report, tell)) return false;
  report.passed.emplace_back("it writes nothing beside its outputs");
  const std::string times = fmt::format("a call takes {} us of CPU time in the median at most, {} us at worst",
                                        CallTimes::kMedian.count(), CallTimes::kWorst.count());
  if (CallTimes::kMeasured) {
    report.passed.push_back(times);
  } else {
    report.not_checked.push_back(times + ": this is a sanitizer's build");
  }
  tell();
  return true;
}

/// That the links carry each other as device.json says.
Checked check_links(const Kinematics& kinematics, const Task& task) {
  std::vector<std::string> names;
  std::vector<std::pair<double, double>> limits;
  for (const sdk::Joint& joint : task.device.joints) {
    names.push_back(joint.limits.name);
    const JointRange range = range_of(joint.limits);
    limits.emplace_back(range.min, range.max);
  }
  const auto chain = gateway::LinkChain::make(kinematics, task.chain, names, limits);
  if (chain) return {};
  return refused("links", chain.error());
}

void check_kinematics_module(const Task& task, Watch& watch, ModuleReport& report, const Tell& tell) {
  const sdk::DeviceObject& device = task.device;
  const auto check = [&](const std::shared_ptr<Kinematics>& kinematics) {
    const WatchedKinematics watched(kinematics, watch);
    watch.step("takes");
    KinematicsCase given{{}, sample_tools(*kinematics), task.samples, task.seed, misdeed_of(watch)};
    if (given.tools.size() < kSampleTools) {
      report.not_checked.push_back(fmt::format("{} of {} tools: it says that it does not take them",
                                               kSampleTools - given.tools.size(), kSampleTools));
    }
    if (given.tools.empty()) return take(found("tools", "it takes none", -1, {}), "", report, tell);
    for (const sdk::Joint& joint : device.joints) given.ranges.push_back(range_of(joint.limits));
    Checked types;
    for (std::size_t j = 0; types && j < std::min(device.joints.size(), kinematics->joint_count()); ++j) {
      if (kinematics->joint_type(j) == device.joints[j].limits.type) continue;
      types = found("joint types",
                    fmt::format("joint {} \"{}\" is of another type in device.json than in the geometry", j,
                                device.joints[j].limits.name),
                    -1, {});
    }
    if (!take(types, "joints are of the types in device.json", report, tell)) return false;
    return take(check_kinematics(watched, given),
                fmt::format("forward, inverse, Jacobian and solutions agree at {} joint vectors, corners, ends and "
                            "poles among them",
                            task.samples),
                report, tell) &&
           take(check_reach(watched, given), "what is beyond its reach is found out of reach, however little", report,
                tell) &&
           (task.chain.empty() ||
            take(check_links(*kinematics, task), "links carry each other as Chain has it", report, tell)) &&
           take_stateless(calls_of(*kinematics, given), watch, report, tell) && take_conduct(watch, report, tell);
  };
  check_module<Kinematics>(task, device.kinematics, watch, report, tell, {}, check);
}

void check_map_module(const Task& task, Watch& watch, ModuleReport& report, const Tell& tell) {
  const sdk::DeviceObject& device = task.device;
  const auto check = [&](const std::shared_ptr<ActuatorMap>& map) {
    const WatchedActuatorMap watched(map, watch);
    ActuatorMapCase given{{}, device.actuators.size(), task.samples, task.seed, misdeed_of(watch)};
    for (std::size_t j = 0; j < device.joint_count_with_held(); ++j) {
      const JointLimits& limits = sdk::joint_at(device, j).limits;
      const JointRange range = range_of(limits);
      given.joints.push_back({range.min, range.max, limits.type == JointType::Rotary ? std::numbers::pi / 180 : 1e-3});
    }
    return take(check_actuator_map(watched, given),
                fmt::format("positions come back and power is conserved at {} joint vectors", task.samples), report,
                tell) &&
           take_conduct(watch, report, tell);
  };
  check_module<ActuatorMap>(task, device.actuator_map, watch, report, tell, {}, check);
}

/// The law of a joint or a spindle.
void check_law_module(const Task& task, const sdk::ModuleChoice& choice, const std::vector<double>& gains, Watch& watch,
                      ModuleReport& report, const Tell& tell) {
  const auto check = [&](const std::shared_ptr<ServoLaw>& law) {
    WatchedServoLaw watched(law, watch);
    ServoLawCase given{gains, gains, task.seed, task.period_s};
    for (double& gain : given.other_gains) gain /= 2;
    if (!law->set_gains(given.other_gains)) given.other_gains = gains;
    const Checked kept = check_servo_law(watched, given);
    const Checked real_time = kept ? watch.misdeed() : Checked();
    return take(kept, "its output is bounded and does not jump, and no number in gives none out", report, tell) &&
           take(real_time, kRealTime, report, tell);
  };
  const auto use = [&](void* object) { (void)static_cast<ServoLaw*>(object)->set_gains(gains); };
  check_module<ServoLaw>(task, choice, watch, report, tell, use, check);
}

void check_driver_module(const Task& task, Watch& watch, ModuleReport& report, const Tell& tell) {
  const auto check = [&](const std::shared_ptr<sdk::DeviceDriver>& driver) {
    // Interfaces are taken at their names here: their own checks load them.
    const auto named_one = [](const sdk::ModuleChoice&) { return Expected<>(); };
    gateway::ConfigDraft draft(
        {[](const sdk::DeviceObject& drafted, gateway::ConfigDraft::Extent) { return gateway::check_device(drafted); },
         named_one, named_one});
    watch.step("configure_motion_planner, configure_servo_controller and configure_digital_control_interface");
    const auto done = draft.begin(task.device)
                          .and_then([&] { return driver->configure_motion_planner(task.device, draft); })
                          .and_then([&] { return driver->configure_servo_controller(task.device, draft); })
                          .and_then([&] { return driver->configure_digital_control_interface(task.device, draft); })
                          .and_then([&] { return draft.apply(); })
                          .and_then([&] { return gateway::check_within_verified(draft.draft(), task.device); });
    return take(done ? Checked() : Checked(refused("configuring", done.error())),
                "what it configures of device.json is a whole mechanism", report, tell);
  };
  check_module<sdk::DeviceDriver>(task, {task.device.device_driver, {}, {}}, watch, report, tell, {}, check);
}

void check_interface(const Task& task, Watch& watch, ModuleReport& report, const Tell& tell) {
  gateway::BusRegistry registry;
  gateway::add_built_in_interfaces(registry, task.period_s);
  watch.step("loading");
  const auto& device = task.device;
  const bool control = report.module == device.digital_control_interface.name;
  const auto fits = control ? registry.check_control_interface(device.digital_control_interface, task.loader)
                            : registry.check_io_interface(device.digital_io_interface, task.loader);
  if (take(fits ? Checked() : Checked(refused("loading", fits.error())), "it is built in, or loads", report, tell)) {
    report.not_checked.emplace_back("what it does on its bus, which stays untouched");
    tell();
  }
}

}  // namespace

std::vector<Job> jobs_for(const sdk::DeviceObject& device) {
  std::vector<Job> jobs;
  jobs.push_back({"device driver", device.device_driver, check_driver_module});
  jobs.push_back({"kinematics", device.kinematics.name, check_kinematics_module});
  jobs.push_back({"actuator map", device.actuator_map.name, check_map_module});
  const auto add_law = [&jobs](const std::string& whose, const auto& loop) {
    if (loop.servo_law.name.empty()) return;
    const sdk::ModuleChoice choice{sdk::servo_law_module(loop.servo_law.name), loop.servo_law.numbers,
                                   loop.servo_law.texts};
    jobs.push_back(
        {"servo control law of " + whose, choice.name,
         [choice, gains = loop.gains](const Task& task, Watch& watch, ModuleReport& report, const Tell& tell) {
           check_law_module(task, choice, gains, watch, report, tell);
         }});
  };
  for (std::size_t j = 0; j < device.joint_count_with_held(); ++j) {
    const sdk::Joint& joint = sdk::joint_at(device, j);
    add_law("joint " + joint.limits.name, joint);
  }
  for (std::size_t i = 0; i < device.spindles.size(); ++i) add_law(fmt::format("spindle {}", i), device.spindles[i]);
  jobs.push_back({"digital control interface", device.digital_control_interface.name, check_interface});
  if (!device.digital_io_interface.name.empty()) {
    jobs.push_back({"digital I/O interface", device.digital_io_interface.name, check_interface});
  }
  jobs.push_back({"servo loops", "", check_servo_loops});
  jobs.push_back({"planned moves", "", check_planned_moves});
  return jobs;
}

}  // namespace rmac::verifier
