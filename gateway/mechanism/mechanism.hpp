#pragma once

#include <memory>

#include "gateway/modules/module_loader.hpp"
#include "rmac/motion/follower/plan_follower.hpp"
#include "rmac/motion/path_builder.hpp"
#include "rmac/motion/plan_channel.hpp"
#include "rmac/motion/planner.hpp"
#include "rmac/motion/servo/servo_loop.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// One mechanism, assembled: its modules in a servo loop, and the chain from moves to setpoints. Built and destroyed on
/// the gateway thread. While it is in force the servo thread uses `loop` and `follower`; `planner` is used under the
/// lock of the machine's cycle, by whoever has a turn; `builder` is the gateway thread's alone, and needs no lock.
struct Mechanism {
  Mechanism(sdk::DeviceObject device_object, PlannerModel model, std::shared_ptr<ServoLoop> servo_loop,
            std::vector<ModuleInUse> modules_in_use)
      : device(std::move(device_object)),
        modules(std::move(modules_in_use)),
        loop(std::move(servo_loop)),
        follower(channel, model.joints, model.period_s),
        builder(model),
        planner(model, channel),
        planner_model(std::move(model)) {}

  /// The same servo loop with nothing planned: what is left of a mechanism after a fault.
  [[nodiscard]] std::shared_ptr<Mechanism> with_empty_path() const {
    return std::make_shared<Mechanism>(device, planner_model, loop, modules);
  }

  [[nodiscard]] bool virtual_mode() const noexcept { return loop->parts().virtual_mode; }

  sdk::DeviceObject device;
  std::vector<ModuleInUse> modules;  ///< its device driver is its host's
  std::shared_ptr<ServoLoop> loop;
  PlanChannel channel;
  PlanFollower follower;
  PathBuilder builder;
  Planner planner;
  PlannerModel planner_model;
};

}  // namespace rmac::gateway
