#pragma once

#include <atomic>
#include <vector>

#include "rmac/fieldbus/fault_texts.hpp"
#include "rmac/fieldbus/gpio/gpio_config.hpp"
#include "rmac/fieldbus/gpio/input_signal.hpp"
#include "rmac/motion/ports/digital_io_interface.hpp"

namespace rmac::fieldbus::gpio {

/// GPIO lines behind the I/O port. It has no thread: each cycle takes the edges that the kernel has kept, so that an
/// input acts in the cycle after its edge. `exchange` fails, with outputs inactive, while the contacts of an input
/// disagree or the chip does not answer.
class GpioInterface final : public DigitalIoInterface, public ExchangeFaultText {
 public:
  GpioInterface(GpioConfig config, std::unique_ptr<LinePort> port);
  ~GpioInterface() override;
  GpioInterface(const GpioInterface&) = delete;
  GpioInterface& operator=(const GpioInterface&) = delete;

  [[nodiscard]] Expected<> start() override;
  void stop() noexcept override;
  [[nodiscard]] bool exchange(std::uint64_t outputs, std::uint64_t& inputs) noexcept override;
  [[nodiscard]] double on_for_s(std::size_t bit) const noexcept override;
  [[nodiscard]] std::uint64_t input_bits() const noexcept override { return input_bits_; }
  [[nodiscard]] std::uint64_t output_bits() const noexcept override { return output_bits_; }
  [[nodiscard]] std::string fault_text() const override;

 private:
  /// Where an input line leads.
  struct Contact {
    std::size_t signal = 0;
    std::size_t contact = 0;
    bool inverted = false;
  };
  static constexpr int kSound = -1;
  static constexpr int kChip = -2;

  [[nodiscard]] bool write(std::uint64_t outputs) noexcept;

  GpioConfig config_;
  std::unique_ptr<LinePort> port_;
  std::vector<Contact> contacts_;     ///< one an input line
  std::vector<InputSignal> signals_;  ///< one an input
  std::uint64_t input_bits_ = 0;
  std::uint64_t output_bits_ = 0;
  std::uint64_t written_ = 0;
  Time looked_{};  ///< when the last exchange did
  bool open_ = false;
  std::atomic<int> trouble_{kChip};  ///< of the last exchange that failed: an input whose contacts disagree, or kChip
};

}  // namespace rmac::fieldbus::gpio
