#include "clients/legacy/rs274/blocks/parameters.hpp"

namespace rmac::rs274 {

std::optional<double> Parameters::read(int number) const {
  if (number >= kFirstOfControl) return of_control_ ? of_control_(number) : std::nullopt;
  return values_.at(static_cast<std::size_t>(number));
}

std::optional<double> Parameters::read(std::string_view name) const {
  const auto found = named_.find(name);
  return found == named_.end() ? std::nullopt : std::optional(found->second);
}

void Parameters::set(int number, double value) {
  values_.at(static_cast<std::size_t>(number)) = value;
}

void Parameters::set(std::string_view name, double value) {
  named_.insert_or_assign(std::string(name), value);
}

}  // namespace rmac::rs274
