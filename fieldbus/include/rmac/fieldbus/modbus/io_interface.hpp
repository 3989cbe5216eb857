#pragma once

#include <memory>

#include "rmac/fieldbus/fault_texts.hpp"
#include "rmac/fieldbus/modbus/line_report.hpp"
#include "rmac/fieldbus/modbus/modbus_config.hpp"
#include "rmac/motion/ports/digital_io_interface.hpp"

namespace rmac::fieldbus::modbus {

/// A device for inputs and outputs on a Modbus line, behind the I/O port. Inputs are as old as `stale` at most: beyond
/// that `exchange` fails, and the outputs are to fall until the device answers again.
class IoInterface final : public DigitalIoInterface, public ExchangeFaultText, public LineReports {
 public:
  explicit IoInterface(IoLineConfig config);
  ~IoInterface() override;
  IoInterface(const IoInterface&) = delete;
  IoInterface& operator=(const IoInterface&) = delete;

  [[nodiscard]] Expected<> start() override;
  void stop() noexcept override;
  [[nodiscard]] bool exchange(std::uint64_t outputs, std::uint64_t& inputs) noexcept override;
  [[nodiscard]] std::string fault_text() const override;
  [[nodiscard]] LineReport line_report() const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rmac::fieldbus::modbus
