#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clients/legacy/gcode/values/grammar.hpp"
#include "clients/legacy/rs274/blocks/control_names.hpp"

namespace rmac::rs274 {

/// #1 to #5602, and #<names>. Those from 5061 on, and some names, are the control's own: programs read some and set
/// none. Names that begin with _ hold everywhere, others in the program or subprogram that sets them.
class Parameters : public gcode::Variables {
 public:
  static constexpr int kFirstOfControl = 5061, kLast = 5602;
  /// #1 to #30 are what a sub is called with.
  static constexpr std::size_t kArguments = 30;
  using Arguments = std::array<double, kArguments>;

  Parameters() { returned(std::nullopt); }

  /// What the control knows of one of its own; none where it knows nothing.
  using OfControl = std::function<std::optional<double>(const gcode::Name& name)>;
  void ask_control(OfControl of_control) { of_control_ = std::move(of_control); }

  [[nodiscard]] gcode::Maybe value(const gcode::Name& name, std::size_t place) const override;
  [[nodiscard]] bool is_set(const gcode::Name& name) const override;
  /// None where nothing set it.
  [[nodiscard]] std::optional<double> read(int number) const;
  [[nodiscard]] std::optional<double> read(std::string_view name) const;
  void set(int number, double value);
  void set(std::string_view name, double value);
  /// Whether a program only reads this name.
  [[nodiscard]] static bool is_of_control(std::string_view name) noexcept {
    return is_of_return(name) || control_name(name);
  }
  /// Whether the last sub gave it back.
  [[nodiscard]] static bool is_of_return(std::string_view name) noexcept { return name == kValue || name == kReturned; }

  /// A subprogram begins, with names of its own and, where it has arguments, with its own #1 to #30.
  void enter(const std::optional<Arguments>& arguments);
  /// It ends: what it had of its own is gone, and the caller's are there again.
  void leave();
  /// #<_value> and #<_value_returned>: what a sub gave back.
  void returned(std::optional<double> value);

 private:
  static constexpr std::string_view kValue = "_VALUE", kReturned = "_VALUE_RETURNED";

  using Names = std::map<std::string, double, std::less<>>;
  using Kept = std::array<std::optional<double>, kArguments>;
  struct Subprogram {
    Names names;
    std::optional<Kept> of_caller;  ///< its #1 to #30
  };

  [[nodiscard]] static bool is_global(std::string_view name) noexcept { return name.starts_with('_'); }
  [[nodiscard]] const Names& names() const noexcept { return within_.empty() ? program_ : within_.back().names; }

  std::array<std::optional<double>, kFirstOfControl> values_{};
  Names global_, program_;
  std::vector<Subprogram> within_;
  OfControl of_control_;
};

}  // namespace rmac::rs274
