#pragma once

#include <array>
#include <functional>
#include <map>
#include <string_view>
#include <vector>

#include "clients/legacy/gcode/values/grammar.hpp"

namespace rmac::fanuc {

/// #0, which is always vacant; #1 to #33, which a macro has of its own; #100 to #199 and #500 to #999, which are
/// everybody's; and those of the system.
class Variables : public gcode::Variables {
 public:
  static constexpr int kLocals = 33, kFirstOfSystem = 1000, kLast = 99'999;
  using Locals = std::array<gcode::Maybe, kLocals + 1>;  ///< by their numbers

  /// `common`: what the machine has in common variables.
  explicit Variables(const std::map<int, double>& common);

  /// What the control reads and does where a program reads and sets variables of its own. Each may refuse.
  struct System {
    std::function<gcode::Maybe(int number, std::size_t place)> read;
    std::function<void(int number, gcode::Maybe value, std::string_view message, std::size_t place)> write;
  };
  void set_system(System system) { system_ = std::move(system); }

  [[nodiscard]] gcode::Maybe value(const gcode::Name& name, std::size_t place) const override;
  [[nodiscard]] bool is_set(const gcode::Name& name) const override;
  /// `message`: the comment beside it.
  void set(int number, gcode::Maybe value, std::string_view message, std::size_t place);

  /// A macro begins, with these of its own.
  void enter(const Locals& locals) { locals_.push_back(locals); }
  /// It ends: what it had of its own, which is the caller's again.
  Locals leave();
  /// How many macros run.
  [[nodiscard]] std::size_t depth() const noexcept { return locals_.size() - 1; }

 private:
  [[nodiscard]] static bool is_common(int number) noexcept {
    return (number >= 100 && number < 200) || (number >= 500 && number < kFirstOfSystem);
  }

  std::vector<Locals> locals_{Locals{}};
  std::map<int, gcode::Maybe> common_;  ///< those that are known
  System system_;
};

}  // namespace rmac::fanuc
