#include "gateway/rmac_cam/settings/device_in_force.hpp"

#include <fmt/format.h>

#include "gateway/json/printable.hpp"

namespace rmac::gateway {
namespace {

Expected<std::uint64_t> find_bit(const std::map<std::string, int>& bits, const char* what, const std::string& name,
                                 const std::string& machine, const char* function) {
  const auto found = bits.find(name);
  if (found != bits.end()) return std::uint64_t{1} << found->second;
  constexpr std::size_t kLongestName = 40;
  std::string names;
  for (const auto& [known, bit] : bits) names += (names.empty() ? "" : ", ") + known;
  return failure(MinorCode::InvalidParameterValue,
                 fmt::format("{}: there is no {} named \"{}\"; the DigitalIOInterface of {} has {}", function, what,
                             printable(name, kLongestName), machine, names.empty() ? "none" : names));
}

}  // namespace

const sdk::DeviceObject& DeviceInForce::get_or_empty() const noexcept {
  static const sdk::DeviceObject kEmpty;
  return device_ != nullptr ? *device_ : kEmpty;
}

Expected<> DeviceInForce::require(const char* function) const {
  if (device_ != nullptr) return {};
  return failure(MinorCode::Other, fmt::format("{}: no mechanism is loaded; load one with Device.Load", function));
}

Expected<std::size_t> DeviceInForce::find_joint(int joint, const char* function) const {
  if (auto loaded = require(function); !loaded) return tl::unexpected(loaded.error());
  const auto count = static_cast<int>(device_->joints.size());
  if (joint >= 0 && joint < count) return static_cast<std::size_t>(joint);
  return failure(MinorCode::InvalidParameterValue,
                 fmt::format("{}: there is no joint {}; joints are 0 to {}", function, joint, count - 1));
}

Expected<std::size_t> DeviceInForce::find_spindle(int spindle, const char* function) const {
  if (auto loaded = require(function); !loaded) return tl::unexpected(loaded.error());
  const std::size_t count = device_->spindles.size();
  if (spindle >= 0 && static_cast<std::size_t>(spindle) < count) return static_cast<std::size_t>(spindle);
  return failure(MinorCode::InvalidParameterValue,
                 count == 0
                     ? fmt::format("{}: the mechanism has no spindle", function)
                     : fmt::format("{}: there is no spindle {}; spindles are 0 to {}", function, spindle, count - 1));
}

Expected<std::uint64_t> DeviceInForce::find_input(const std::string& name, const char* function) const {
  if (auto loaded = require(function); !loaded) return tl::unexpected(loaded.error());
  return find_bit(device_->inputs, "input", name, device_->name, function);
}

Expected<std::uint64_t> DeviceInForce::find_output(const std::string& name, const char* function) const {
  if (auto loaded = require(function); !loaded) return tl::unexpected(loaded.error());
  return find_bit(device_->outputs, "output", name, device_->name, function);
}

std::uint64_t DeviceInForce::coolant() const {
  const sdk::DeviceObject& device = get_or_empty();
  const auto output = device.outputs.find("Coolant");
  return output == device.outputs.end() ? 0 : std::uint64_t{1} << output->second;
}

}  // namespace rmac::gateway
