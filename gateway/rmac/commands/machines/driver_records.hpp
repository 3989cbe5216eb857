#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// A characteristic of a machine, as the database of device drivers has it.
struct Column {
  const char* function;  ///< Appendix II, without the interface
  const char* key;       ///< in JSON, and the database's column where there is one
  const char* title;     ///< in `rmac show`
  const char* unit;
};
[[nodiscard]] std::span<const Column> columns();

/// Asks a list of functions of one interface in one go, and puts the answers under their columns' keys.
[[nodiscard]] Result<nlohmann::json> ask(Connection& connection, const std::string& interface,
                                         std::span<const Column> columns, const nlohmann::json& params);

/// The machines that a SELECT over the table DeviceDrivers finds: an array of objects with the keys of the columns.
[[nodiscard]] Result<nlohmann::json> select(Connection& connection, const std::string& sql);
/// A text as SQL writes it.
[[nodiscard]] std::string quoted(const std::string& text);

/// A value of a column as a person reads it.
[[nodiscard]] std::string text_of(const nlohmann::json& value);

}  // namespace rmac::cli
