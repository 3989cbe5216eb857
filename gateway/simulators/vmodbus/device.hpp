#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "gateway/simulators/vmodbus/tables.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::vmodbus {

/// How badly a slave answers.
struct Manners {
  bool mute = false;      ///< hears, acts, and answers nothing
  bool wrong_id = false;  ///< answers as another slave
  bool noise = false;     ///< answers with bytes that are no frame
  bool busy = false;      ///< refuses all with exception 6
  double late_s = 0;      ///< the whole answer so much later
  double drip_s = 0;      ///< so much between two bytes
};

/// A slave: its tables, and what is behind them.
class Device {
 public:
  explicit Device(std::size_t most_per_read) : tables_(most_per_read) {}
  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// Answers a request: function and data.
  [[nodiscard]] Bytes answer(std::span<const std::uint8_t> request);
  /// Time passes; true when what it is doing has changed, for whoever prints it.
  virtual bool advance(double seconds) = 0;
  /// What it does now, in a few words.
  [[nodiscard]] virtual std::string status() const = 0;
  /// Carries out a command of its own kind; its answer.
  [[nodiscard]] virtual Expected<std::string> execute(std::string_view verb, std::string_view value) = 0;
  /// As after power on.
  virtual void reset() = 0;
  /// The commands that `execute` knows, for --help.
  [[nodiscard]] virtual std::string_view help() const = 0;

  Manners manners;

 protected:
  virtual void take(const Tables::Write& write) = 0;
  /// Brings the tables up to date with what is behind them.
  virtual void show() = 0;
  Tables& tables() { return tables_; }
  [[nodiscard]] const Tables& tables() const { return tables_; }

  double unasked_s = 0;  ///< since the last request, as far as `advance` counts it

 private:
  Tables tables_;
};

/// What speeds are by a spindle drive's map where the map alone does not say.
struct SpindleOptions {
  double maximum_hz = 400;
  double ramp_hz_s = 200;
  double time_out_s = 0;       ///< without a request: one that runs stops; 0: never
  unsigned time_out_code = 0;  ///< that it trips with, instead of ramping down; 0: none
};

/// A device as a register map describes it; the file says which kind it is.
[[nodiscard]] Expected<std::unique_ptr<Device>> make_device(const std::string& map_file, const SpindleOptions& options);

[[nodiscard]] std::unique_ptr<Device> make_spindle(fieldbus::modbus::SpindleMap map, const SpindleOptions& options);
[[nodiscard]] std::unique_ptr<Device> make_remote_io(fieldbus::modbus::IoMap map);

}  // namespace rmac::vmodbus
