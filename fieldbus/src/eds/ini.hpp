#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "rmac/motion/error.hpp"

namespace rmac::fieldbus::eds {

struct IniValue {
  std::string text;
  std::size_t line = 0;
};

struct IniSection {
  std::string name;  ///< as written
  std::size_t line = 0;
  std::map<std::string, IniValue> values;  ///< by their names in lower case

  /// Null when it is absent or empty: CiA 306 takes both alike.
  [[nodiscard]] const IniValue* find(const std::string& name) const;
};

/// Sections by their names in lower case.
using IniDocument = std::map<std::string, IniSection>;

/// The layer below EDS files (CiA 306-1, 4.2): sections, keys in any case, comments behind a semicolon at the start of
/// a line. An error names the line. Why no library does this: docs/decisions/0007-ini-reader.md.
[[nodiscard]] Expected<IniDocument> parse_ini(std::string_view text, const std::string& file);

[[nodiscard]] std::string lower_case(std::string_view text);

/// An error at a line of a file.
[[nodiscard]] tl::unexpected<Error> mistake(const std::string& file, std::size_t line, const std::string& what);

}  // namespace rmac::fieldbus::eds
