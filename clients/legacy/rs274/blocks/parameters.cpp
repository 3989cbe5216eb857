#include "clients/legacy/rs274/blocks/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "clients/legacy/gcode/blocks/codes.hpp"
#include "clients/legacy/rs274/blocks/refusal.hpp"

namespace rmac::rs274 {

gcode::Maybe Parameters::value(const gcode::Name& name, std::size_t place) const {
  if (const auto* text = std::get_if<std::string_view>(&name)) {
    if (const auto found = read(*text)) return found;
    if (control_name(*text))
      refuse(place, fmt::format("#<{}> is the control's own, and not known here; write the value instead", *text));
    refuse(place, fmt::format("#<{}> was not set before; set it in the program", *text));
  }
  const int number = std::get<int>(name);
  if (const auto found = read(number)) return found;
  constexpr int kLastOfProbe = 5070;
  if (number >= kFirstOfControl && number <= kLastOfProbe)
    refuse(place, fmt::format("#{} is what the last G38 found: {}", number, gcode::kProbing));
  if (number >= kFirstOfControl) {
    refuse(place, fmt::format("#{} is the control's own, and not known here; write the value instead", number));
  }
  refuse(place, fmt::format("#{} was not set before, and what a machine has in it is not known; set it in the program",
                            number));
}

bool Parameters::is_set(const gcode::Name& name) const {
  return std::visit([this](const auto& which) { return read(which).has_value(); }, name);
}

std::optional<double> Parameters::read(int number) const {
  if (number >= kFirstOfControl) return of_control_ ? of_control_(number) : std::nullopt;
  return values_.at(static_cast<std::size_t>(number));
}

std::optional<double> Parameters::read(std::string_view name) const {
  if (control_name(name)) return of_control_ ? of_control_(name) : std::nullopt;
  const Names& all = is_global(name) ? global_ : names();
  const auto found = all.find(name);
  return found == all.end() ? std::nullopt : std::optional(found->second);
}

void Parameters::set(int number, double value) {
  values_.at(static_cast<std::size_t>(number)) = value;
}

void Parameters::set(std::string_view name, double value) {
  Names& all = is_global(name) ? global_ : within_.empty() ? program_ : within_.back().names;
  all.insert_or_assign(std::string(name), value);
}

void Parameters::enter(const std::optional<Arguments>& arguments) {
  Subprogram& entered = within_.emplace_back();
  if (!arguments) return;
  auto* const first = values_.begin() + 1;
  entered.of_caller.emplace();
  std::copy_n(first, kArguments, entered.of_caller->begin());
  std::ranges::copy(*arguments, first);
}

void Parameters::leave() {
  if (const auto& kept = within_.back().of_caller) std::ranges::copy(*kept, values_.begin() + 1);
  within_.pop_back();
}

void Parameters::returned(std::optional<double> value) {
  global_.insert_or_assign(std::string(kValue), value.value_or(0));
  global_.insert_or_assign(std::string(kReturned), value ? 1 : 0);
}

}  // namespace rmac::rs274
