#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "rmac/fieldbus/canopen/lss.hpp"

namespace rmac::fieldbus::canopen {

/// Command specifiers (CiA 305, 3.8).
enum class LssCommand : std::uint8_t {
  SwitchAll = 0x04,
  ConfigureNode = 0x11,
  ConfigureBitTiming = 0x13,
  ActivateBitTiming = 0x15,
  StoreConfiguration = 0x17,
  SelectVendor = 0x40,
  SelectProduct = 0x41,
  SelectRevision = 0x42,
  SelectSerial = 0x43,
  Selected = 0x44,
  Identified = 0x4F,
  FastScan = 0x51,
  InquireVendor = 0x5A,
  InquireNode = 0x5E
};

/// Vendor, product, revision and serial number, in the order in which LSS asks for them.
using IdentityParts = std::array<std::uint32_t, 4>;
[[nodiscard]] IdentityParts parts_of(const Identity& identity) noexcept;
[[nodiscard]] Error several_of(const Identity& identity, std::size_t nodes);
/// Byte `at` of a number, the least significant first.
[[nodiscard]] constexpr std::uint8_t byte(std::uint32_t number, unsigned at) noexcept {
  return static_cast<std::uint8_t>(number >> (8 * at));
}

/// The master's side of LSS, request by request. All nodes wait when it ends.
class LssMaster {
 public:
  /// Answers to one request.
  struct Answers {
    std::vector<CanFrame> frames;
    std::chrono::nanoseconds last{0};  ///< from the request to the last of them
  };

  LssMaster(CanPort& port, const LssOptions& options) : port_(port), options_(options) {}
  LssMaster(const LssMaster&) = delete;
  LssMaster& operator=(const LssMaster&) = delete;
  ~LssMaster() { switch_all(false); }

  /// Refuses a bus at work, and has all nodes wait: one may still configure that a master left so.
  Expected<> begin();
  void switch_all(bool configure);
  void activate_bit_timing(std::chrono::milliseconds delay);

  /// What comes in `window`, all of which passes: any number of nodes may answer, each when it is ready.
  Answers gather(LssCommand request, std::initializer_list<std::uint8_t> rest, LssCommand answer,
                 std::chrono::nanoseconds window);
  /// The first answer to a request; asked once more where none comes.
  std::optional<CanFrame> ask(LssCommand request, std::initializer_list<std::uint8_t> rest, LssCommand answer);

  /// The node of this identity configures from now on.
  Expected<> select(const Identity& identity);
  /// Exactly one node configures, and it is this one.
  Expected<> check_selected(const Identity& identity);
  /// Has the node that configures do something; it says 0, or why not.
  Expected<> configure(LssCommand request, std::initializer_list<std::uint8_t> rest, const std::string& what);
  std::optional<std::uint8_t> node_of_selected();

  [[nodiscard]] const LssOptions& options() const noexcept { return options_; }

 private:
  void send(LssCommand command, std::initializer_list<std::uint8_t> rest);
  /// Only an answer that comes from now on can belong to the next request.
  void forget_received();

  CanPort& port_;
  LssOptions options_;
};

}  // namespace rmac::fieldbus::canopen
