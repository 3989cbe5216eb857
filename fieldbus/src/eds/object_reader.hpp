#pragma once

#include <set>

#include "eds/ini.hpp"
#include "rmac/fieldbus/eds/device_description.hpp"

namespace rmac::fieldbus::eds {

/// The index that a section [6040] is about; nothing for any other section. `key` is its name in lower case.
[[nodiscard]] std::optional<std::uint16_t> object_of_section(const std::string& key);

/// Reads the sections of one object after the other into entries (CiA 306-1, 4.6): [1018], [1018sub1], and the compact
/// writing of arrays, [1003Value] and [1003Name].
class ObjectReader {
 public:
  ObjectReader(const IniDocument& document, const std::string& file, std::map<ObjectAddress, ObjectEntry>& entries)
      : document_(document), file_(file), entries_(entries) {}

  [[nodiscard]] Expected<> read(std::uint16_t index, const IniSection& section);
  /// Once all are read: no [1018sub1] without an object that has it.
  [[nodiscard]] Expected<> check_strays() const;

 private:
  [[nodiscard]] Expected<ObjectEntry> entry(const IniSection& section, bool is_domain) const;
  [[nodiscard]] Expected<> value(const IniSection& section, const char* name, const ObjectEntry& entry,
                                 std::optional<Value>& into) const;
  [[nodiscard]] Expected<> read_subs(std::uint16_t index, const IniSection& section);
  [[nodiscard]] Expected<> read_compact(std::uint16_t index, const IniSection& section, std::uint64_t count);
  [[nodiscard]] Expected<> read_compact_values(std::uint16_t index, const std::string& key);

  const IniDocument& document_;
  const std::string& file_;
  std::map<ObjectAddress, ObjectEntry>& entries_;
  std::set<std::string> used_;  ///< sections of sub-indices
};

}  // namespace rmac::fieldbus::eds
