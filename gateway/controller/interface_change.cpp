// The same mechanism over another interface to its drives. Two interfaces cannot run one bus, so this is no swap
// between two cycles: the drives come down with the old one, and up with the new one or, when that fails, with the old
// one again.
#include <fmt/format.h>

#include "gateway/controller/controller_impl.hpp"
#include "gateway/mechanism/standing.hpp"

namespace rmac::gateway {

bool Controller::Impl::same_choice(const sdk::ModuleChoice& one, const sdk::ModuleChoice& other) {
  return one.name == other.name && one.numbers == other.numbers && one.texts == other.texts;
}

Expected<> Controller::Impl::exchange_interface(const sdk::DeviceObject& device) {
  auto may = check_device(device).and_then(
      [&] { return registry.check_control_interface(device.digital_control_interface, loader(folder)); });
  if (!may) return may;
  const sdk::DeviceObject before = in_force->device;
  // Whoever borrows a bus keeps it: nobody may hold the mechanism in force now.
  const auto let_go = [&] {
    auto off = switch_off();
    tell_cam(nullptr, false);
    in_force.reset();
    registry.stop_unused();
    return off;
  };
  auto done = let_go();
  if (done) {
    auto next = assemble(device, assembly_options(false), loader(folder), registry);
    done = next ? switch_to(std::move(*next), false) : Expected<>(tl::unexpected(next.error()));
  }
  if (done) done = power_on();
  if (done) {
    const ServoStatus now = link->status.read();
    done = check_standing(device, {now.position_set.data(), now.axis_count}, true);
  }
  if (!done) {
    if (in_force) (void)let_go();
    registry.stop_unused();
    const std::string trouble = put_back(before, false);
    tell_cam(in_force ? &in_force->device : nullptr, false);
    return failure(done.error().code, trouble.empty()
                                          ? fmt::format("{}; {} is in force again over {}", done.error().message,
                                                        before.name, before.digital_control_interface.name)
                                          : fmt::format("{}; and {} could not be put back: {}", done.error().message,
                                                        before.name, trouble));
  }
  bound_spindles(device);
  tell_cam(&in_force->device, false);
  const std::string told = fmt::format("{} is configured over {}", device.name, device.digital_control_interface.name);
  draft.discard(&in_force->device);
  registry.stop_unused();
  tell_of_mechanism(told);
  return {};
}

}  // namespace rmac::gateway
