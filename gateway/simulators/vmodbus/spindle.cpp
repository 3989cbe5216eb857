#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <tuple>
#include <utility>

#include "gateway/simulators/vmodbus/device.hpp"

namespace rmac::vmodbus {
namespace {

using fieldbus::modbus::Condition;
using fieldbus::modbus::Quantity;
using fieldbus::modbus::RegisterWrite;
using fieldbus::modbus::SpindleMap;

/// A frequency converter with its motor: it follows its speed command along a ramp while it is told to run.
class Spindle final : public Device {
 public:
  Spindle(SpindleMap map, const SpindleOptions& options)
      : Device(map.most_per_read), map_(std::move(map)), options_(options) {
    tables().add(map_.speed_command.place);
    tables().add(map_.speed.place);
    for (const auto& place : {map_.speed_read_back, map_.fault_code}) {
      if (place) tables().add(*place);
    }
    for (const auto* condition : conditions()) tables().add(condition->place);
    for (const auto* list : {&map_.forward_run, &map_.backward_run, &map_.stop, &map_.reset_fault}) {
      for (const RegisterWrite& write : *list) tables().add(write.table, write.address);
    }
    show();
  }

  bool advance(double seconds) override {
    unasked_s += seconds;
    if (options_.time_out_s > 0 && unasked_s >= options_.time_out_s && direction_ != 0) end_of_talk();
    const double wanted = direction_ * commanded_hz();
    const double step = options_.ramp_hz_s * seconds;
    hz_ = tripped_ ? hz_ : std::clamp(wanted, hz_ - step, hz_ + step);
    if (tripped_) hz_ = std::copysign(std::max(std::abs(hz_) - step, 0.0), hz_);  // it coasts
    show();
    const auto doing = std::tuple(direction_, tripped_, hz_ == wanted);
    return std::exchange(told_, doing) != doing;
  }

  [[nodiscard]] std::string status() const override {
    const char* way = direction_ > 0 ? "runs forward" : direction_ < 0 ? "runs backward" : "stopped";
    const std::string text =
        fmt::format("{}: {} at {:.1f} of {:.1f} Hz", map_.name, way, std::abs(hz_), commanded_hz());
    return tripped_ ? fmt::format("{}, tripped with {}", text, code_) : text;
  }

  [[nodiscard]] Expected<std::string> execute(std::string_view verb, std::string_view value) override {
    if (verb == "panel-stop") {
      direction_ = 0;
      show();
      return status();
    }
    unsigned code = 0;
    const auto [end, trouble] = std::from_chars(value.data(), value.data() + value.size(), code);
    if (verb != "trip" || trouble != std::errc() || end != value.data() + value.size() || code == 0 || code > 0xFFFF) {
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("\"{} {}\" is no command of a spindle drive; there are: {}", verb, value, help()));
    }
    trip(code);
    show();
    return status();
  }

  void reset() override {
    direction_ = 0;
    hz_ = 0;
    tripped_ = false;
    for (const auto* list : {&map_.forward_run, &map_.backward_run, &map_.stop, &map_.reset_fault}) {
      for (const RegisterWrite& write : *list) tables().set(write.table, write.address, 0);
    }
    tables().set_raw(map_.speed_command.place, 0);
    show();
  }

  [[nodiscard]] std::string_view help() const override { return "trip CODE, panel-stop"; }

 protected:
  void take(const Tables::Write& write) override {
    if (written(map_.reset_fault, write)) tripped_ = false;
    if (written(map_.stop, write)) direction_ = 0;
    if (tripped_) return;
    if (written(map_.forward_run, write)) direction_ = 1;
    if (written(map_.backward_run, write)) direction_ = -1;
  }

  void show() override {
    const double output = map_.speed.place.is_signed ? hz_ : std::abs(hz_);
    tables().set_raw(map_.speed.place, static_cast<std::uint32_t>(std::llround(output * map_.speed.per_unit)));
    if (map_.speed_read_back) tables().set_raw(*map_.speed_read_back, tables().raw(map_.speed_command.place));
    if (map_.fault_code) tables().set_raw(*map_.fault_code, tripped_ ? code_ : 0);
    for (const Condition* condition : conditions()) show(condition->place);
  }

 private:
  void trip(unsigned code) {
    tripped_ = true;
    code_ = code;
    direction_ = 0;
  }
  /// Nobody talks to it any more.
  void end_of_talk() {
    direction_ = 0;
    if (options_.time_out_code != 0) trip(options_.time_out_code);
  }

  /// This write completes the list: its other addresses stand as the list has them. Of a pulse, values one after the
  /// other at one address, the first counts.
  [[nodiscard]] bool written(const std::vector<RegisterWrite>& list, const Tables::Write& write) const {
    const auto at_its_address = [&](const RegisterWrite& one) {
      return one.table == write.table && one.address == write.address;
    };
    const auto first = std::find_if(list.begin(), list.end(), at_its_address);
    return first != list.end() && first->value == write.value &&
           std::all_of(list.begin(), list.end(), [&](const RegisterWrite& one) {
             return at_its_address(one) || tables().get(one.table, one.address) == one.value;
           });
  }

  [[nodiscard]] double commanded_hz() const {
    const double raw = tables().raw(map_.speed_command.place) / map_.speed_command.per_unit;
    return map_.speed_command_unit == SpindleMap::Unit::Hertz ? raw : raw * options_.maximum_hz;
  }

  [[nodiscard]] std::vector<const Condition*> conditions() const {
    std::vector<const Condition*> all;
    for (const auto* condition : {&map_.running, &map_.backward, &map_.tripped}) {
      if (*condition) all.push_back(&**condition);
    }
    return all;
  }
  [[nodiscard]] bool truth(const Condition& condition) const {
    if (map_.running && &condition == &*map_.running) return direction_ != 0 || hz_ != 0;
    if (map_.backward && &condition == &*map_.backward) return hz_ < 0 || (hz_ == 0 && direction_ < 0);
    return tripped_;
  }

  /// A value for all conditions on the same bits: the first that makes each of them what it is.
  void show(const Place& place) {
    std::vector<const Condition*> here;
    std::vector<std::uint32_t> candidates;
    for (const Condition* condition : conditions()) {
      const Place& other = condition->place;
      if (other.table != place.table || other.address != place.address || other.mask != place.mask) continue;
      here.push_back(condition);
      candidates.insert(candidates.end(), condition->is.begin(), condition->is.end());
    }
    constexpr std::uint32_t kNeitherOf = 256;
    for (std::uint32_t i = 0; i < kNeitherOf; ++i) candidates.push_back(i & place.mask);
    const auto fits = [&](std::uint32_t value) {
      return std::all_of(here.begin(), here.end(), [&](const Condition* condition) {
        const auto& is = condition->is;
        return (std::find(is.begin(), is.end(), value) != is.end()) == truth(*condition);
      });
    };
    const auto found = std::find_if(candidates.begin(), candidates.end(), fits);
    if (found != candidates.end()) tables().set_raw(place, *found);
  }

  SpindleMap map_;
  SpindleOptions options_;
  int direction_ = 0;  ///< that it is told
  double hz_ = 0;      ///< of the output, negative backward
  bool tripped_ = false;
  std::uint32_t code_ = 0;
  std::tuple<int, bool, bool> told_{0, false, true};  ///< way, tripped, at its speed
};

}  // namespace

std::unique_ptr<Device> make_spindle(SpindleMap map, const SpindleOptions& options) {
  return std::make_unique<Spindle>(std::move(map), options);
}

}  // namespace rmac::vmodbus
