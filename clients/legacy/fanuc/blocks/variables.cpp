#include "clients/legacy/fanuc/blocks/variables.hpp"

#include <fmt/format.h>

#include "clients/legacy/fanuc/blocks/refusal.hpp"

namespace rmac::fanuc {

namespace {

[[noreturn]] void refuse_unknown(int number, std::size_t place) {
  refuse(place,
         fmt::format("there is no #{} on all controls; there are #1 to #33, #100 to #199 and #500 to #999", number));
}

}  // namespace

Variables::Variables(const std::map<int, double>& common) {
  for (const auto& [number, value] : common) common_.emplace(number, value);
}

gcode::Maybe Variables::value(const gcode::Name& name, std::size_t place) const {
  const int number = std::get<int>(name);
  if (number <= kLocals) return locals_.back().at(static_cast<std::size_t>(number));
  if (number >= kFirstOfSystem) return system_.read(number, place);
  if (!is_common(number)) refuse_unknown(number, place);
  const auto found = common_.find(number);
  if (found == common_.end())
    refuse(place, fmt::format("#{0} was not set before, and what the machine has in it is not known; set it in the "
                              "program, or give --variable {0}=VALUE",
                              number));
  return found->second;
}

bool Variables::is_set(const gcode::Name& name) const {
  return value(name, 0).has_value();
}

void Variables::set(int number, gcode::Maybe value, std::string_view message, std::size_t place) {
  if (number == 0) refuse(place, "#0 is always vacant; nothing sets it");
  if (number <= kLocals) {
    locals_.back().at(static_cast<std::size_t>(number)) = value;
  } else if (number >= kFirstOfSystem) {
    system_.write(number, value, message, place);
  } else if (is_common(number)) {
    common_[number] = value;
  } else {
    refuse_unknown(number, place);
  }
}

Variables::Locals Variables::leave() {
  const Locals left = locals_.back();
  locals_.pop_back();
  return left;
}

}  // namespace rmac::fanuc
