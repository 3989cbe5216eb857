#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace rmac::gateway {

/// Which of the words that there are was likely meant by a mistyped one; none: it is like none of them.
[[nodiscard]] std::optional<std::size_t> likely_meant(std::span<const std::string> known, std::string_view mistyped);

/// Says in words what a JSON schema allows. Knows the part of draft 7 that the schemas of etc/ use: objects, arrays,
/// and references to `definitions`.
class SchemaWords {
 public:
  explicit SchemaWords(const nlohmann::json& schema) : root_(schema) {}

  /// The schema of the value that `steps` lead to; an empty one where the schema says nothing.
  [[nodiscard]] const nlohmann::json& at(const std::vector<std::string>& steps) const;
  [[nodiscard]] const nlohmann::json& property(const nlohmann::json& object_schema, const std::string& key) const;

  /// "a number above 0, at most 1000 (mm/s)"
  [[nodiscard]] std::string allowed(const nlohmann::json& schema) const;
  /// Which keys an object may have, the likeliest one for a mistyped `key` first.
  [[nodiscard]] std::string known_keys(const nlohmann::json& object_schema, std::string_view key) const;
  /// A value as a message shows it: short ones whole, others by their size.
  [[nodiscard]] static std::string shown(const nlohmann::json& value);

 private:
  [[nodiscard]] const nlohmann::json& resolved(const nlohmann::json& schema) const;

  const nlohmann::json& root_;
};

}  // namespace rmac::gateway
