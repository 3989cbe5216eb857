#include "gateway/json/range.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "gateway/json/schemas.hpp"

namespace rmac::gateway {

std::string Range::text() const {
  const bool below = std::isfinite(min);
  const bool above = std::isfinite(max);
  if (below && above) return fmt::format("{}{} to {}", min_excluded ? "more than " : "", min, max);
  if (below) return fmt::format("{} {}", min_excluded ? "more than" : "at least", min);
  if (above) return fmt::format("at most {}", max);
  return {};
}

Range device_range(std::string_view key) {
  using nlohmann::json;
  static const json kSchema = json::parse(device_schema_text());
  const std::size_t slash = key.find('/');
  const json& properties = slash == std::string_view::npos
                               ? kSchema.at("properties")
                               : kSchema.at("definitions").at(std::string(key.substr(0, slash))).at("properties");
  const json& property = properties.at(std::string(slash == std::string_view::npos ? key : key.substr(slash + 1)));
  const json& number = property.contains("items") ? property.at("items") : property;
  return {number.at("minimum"), number.at("maximum"), false};
}

Expected<> check_device_range(std::string_view key, double value, const std::string& what) {
  const Range range = device_range(key);
  if (range.contains(value)) return {};
  return failure(MinorCode::InvalidParameterValue,
                 fmt::format("{} is {}; allowed is a number from {} to {}", what, value, range.min, range.max));
}

}  // namespace rmac::gateway
