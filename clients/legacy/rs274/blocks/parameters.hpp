#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace rmac::rs274 {

/// #1 to #5602, and #<names>. Those from 5061 on are the control's own: programs read some and set none.
class Parameters {
 public:
  static constexpr int kFirstOfControl = 5061, kLast = 5602;

  /// What the control knows of one of its own; none where it knows nothing.
  using OfControl = std::function<std::optional<double>(int number)>;
  void ask_control(OfControl of_control) { of_control_ = std::move(of_control); }

  /// None where nothing set it.
  [[nodiscard]] std::optional<double> read(int number) const;
  [[nodiscard]] std::optional<double> read(std::string_view name) const;
  void set(int number, double value);
  void set(std::string_view name, double value);

 private:
  std::array<std::optional<double>, kFirstOfControl> values_{};
  std::map<std::string, double, std::less<>> named_;
  OfControl of_control_;
};

}  // namespace rmac::rs274
