#include <fmt/format.h>

#include <charconv>
#include <utility>

#include "gateway/simulators/vmodbus/device.hpp"

namespace rmac::vmodbus {
namespace {

using fieldbus::modbus::BitRange;
using fieldbus::modbus::IoMap;

/// Inputs that commands switch, and outputs that are printed.
class RemoteIo final : public Device {
 public:
  explicit RemoteIo(IoMap map) : Device(map.most_per_read), map_(std::move(map)) {
    for (const auto* ranges : {&map_.inputs, &map_.outputs}) {
      for (const BitRange& range : *ranges) tables().add(range.place.table, range.place.address, range.addresses());
    }
    write(map_.inputs, 0);
    write(map_.outputs, 0);
    told_ = status();
  }

  bool advance(double) override {
    const std::string before = std::exchange(told_, status());
    return before != told_;
  }

  [[nodiscard]] std::string status() const override {
    return fmt::format("{}: inputs {:X}h, outputs {:X}h", map_.name, inputs_, read(map_.outputs));
  }

  [[nodiscard]] Expected<std::string> execute(std::string_view verb, std::string_view value) override {
    const std::size_t space = value.find(' ');
    const std::string_view number = value.substr(0, space);
    const std::string_view state = space == std::string_view::npos ? "" : value.substr(space + 1);
    unsigned bit = 64;
    const auto [end, trouble] = std::from_chars(number.data(), number.data() + number.size(), bit);
    const bool sound = verb == "input" && trouble == std::errc() && end == number.data() + number.size() && bit < 64 &&
                       (state == "on" || state == "off");
    if (!sound) {
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("\"{} {}\" is no command of remote I/O; there are: {}", verb, value, help()));
    }
    const std::uint64_t one = std::uint64_t{1} << bit;
    inputs_ = state == "on" ? inputs_ | one : inputs_ & ~one;
    write(map_.inputs, inputs_);
    return status();
  }

  void reset() override { write(map_.outputs, 0); }
  [[nodiscard]] std::string_view help() const override { return "input BIT on|off"; }

 protected:
  void take(const Tables::Write&) override {}
  void show() override {}

 private:
  /// Where a bit of the map stands.
  struct Spot {
    std::uint16_t address;
    unsigned shift;
  };
  [[nodiscard]] static Spot spot(const BitRange& range, std::size_t bit) {
    const bool bits = fieldbus::modbus::of_bits(range.place.table);
    return {static_cast<std::uint16_t>(range.place.address + (bits ? bit : bit / 16)),
            bits ? 0U : static_cast<unsigned>(bit % 16)};
  }

  void write(const std::vector<BitRange>& ranges, std::uint64_t bits) {
    for (const BitRange& range : ranges) {
      for (std::size_t i = 0; i < range.count; ++i) {
        const bool on = ((bits >> (range.first + i) & 1U) != 0) != range.inverted;
        const Spot at = spot(range, i);
        const unsigned before = tables().get(range.place.table, at.address) & ~(1U << at.shift);
        tables().set(range.place.table, at.address, static_cast<std::uint16_t>(before | (on ? 1U << at.shift : 0U)));
      }
    }
  }

  [[nodiscard]] std::uint64_t read(const std::vector<BitRange>& ranges) const {
    std::uint64_t bits = 0;
    for (const BitRange& range : ranges) {
      for (std::size_t i = 0; i < range.count; ++i) {
        const Spot at = spot(range, i);
        const std::uint32_t value = tables().get(range.place.table, at.address);
        const bool on = (value >> at.shift & 1U) != 0;
        if (on != range.inverted) bits |= std::uint64_t{1} << (range.first + i);
      }
    }
    return bits;
  }

  IoMap map_;
  std::uint64_t inputs_ = 0;
  std::string told_;
};

}  // namespace

std::unique_ptr<Device> make_remote_io(IoMap map) {
  return std::make_unique<RemoteIo>(std::move(map));
}

}  // namespace rmac::vmodbus
