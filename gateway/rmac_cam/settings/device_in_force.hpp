#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "rmac/motion/error.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// The mechanism in force as the parts of RMAC_CAM look things up in it. `function` is what an error names: the call
/// that could not be carried out. Gateway thread only.
class DeviceInForce {
 public:
  /// From now on it is this one, which must outlive being in force; nullptr: none.
  void change(const sdk::DeviceObject* device) noexcept { device_ = device; }

  [[nodiscard]] const sdk::DeviceObject* get() const noexcept { return device_; }
  /// One of no joints where none is in force.
  [[nodiscard]] const sdk::DeviceObject& get_or_empty() const noexcept;
  [[nodiscard]] Expected<> require(const char* function) const;
  /// The index of a joint that the mechanism moves.
  [[nodiscard]] Expected<std::size_t> find_joint(int joint, const char* function) const;
  [[nodiscard]] Expected<std::size_t> find_spindle(int spindle, const char* function) const;
  /// The input of this name, as a bit of the machine's inputs; an error tells which there are.
  [[nodiscard]] Expected<std::uint64_t> find_input(const std::string& name, const char* function) const;
  [[nodiscard]] Expected<std::uint64_t> find_output(const std::string& name, const char* function) const;
  /// The output named Coolant, as a bit of the machine's outputs; 0 where there is none.
  [[nodiscard]] std::uint64_t coolant() const;

 private:
  const sdk::DeviceObject* device_ = nullptr;
};

}  // namespace rmac::gateway
