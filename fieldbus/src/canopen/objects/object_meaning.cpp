#include "rmac/fieldbus/canopen/object_meaning.hpp"

#include <fmt/format.h>

#include <charconv>

#include "canopen/objects/standard_objects.hpp"
#include "rmac/fieldbus/canopen/emergency.hpp"
#include "rmac/motion/drive_power.hpp"

namespace rmac::fieldbus::canopen {
namespace {

/// "0x6041", "6041h" or "6041", whole and in hexadecimal.
template <typename Number>
bool read_hexadecimal(std::string_view text, Number& number) {
  if (text.starts_with("0x") || text.starts_with("0X")) {
    text.remove_prefix(2);
  } else if (text.ends_with('h') || text.ends_with('H')) {
    text.remove_suffix(1);
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, 16);
  return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

/// What a number stands for; empty: itself.
std::string stands_for(ObjectAddress object, const eds::TypedValue& value) {
  const auto* const word = std::get_if<std::uint64_t>(&value);
  const auto* const number = std::get_if<std::int64_t>(&value);
  const std::uint16_t index = of_first_axis(object).index;
  if (object.sub != 0) return {};
  if (index == 0x6041 && word != nullptr) return drive_state_text(static_cast<std::uint16_t>(*word));
  if (index == 0x603F && word != nullptr) return emergency_text(static_cast<std::uint16_t>(*word));
  if ((index == 0x6060 || index == 0x6061) && number != nullptr) return mode_name(*number);
  return {};
}

}  // namespace

ObjectMeaning meaning_of(ObjectAddress object, const eds::DeviceDescription* description) {
  ObjectMeaning meaning;
  if (const StandardObject* known = find_standard_object(object)) {
    meaning = {known->name, known->type, known->unit, known->is_pattern};
  }
  if (const eds::ObjectEntry* entry = description != nullptr ? description->find(object) : nullptr) {
    if (!entry->name.empty()) meaning.name = entry->name;
    meaning.type = entry->type;
  }
  return meaning;
}

eds::TypedValue value_of(const ObjectMeaning& meaning, std::span<const std::uint8_t> bytes) {
  return meaning.type ? eds::value_of(bytes, *meaning.type) : eds::value_of(bytes);
}

std::string value_text(ObjectAddress object, const ObjectMeaning& meaning, std::span<const std::uint8_t> bytes) {
  const eds::TypedValue value = value_of(meaning, bytes);
  std::string text = eds::to_text(value);
  if (const auto* word = std::get_if<std::uint64_t>(&value); meaning.is_pattern && word != nullptr) {
    text = fmt::format("{:0{}X}h", *word, 2 * bytes.size());
  }
  if (!meaning.unit.empty() && !std::holds_alternative<std::string>(value)) text += " " + meaning.unit;
  const std::string meant = stands_for(object, value);
  return meant.empty() ? text : fmt::format("{} ({})", text, meant);
}

std::string object_text(ObjectAddress object, const ObjectMeaning& meaning) {
  return meaning.name.empty() ? to_string(object) : fmt::format("{} {}", to_string(object), meaning.name);
}

Expected<ObjectAddress> read_object_address(std::string_view text) {
  ObjectAddress object;
  const std::size_t colon = text.find(':');
  const bool has_sub = colon != std::string_view::npos;
  if (read_hexadecimal(text.substr(0, colon), object.index) &&
      (!has_sub || read_hexadecimal(text.substr(colon + 1), object.sub))) {
    return object;
  }
  return failure(MinorCode::InvalidParameterValue,
                 fmt::format("\"{}\" is no object; write index:sub in hexadecimal, for example 6041:00", text));
}

}  // namespace rmac::fieldbus::canopen
