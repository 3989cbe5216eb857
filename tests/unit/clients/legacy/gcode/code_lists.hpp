#pragma once

#include <string>

// Codes as manuals list them: "0 1 5.1" of those that a language has and that are what a test asks for.

namespace rmac::gcode {

/// Of the numbers that `find` knows, by tens, those that `is` takes.
template <typename Find, typename Is>
std::string g_codes(const Find& find, const Is& is) {
  std::string list;
  for (int tenfold = -20; tenfold <= 10'010; ++tenfold) {
    const auto* code = find(tenfold);
    if (code == nullptr || !is(*code)) continue;
    if (!list.empty()) list += ' ';
    list += std::to_string(tenfold / 10) + (tenfold % 10 == 0 ? "" : "." + std::to_string(tenfold % 10));
  }
  return list;
}

template <typename Find, typename Is>
std::string m_codes(const Find& find, const Is& is) {
  return g_codes([&find](int tenfold) { return tenfold % 10 == 0 ? find(tenfold / 10) : nullptr; }, is);
}

/// Of one modal group.
inline auto of_group(auto group) {
  return [group](const auto& code) { return code.group == group; };
}

constexpr auto kIsRefused = [](const auto& code) { return !code.refusal.empty(); };

}  // namespace rmac::gcode
