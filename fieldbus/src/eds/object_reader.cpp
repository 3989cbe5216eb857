#include "eds/object_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "eds/value.hpp"

namespace rmac::fieldbus::eds {
namespace {

// ObjectType (CiA 301, 7.4.3, table 42)
constexpr std::uint64_t kDomain = 2;
constexpr std::uint64_t kVariable = 7;
constexpr std::uint64_t kArray = 8;
constexpr std::uint64_t kRecord = 9;
constexpr std::uint64_t kMostSubs = 254;  // FFh describes the structure

std::optional<std::uint64_t> hexadecimal(std::string_view digits, std::size_t most_digits) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
  const bool whole = error == std::errc() && end == digits.data() + digits.size();
  return whole && digits.size() <= most_digits && !digits.empty() ? std::optional(number) : std::nullopt;
}

std::optional<Access> access_of(const std::string& word) {
  if (word == "ro") return Access::ReadOnly;
  if (word == "wo") return Access::WriteOnly;
  if (word == "rw") return Access::ReadWrite;
  if (word == "rwr") return Access::ReadWriteInput;
  if (word == "rww") return Access::ReadWriteOutput;
  if (word == "const") return Access::Constant;
  return {};
}

}  // namespace

std::optional<std::uint16_t> object_of_section(const std::string& key) {
  const auto index = hexadecimal(key, 4);
  return index ? std::optional(static_cast<std::uint16_t>(*index)) : std::nullopt;
}

Expected<> ObjectReader::value(const IniSection& section, const char* name, const ObjectEntry& of,
                               std::optional<Value>& into) const {
  const IniValue* written = section.find(name);
  if (written == nullptr) return {};
  into = read_value(written->text, of.type);
  if (into) return {};
  return mistake(
      file_, written->line,
      fmt::format("\"{}\" is no value of data type 0x{:04X}{}", written->text, static_cast<unsigned>(of.type),
                  bits_of(of.type) != 0 ? fmt::format(", {} bits", bits_of(of.type)) : ""));
}

Expected<ObjectEntry> ObjectReader::entry(const IniSection& section, bool is_domain) const {
  ObjectEntry read;
  read.line = section.line;
  if (const IniValue* name = section.find("parametername")) read.name = name->text;
  if (is_domain) read.type = DataType::Domain;
  if (const IniValue* type = section.find("datatype")) {
    const auto number = read_count(type->text, 0xFFFF);
    if (!number || *number == 0) {
      return mistake(file_, type->line, fmt::format("DataType is \"{}\"; it is an index from 1 to 0xFFFF", type->text));
    }
    read.type = static_cast<DataType>(*number);
  } else if (!is_domain) {
    return mistake(file_, section.line, fmt::format("[{}] has no DataType", section.name));
  }
  if (const IniValue* access = section.find("accesstype")) {
    const auto known = access_of(lower_case(access->text));
    if (!known) {
      return mistake(file_, access->line,
                     fmt::format("AccessType is \"{}\"; allowed are ro, wo, rw, rwr, rww and const", access->text));
    }
    read.access = *known;
  } else if (!is_domain) {
    return mistake(file_, section.line, fmt::format("[{}] has no AccessType", section.name));
  }
  if (const IniValue* mapping = section.find("pdomapping")) {
    const auto flag = read_count(mapping->text, 1);
    if (!flag) return mistake(file_, mapping->line, fmt::format("PDOMapping is \"{}\"; it is 0 or 1", mapping->text));
    read.mappable = *flag == 1;
  }
  if (auto done = value(section, "lowlimit", read, read.least); !done) return tl::unexpected(done.error());
  if (auto done = value(section, "highlimit", read, read.most); !done) return tl::unexpected(done.error());
  if (auto done = value(section, "defaultvalue", read, read.initial); !done) return tl::unexpected(done.error());
  if (auto done = value(section, "parametervalue", read, read.configured); !done) return tl::unexpected(done.error());
  return read;
}

Expected<> ObjectReader::read(std::uint16_t index, const IniSection& section) {
  std::uint64_t kind = kVariable;
  if (const IniValue* type = section.find("objecttype")) {
    const auto number = read_count(type->text, 0xFF);
    if (!number) {
      return mistake(file_, type->line, fmt::format("ObjectType is \"{}\"; it is a number up to 0xFF", type->text));
    }
    kind = *number;
  }
  if (kind == kArray || kind == kRecord) return read_subs(index, section);
  if (kind != kVariable && kind != kDomain) return {};  // types, which describe and hold nothing
  auto made = entry(section, kind == kDomain);
  if (!made) return tl::unexpected(made.error());
  entries_[{index, 0}] = std::move(*made);
  return {};
}

