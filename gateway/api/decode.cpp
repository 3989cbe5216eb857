#include "gateway/api/decode.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace rmac::gateway {

namespace {

using nlohmann::json;

constexpr double kLargestInteger = 9007199254740991.0;  // 2^53 - 1: what every JSON reader holds exactly

std::string with_range(const char* what, const ParameterSpec& spec) {
  const std::string range = spec.range.text();
  std::string text = what;
  if (!range.empty()) text += " " + range;
  if (!spec.unit.empty()) text += " " + spec.unit;
  return text;
}

}  // namespace

std::string shortened(const json& value) {
  // Long containers are told by their size: dumping 8 MiB to show 80 characters of it would be a gift to an attacker.
  if (value.is_array() && value.size() > 16) return fmt::format("an array of {} values", value.size());
  if (value.is_object() && value.size() > 16) return fmt::format("an object of {} members", value.size());
  if (value.is_string() && value.get_ref<const std::string&>().size() > 80) {
    return fmt::format("a text of {} bytes", value.get_ref<const std::string&>().size());
  }
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  if (text.size() > 80) text = text.substr(0, 77) + "...";
  return text;
}

void decode_into(const json& value, const ParameterSpec& /*spec*/, Decoded<bool>& out) {
  if (!value.is_boolean()) {
    out = mismatch(value, "true or false");
    return;
  }
  out = value.get<bool>();
}

void decode_into(const json& value, const ParameterSpec& spec, Decoded<std::int64_t>& out) {
  if (spec.enumeration != nullptr) {
    const Enumeration::Value* found = nullptr;
    if (value.is_string()) found = spec.enumeration->find(value.get_ref<const std::string&>());
    if (value.is_number_integer()) found = spec.enumeration->find(value.get<std::int64_t>());
    if (found == nullptr) {
      out = mismatch(value, "one of " + spec.enumeration->list());
    } else {
      out = found->number;
    }
    return;
  }
  // 3.0 is an integer to JSON; beyond 2^53 neighbouring integers can no longer be told apart by most clients.
  const double number = value.is_number() ? value.get<double>() : 0.5;
  if (std::trunc(number) != number || std::abs(number) > kLargestInteger || !spec.range.contains(number)) {
    out = mismatch(value, with_range("an integer", spec));
    return;
  }
  out = static_cast<std::int64_t>(number);
}

void decode_into(const json& value, const ParameterSpec& spec, Decoded<double>& out) {
  if (!value.is_number() || !std::isfinite(value.get<double>()) || !spec.range.contains(value.get<double>())) {
    out = mismatch(value, with_range("a number", spec));
    return;
  }
  out = value.get<double>();
}

void decode_into(const json& value, const ParameterSpec& /*spec*/, Decoded<std::string>& out) {
  if (!value.is_string()) {
    out = mismatch(value, "a text");
    return;
  }
  out = value.get<std::string>();
}

void decode_into(const json& value, const ParameterSpec& spec, Decoded<std::vector<double>>& out) {
  if (!value.is_array()) {
    out = mismatch(value, "an array of numbers");
    return;
  }
  std::vector<double> numbers;
  numbers.reserve(value.size());
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (!value[i].is_number() || !spec.range.contains(value[i].get<double>())) {
      out = mismatch(value[i], with_range("a number", spec), fmt::format("[{}]", i));
      return;
    }
    numbers.push_back(value[i].get<double>());
  }
  out = std::move(numbers);
}

void decode_into(const json& value, const ParameterSpec& /*spec*/, Decoded<std::vector<std::string>>& out) {
  if (!value.is_array()) {
    out = mismatch(value, "an array of texts");
    return;
  }
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (!value[i].is_string()) {
      out = mismatch(value[i], "a text", fmt::format("[{}]", i));
      return;
    }
    texts.push_back(value[i].get<std::string>());
  }
  out = std::move(texts);
}

void decode_into(const json& value, const ParameterSpec& spec, Decoded<JsonValue>& out) {
  if (spec.type == WireType::Object ? value.is_object() : value.is_array()) {
    out = JsonValue{value};
  } else {
    out = mismatch(value, spec.type == WireType::Object ? "an object" : "an array of objects");
  }
}

void decode_into(const json& value, const ParameterSpec& /*spec*/, Decoded<Mask>& out) {
  constexpr const char* kExpected = "an integer from 0 to 2^53-1 or a text \"0x...\" of up to 16 hexadecimal digits";
  if (value.is_number_unsigned() && value.get<std::uint64_t>() <= static_cast<std::uint64_t>(kLargestInteger)) {
    out = Mask{value.get<std::uint64_t>()};
    return;
  }
  if (value.is_string()) {
    const std::string& text = value.get_ref<const std::string&>();
    std::uint64_t bits = 0;
    if (text.size() > 2 && text.size() <= 18 && text.starts_with("0x")) {
      const auto [end, problem] = std::from_chars(text.data() + 2, text.data() + text.size(), bits, 16);
      if (problem == std::errc{} && end == text.data() + text.size()) {
        out = Mask{bits};
        return;
      }
    }
  }
  out = mismatch(value, kExpected);
}

}  // namespace rmac::gateway
