#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace rmac::gateway {

/// A compiled JSON schema (draft 7). Its errors are made for people: beside the pointer they name the value and what
/// the schema allows there, read from the schema itself (`x-form` says a pattern in words, `x-unit` gives the unit).
class JsonSchema {
 public:
  /// `text` is one of the schemas compiled in; a mistake in it is the programmer's and throws.
  explicit JsonSchema(std::string_view text);
  ~JsonSchema();
  JsonSchema(const JsonSchema&) = delete;
  JsonSchema& operator=(const JsonSchema&) = delete;

  /// Empty when the document is as the schema wants it, otherwise what is wrong in it, one clause a mistake.
  [[nodiscard]] std::string check(const nlohmann::json& document) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rmac::gateway
