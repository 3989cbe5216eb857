#include "gateway/json/printable.hpp"

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>

namespace rmac::gateway {
namespace {

struct Character {
  std::size_t bytes = 1;
  bool shown = false;
};

/// The character at the begin of a text; one byte that is not shown where there is none.
Character first_of(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  if (byte(0) < 0x80) return {1, byte(0) >= 0x20 && byte(0) != 0x7f};
  struct Form {
    std::uint8_t mask, lead;
    std::size_t bytes;
    std::uint32_t least;  // what is smaller has a shorter form, which counts alone
  };
  constexpr std::array<Form, 3> kForms{{{0xe0, 0xc0, 2, 0x80}, {0xf0, 0xe0, 3, 0x800}, {0xf8, 0xf0, 4, 0x10000}}};
  for (const Form& form : kForms) {
    if ((byte(0) & form.mask) != form.lead) continue;
    if (text.size() < form.bytes) return {};
    std::uint32_t code = byte(0) & static_cast<std::uint8_t>(~form.mask);
    for (std::size_t i = 1; i < form.bytes; ++i) {
      if ((byte(i) & 0xc0) != 0x80) return {};
      code = code << 6 | (byte(i) & 0x3f);
    }
    if (code < form.least || code > 0x10ffff || (code >= 0xd800 && code <= 0xdfff)) return {};
    return {form.bytes, code >= 0xa0};
  }
  return {};
}

}  // namespace

std::string printable(std::string_view text, std::size_t longest) {
  std::string line;
  while (!text.empty()) {
    const Character next = first_of(text);
    const std::string_view shown = next.shown ? text.substr(0, next.bytes) : "?";
    if (line.size() + shown.size() > longest) break;
    line += shown;
    text.remove_prefix(next.bytes);
  }
  return line;
}

std::string text_of(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace rmac::gateway