Expected<> ObjectReader::read_subs(std::uint16_t index, const IniSection& section) {
  if (const IniValue* compact = section.find("compactsubobj")) {
    const auto count = read_count(compact->text, kMostSubs);
    if (!count) {
      return mistake(file_, compact->line,
                     fmt::format("CompactSubObj is \"{}\"; it is a number up to {}", compact->text, kMostSubs));
    }
    if (*count != 0) return read_compact(index, section, *count);
  }
  std::uint64_t found = 0;
  const std::string key = lower_case(section.name);
  for (unsigned sub = 0; sub <= 0xFF; ++sub) {
    for (const std::string& name : {fmt::format("{}sub{:x}", key, sub), fmt::format("{}sub{:02x}", key, sub)}) {
      const auto at = document_.find(name);
      if (at == document_.end() || !used_.insert(name).second) continue;
      const IniValue* type = at->second.find("objecttype");
      const bool is_domain = type != nullptr && read_count(type->text, 0xFF) == kDomain;
      auto made = entry(at->second, is_domain);
      if (!made) return tl::unexpected(made.error());
      const ObjectAddress address{index, static_cast<std::uint8_t>(sub)};
      if (!entries_.emplace(address, std::move(*made)).second) {
        return mistake(file_, at->second.line, fmt::format("{} stands here twice", to_string(address)));
      }
      ++found;
    }
  }
  const IniValue* announced = section.find("subnumber");
  const auto count = announced != nullptr ? read_count(announced->text, 0xFF) : std::nullopt;
  if (!count) {
    return mistake(file_, announced != nullptr ? announced->line : section.line,
                   fmt::format("[{}] needs SubNumber, how many sub-indices it has", section.name));
  }
  if (*count != found) {
    return mistake(file_, announced->line,
                   fmt::format("[{}] announces {} sub-indices, and {} have a section", section.name, *count, found));
  }
  return {};
}

Expected<> ObjectReader::read_compact(std::uint16_t index, const IniSection& section, std::uint64_t count) {
  auto each = entry(section, false);
  if (!each) return tl::unexpected(each.error());
  ObjectEntry number;
  number.name = "NrOfObjects";
  number.type = DataType::Unsigned8;
  number.access = Access::ReadOnly;
  number.line = section.line;
  number.initial = Value{{static_cast<std::uint8_t>(count)}};
  entries_[{index, 0}] = number;
  const std::string name = each->name;
  for (std::uint64_t sub = 1; sub <= count; ++sub) {
    each->name = fmt::format("{}{}", name, sub);
    entries_[{index, static_cast<std::uint8_t>(sub)}] = *each;
  }
  return read_compact_values(index, lower_case(section.name));
}

/// The values of a DCF for an array in the compact writing: [1003Value] with 1=…, 2=….
Expected<> ObjectReader::read_compact_values(std::uint16_t index, const std::string& key) {
  const auto values = document_.find(key + "value");
  if (values == document_.end()) return {};
  for (const auto& [name, written] : values->second.values) {
    if (name == "nrofentries" || written.text.empty()) continue;
    const auto sub = read_count(name, kMostSubs);
    const auto at = sub ? entries_.find({index, static_cast<std::uint8_t>(*sub)}) : entries_.end();
    if (at == entries_.end()) {
      return mistake(file_, written.line, fmt::format("{:04X}h has no sub-index \"{}\"", index, name));
    }
    at->second.configured = read_value(written.text, at->second.type);
    if (!at->second.configured) {
      return mistake(file_, written.line,
                     fmt::format("\"{}\" is no value of data type 0x{:04X}", written.text,
                                 static_cast<unsigned>(at->second.type)));
    }
  }
  return {};
}

Expected<> ObjectReader::check_strays() const {
  for (const auto& [key, section] : document_) {
    const std::size_t at = key.find("sub");
    if (at == std::string::npos || !hexadecimal(key.substr(0, at), 4) || !hexadecimal(key.substr(at + 3), 2)) continue;
    if (used_.contains(key)) continue;
    return mistake(file_, section.line,
                   fmt::format("[{}] belongs to no array or record; [{}] is missing or none", section.name,
                               section.name.substr(0, at)));
  }
  return {};
}

}  // namespace rmac::fieldbus::eds
