#include "clients/legacy/option_values.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>

namespace rmac {

namespace {

/// The index of a work system: of G54 to G59, and of those behind them, which each language names in its own way.
std::optional<std::size_t> system_of(const std::string& name, const FurtherSystems& further) {
  constexpr std::size_t kPlain = 6;
  int number = 0;
  const auto read = [&](std::size_t begin) {
    const char* const end = name.data() + name.size();
    const auto result = std::from_chars(name.data() + begin, end, number);
    return result.ec == std::errc() && result.ptr == end;
  };
  if (name.starts_with(further.prefix)) {
    const bool is_one = read(further.prefix.size()) && number >= 1 && number <= further.most;
    return is_one ? std::optional(kPlain + static_cast<std::size_t>(number) - 1) : std::nullopt;
  }
  const bool is_plain = name.size() == 3 && name.starts_with('G') && read(1) && number >= 54 && number <= 59;
  return is_plain ? std::optional(static_cast<std::size_t>(number - 54)) : std::nullopt;
}

/// `N=VALUE`.
std::optional<std::pair<int, double>> read_numbered(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return std::nullopt;
  const char *const middle = text.data() + equals, *const end = text.data() + text.size();
  std::pair<int, double> result{};
  const auto number = std::from_chars(text.data(), middle, result.first);
  const auto value = std::from_chars(middle + 1, end, result.second, std::chars_format::fixed);
  const bool whole = number.ec == std::errc() && number.ptr == middle && value.ec == std::errc() && value.ptr == end;
  return whole ? std::optional(result) : std::nullopt;
}

}  // namespace

std::optional<legacy::Point> read_point(const std::string& text) {
  legacy::Point point{};
  const char *at = text.data(), *const end = text.data() + text.size();
  for (std::size_t axis = 0; axis < point.size(); ++axis) {
    if (axis > 0 && (at == end || *at++ != ',')) return std::nullopt;
    const auto read = std::from_chars(at, end, point.at(axis), std::chars_format::fixed);
    if (read.ec != std::errc() || !(std::abs(point.at(axis)) <= legacy::kFarthest_mm)) return std::nullopt;
    at = read.ptr;
  }
  return at == end ? std::optional(point) : std::nullopt;
}

bool read_offset(const std::string& text, const FurtherSystems& further, std::map<std::size_t, gcode::Known>& offsets) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return false;
  const auto system = system_of(text.substr(0, equals), further);
  const auto point = read_point(text.substr(equals + 1));
  if (!system || !point) return false;
  offsets[*system] = {(*point)[0], (*point)[1], (*point)[2]};
  return true;
}

bool read_variable(const std::string& text, std::map<int, double>& variables) {
  const auto read = read_numbered(text);
  if (!read) return false;
  const auto [number, value] = *read;
  const bool is_common = (number >= 100 && number < 200) || (number >= 500 && number < 1000);
  return is_common && std::isfinite(value) && variables.emplace(number, value).second;
}

bool read_m(const std::string& text, std::set<int>& codes) {
  int number = 0;
  const char* const end = text.data() + text.size();
  if (!text.starts_with('M')) return false;
  const auto read = std::from_chars(text.data() + 1, end, number);
  return read.ec == std::errc() && read.ptr == end && number >= 0 && codes.insert(number).second;
}

std::vector<gcode::RotaryAxis> read_rotary(const std::string& text) {
  std::vector<gcode::RotaryAxis> axes;
  for (std::size_t at = 0; at <= text.size(); ++at) {
    const bool turns_back = at < text.size() && text[at] == '-';
    if (turns_back) ++at;
    const char letter = at < text.size() ? text[at] : '\0';
    const bool is_new = std::ranges::find(axes, letter, &gcode::RotaryAxis::letter) == axes.end();
    if (letter < 'A' || letter > 'C' || !is_new) return {};
    axes.push_back({letter, turns_back ? -1.0 : 1.0, std::nullopt});
    if (++at < text.size() && text[at] != ',') return {};
  }
  return axes;
}

bool read_name(const std::string& text, std::map<int, std::string>& names) {
  const std::size_t equals = text.find('=');
  int number = 0;
  if (equals == std::string::npos || equals + 1 == text.size()) return false;
  const auto read = std::from_chars(text.data(), text.data() + equals, number);
  if (read.ec != std::errc() || read.ptr != text.data() + equals || number < 0) return false;
  return names.emplace(number, text.substr(equals + 1)).second;
}

bool read_diameter(const std::string& text, std::map<int, double>& diameters) {
  const auto read = read_numbered(text);
  if (!read) return false;
  const auto [tool, diameter] = *read;
  return tool >= 0 && diameter >= 0 && diameter <= 1000 && diameters.emplace(tool, diameter).second;
}

bool read_rotary_centre(const std::string& text, std::vector<gcode::RotaryAxis>& axes) {
  const bool names_one = text.size() > 1 && text[1] == '=';
  const auto point = read_point(names_one ? text.substr(2) : text);
  bool any = false;
  for (auto& axis : axes) {
    if (!point || (names_one && axis.letter != text[0])) continue;
    axis.centre_mm = point;
    any = true;
  }
  return any;
}

}  // namespace rmac
