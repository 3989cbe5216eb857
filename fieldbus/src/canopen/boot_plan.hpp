#pragma once

#include <array>
#include <vector>

#include "rmac/fieldbus/canopen/canopen_config.hpp"

namespace rmac::fieldbus::canopen {

/// One step of bringing up a node: an object is read and compared, or written.
struct BootStep {
  enum class Kind : std::uint8_t {
    Check,    ///< (what was read & mask) must be `value`
    Write,    ///< `bytes`
    Read,     ///< for whoever asks later
    Compare,  ///< what of the mapping is to be changed: (what was read & mask) is not `value`
    Store,    ///< `bytes`, to memory, which takes its time
    Reset,    ///< of its communication, after which all begins anew
    Refuse,   ///< the node, because of what `needed` says
  };
  Kind kind = Kind::Write;
  ObjectAddress object;
  std::vector<std::uint8_t> bytes;
  std::uint32_t value = 0;
  std::uint32_t mask = 0xFFFFFFFF;
  bool optional = false;         ///< a refusal is noted and passed over, whatever its code
  bool may_be_absent = false;    ///< of refusals, that it has no such object is passed over, and no other
  bool may_be_constant = false;  ///< of a refused write: it is passed over where (what is read & mask) is `value`
  bool after_refusal = false;    ///< of the step before it alone: left out where that was not refused
  bool after_change = false;     ///< left out where each `Compare` before it found what is wanted
  const char* needed = "";       ///< for what, as it goes on behind "it is needed"
};

inline constexpr std::uint16_t kPdoOffset = 0x40;  ///< between the PDO numbers of two axes of a node (CiA 402-3)

/// The same object of another axis of a node; objects of the communication and the maker's own belong to the node.
[[nodiscard]] inline ObjectAddress of_axis(ObjectAddress object, std::uint16_t offset) noexcept {
  const bool shifts = object.index >= kFirstProfileObject && object.index < kFirstProfileObject + kAxisOffset;
  return shifts ? ObjectAddress{static_cast<std::uint16_t>(object.index + offset), object.sub} : object;
}

/// By which a drive makes units of position of its encoder's counts: encoder resolution, gear ratio, feed constant.
inline constexpr std::array<ObjectAddress, 6> kScaleObjects{
    {{0x608F, 1}, {0x608F, 2}, {0x6091, 1}, {0x6091, 2}, {0x6092, 1}, {0x6092, 2}}};

inline constexpr std::uint8_t kEverySync = 1;  ///< a transmission type (CiA 301, 7.5.2.35): sent with every SYNC
/// The transmission type of an axis's TPDO, or of its second one. It is read back when it was written.
[[nodiscard]] inline ObjectAddress transmission_type(const AxisConfig& axis, bool second) noexcept {
  return {static_cast<std::uint16_t>(second ? 0x1801 : 0x1800 + kPdoOffset * axis.axis_in_node), 2};
}

/// With which a plan begins, whatever the node's description: who it is.
inline constexpr std::size_t kIdentitySteps = 5;

/// All steps for `node`, in order: who it is, what its DCF says, what it can, its PDOs, its mode and setup, its watch
/// over the master; as `drive` describes it, which may be null.
[[nodiscard]] std::vector<BootStep> boot_plan(const CanopenConfig& config, std::uint8_t node,
                                              const DriveDescription* drive);

/// The plans of a node, made for each description that it may turn out to have, so that none is made on the cycle.
class BootPlans {
 public:
  struct Plan {
    const DriveDescription* drive = nullptr;  ///< null: none
    Patience patience;
    std::vector<BootStep> steps;
  };

  BootPlans(const CanopenConfig& config, std::uint8_t node);

  /// Nobody told who the node is.
  void forget() noexcept { at_ = 0; }
  /// The node told who it is. Real-time safe.
  void choose(const Identity& told) noexcept;
  [[nodiscard]] const Plan& now() const noexcept { return plans_[at_]; }
  /// Steps of the longest.
  [[nodiscard]] std::size_t longest() const noexcept;

 private:
  std::vector<Plan> plans_;
  std::size_t at_ = 0;
};

}  // namespace rmac::fieldbus::canopen
