// Frames on a CAN bus, to whatever the master does on it: scanning, LSS, storing parameters, starting a machine and
// running it. Eleven bytes a frame: when it comes, its identifier and length, its data.
#include <algorithm>
#include <array>
#include <memory>

#include "memory_file.hpp"
#include "rmac/fieldbus/can/can_port.hpp"
#include "rmac/fieldbus/canopen/bus_scan.hpp"
#include "rmac/fieldbus/canopen/canopen_interface.hpp"
#include "rmac/fieldbus/canopen/lss.hpp"
#include "rmac/fieldbus/canopen/stored_parameters.hpp"

namespace {

using namespace rmac::fieldbus;
using namespace rmac::fieldbus::canopen;

/// The bytes of an input as a bus. Time passes only when someone waits.
class BytesOnABus final : public CanPort {
 public:
  BytesOnABus(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  bool send(const CanFrame& frame) noexcept override {
    asked_ = frame;
    open_ = true;
    return true;
  }
  bool receive(CanFrame& frame) noexcept override {
    if (!open_ || size_ < kFrame) return false;
    const std::uint8_t way = data_[0];
    open_ = (way & 1U) != 0;  // more of them before the master sends again
    frame.id = static_cast<std::uint16_t>((data_[1] | data_[2] << 8) & 0x7FF);
    if ((way & 2U) != 0) frame.id = answer_id();
    frame.size = static_cast<std::uint8_t>((way >> 4U) % 9);
    std::copy_n(data_ + 3, 8, frame.data.begin());
    if ((way & 4U) != 0) std::copy_n(asked_.data.begin() + 1, 3, frame.data.begin() + 1);
    data_ += kFrame;
    size_ -= kFrame;
    return true;
  }
  void wait(std::chrono::nanoseconds at_most) noexcept override {
    now_ += std::max<std::chrono::nanoseconds>(at_most, std::chrono::microseconds(100));
    open_ = true;
  }
  [[nodiscard]] std::chrono::nanoseconds now() const noexcept override { return now_; }
  [[nodiscard]] CanHealth health() const noexcept override { return {}; }

 private:
  static constexpr std::size_t kFrame = 11;
  /// Where what was sent last is answered.
  [[nodiscard]] std::uint16_t answer_id() const noexcept {
    if (asked_.id == 0x7E5) return 0x7E4;
    return asked_.id > 0x600 && asked_.id < 0x680 ? static_cast<std::uint16_t>(asked_.id - 0x80) : 0x705;
  }

  const std::uint8_t* data_;
  std::size_t size_;
  CanFrame asked_;
  bool open_ = true;
  std::chrono::nanoseconds now_{0};
};

void start_a_machine(const std::uint8_t* data, std::size_t size) {
  static const auto config = read_canopen_config("can0", {{"node", {5, 6}}, {"boot_timeout_s", {1}}}, {}, 0.001);
  if (!config) std::abort();
  CanopenInterface master(*config, [&](std::span<const std::uint16_t>, std::size_t) {
    return rmac::Expected<std::unique_ptr<CanPort>>(std::make_unique<BytesOnABus>(data, size));
  });
  if (!master.start()) return;
  std::array<rmac::DriveCommand, 2> commands{};
  std::array<rmac::DriveFeedback, 2> answers{};
  for (int i = 0; i < 50 && master.exchange(commands, answers); ++i) {
  }
  master.stop();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  BytesOnABus port(data + 1, size - 1);
  switch (data[0] % 4) {
    case 0:
      static_cast<void>(scan_bus(port, {.listen = std::chrono::milliseconds(0)}));
      break;
    case 1:
      static_cast<void>(lss_scan(port));
      break;
    case 2:
      static_cast<void>(store_parameters(port, 5, StoreCommand::Save));
      break;
    default:
      start_a_machine(data + 1, size - 1);
  }
  return 0;
}
