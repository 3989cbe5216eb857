#include "gateway/simulators/vdrive/axis/axis_units.hpp"

namespace rmac::vdrive {

double AxisUnits::per_count() const {
  const auto ratio = [this](std::uint16_t index) {
    return static_cast<double>(dictionary_.number(index, 1)) / static_cast<double>(dictionary_.number(index, 2));
  };
  return ratio(0x6092) / (ratio(0x608F) * ratio(0x6091));
}

double AxisUnits::of_position() const {
  return (dictionary_.number(0x607E) & 0x80) != 0 ? -per_count() : per_count();
}

double AxisUnits::of_velocity() const {
  return (dictionary_.number(0x607E) & 0x40) != 0 ? -per_count() : per_count();
}

}  // namespace rmac::vdrive
