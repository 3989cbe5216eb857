#include "gateway/rmac_cam/cam_guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gateway/json/printable.hpp"
#include "gateway/mechanism/mechanism.hpp"

namespace rmac::gateway {
namespace {

tl::unexpected<Error> prefixed(const char* function, const Error& error) {
  return failure(error.code, fmt::format("{}: {}", function, error.message));
}

/// An overlay stands for the machine below it.
const std::string& machine_of(const sdk::DeviceObject& device) {
  return device.overlay ? device.overlay_of : device.name;
}

}  // namespace

Expected<CamGuard::InForce> CamGuard::read(const nlohmann::json& object) const {
  auto setup = read_setup_object(object);
  if (!setup) return prefixed("SetSetup", setup.error());
  if (const std::string& machine = machine_of(*device_.get()); setup->machine != machine) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("SetSetup: /Machine is \"{}\", and {} is loaded", printable(setup->machine), machine));
  }
  auto scene = scene_bodies(*shape_.bodies(), *setup);
  if (!scene) return prefixed("SetSetup", scene.error());
  return InForce{object, std::move(*setup), std::move(*scene)};
}

Expected<std::shared_ptr<ClearWay>> CamGuard::way_for(const InForce& in_force) const {
  const std::shared_ptr<Mechanism> mechanism = supervisor_.mechanism();
  std::vector<JointLimits> joints;
  for (const sdk::Joint& joint : device_.get()->joints) joints.push_back(joint.limits);
  return LinkChain::make(*mechanism->planner_model.kinematics, shape_.bodies()->chain, joints)
      .map([&](LinkChain chain) {
        return std::make_shared<ClearWay>(std::move(chain), in_force.scene, in_force.setup.part_frame,
                                          in_force.setup.clearance_mm);
      });
}

Expected<> CamGuard::set_setup(const nlohmann::json& setup) {
  auto ready = device_.require("SetSetup").and_then([&] { return supervisor_.require_rest("SetSetup"); });
  if (!ready) return ready;
  if (setup.is_null()) return clear();
  auto next = read(setup);
  if (!next) return tl::unexpected(next.error());
  if (checks()) {
    auto way = way_for(*next);
    if (!way) return prefixed("SetSetup", way.error());
    if (auto put = supervisor_.guarding().put_in("SetSetup", std::move(*way)); !put) return put;
  }
  in_force_ = std::move(*next);
  return {};
}

Expected<> CamGuard::clear() {
  if (checks()) {
    if (auto off = supervisor_.guarding().put_in("SetSetup", nullptr); !off) return off;
    tell_off("the set-up was cleared");
  }
  in_force_.reset();
  return {};
}

Expected<> CamGuard::set_check(bool on) {
  constexpr const char* kFunction = "SetCollisionCheck";
  if (auto loaded = device_.require(kFunction); !loaded) return loaded;
  if (on == checks()) return {};
  if (!on) {
    return supervisor_.guarding().put_in(kFunction, nullptr).map([&] { tell_off("SetCollisionCheck was sent"); });
  }
  if (!in_force_) {
    return failure(
        MinorCode::Other,
        "SetCollisionCheck: there is no set-up to check against; send what stands on the table with SetSetup");
  }
  if (shape_.bodies()->bodies.empty()) {
    return failure(MinorCode::UnsupportedOperation,
                   fmt::format("SetCollisionCheck: device.json of {} has no Geometry, so that collisions cannot be "
                               "checked",
                               machine_of(*device_.get())));
  }
  if (std::ranges::any_of(supervisor_.wishes().force, [](double force) { return force != 0; })) {
    return failure(MinorCode::Other,
                   "SetCollisionCheck: a joint keeps a force, and where it goes for that is not known ahead; set "
                   "SetJointForce to 0 first");
  }
  auto way = way_for(*in_force_);
  if (!way) return prefixed(kFunction, way.error());
  return supervisor_.guarding().put_in(kFunction, std::move(*way));
}

void CamGuard::mechanism_changed(bool fresh) {
  const bool checked = checks();
  if (fresh) {
    if (checked) supervisor_.guarding().replace(nullptr);
    if (std::exchange(in_force_, std::nullopt)) {
      tell_off(checked
                   ? "the machine was loaded or unloaded, and its set-up dropped"
                   : "the machine was loaded or unloaded, and its set-up, against which nothing was checked, dropped");
    }
    return;
  }
  if (!checked || device_.get() == nullptr) return;  // it comes back, configured anew
  auto way = way_for(*in_force_);
  if (way) return supervisor_.guarding().replace(std::move(*way));
  supervisor_.guarding().replace(nullptr);
  tell_off("the machine was configured anew, and " + way.error().message);
}

void CamGuard::tell_off(const std::string& why) {
  supervisor_.guarding().tell(Event::Kind::NotChecked,
                              fmt::format("nothing is held against a set-up before it moves: {}", why));
}

}  // namespace rmac::gateway
