#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace rmac::gateway {

// Members of an object that a schema has passed: what is there has its type.

[[nodiscard]] inline std::string text(const nlohmann::json& object, const char* key) {
  return object.value(key, std::string());
}
[[nodiscard]] inline double number(const nlohmann::json& object, const char* key, double otherwise = 0) {
  return object.value(key, otherwise);
}

}  // namespace rmac::gateway
