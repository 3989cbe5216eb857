#pragma once

namespace rmac {

/// Least and largest of a value.
struct Range {
  double least = 0, most = 0;
  void begin(double value) noexcept { least = most = value; }
  void add(double value) noexcept {
    if (value < least) least = value;
    if (value > most) most = value;
  }
  void add(const Range& other) noexcept {
    add(other.least);
    add(other.most);
  }
  [[nodiscard]] double width() const noexcept { return most - least; }
};

}  // namespace rmac
