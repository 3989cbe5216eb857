#include "rmac/fieldbus/eds/device_description.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <iterator>

#include "eds/compact_pdo.hpp"
#include "eds/ini.hpp"
#include "eds/object_reader.hpp"
#include "eds/value.hpp"

namespace rmac::fieldbus::eds {
namespace {

// A sheet of a large servo drive has about 1 MB.
constexpr std::uintmax_t kMostBytes = 16U << 20U;

constexpr std::array kObjectLists{"mandatoryobjects", "optionalobjects", "manufacturerobjects"};

class Reader {
 public:
  Reader(const IniDocument& document, const std::string& file) : document_(document), file_(file) {
    description_.file = file;
  }

  Expected<DeviceDescription> read() {
    for (const auto part :
         {&Reader::read_device, &Reader::read_commissioning, &Reader::read_lists, &Reader::read_objects,
          &Reader::check_lists, &Reader::read_dummies, &Reader::read_compact_pdos}) {
      if (auto done = (this->*part)(); !done) return tl::unexpected(done.error());
    }
    return std::move(description_);
  }

 private:
  /// A number that may be absent; `into` stays as it is then.
  template <typename Number>
  Expected<> number(const IniSection& section, const char* name, std::uint64_t most, Number& into) const {
    const IniValue* value = section.find(name);
    if (value == nullptr) return {};
    const auto read = read_count(value->text, most);
    if (!read) {
      return mistake(file_, value->line, fmt::format("\"{}\" is no whole number from 0 to {}", value->text, most));
    }
    into = static_cast<Number>(*read);
    return {};
  }

  Expected<> read_device() {
    const auto found = document_.find("deviceinfo");
    if (found == document_.end()) {
      return mistake(file_, 1, "there is no section [DeviceInfo]; this is no EDS or DCF file");
    }
    const IniSection& device = found->second;
    if (const IniValue* name = device.find("vendorname")) description_.vendor_name = name->text;
    if (const IniValue* name = device.find("productname")) description_.product_name = name->text;
    constexpr std::uint64_t kMost = 0xFFFFFFFF;
    if (auto read = number(device, "vendornumber", kMost, description_.vendor_number); !read) return read;
    if (auto read = number(device, "productnumber", kMost, description_.product_number); !read) return read;
    for (const std::uint32_t kilobits : {10U, 20U, 50U, 125U, 250U, 500U, 800U, 1000U}) {
      unsigned knows = 0;
      if (auto read = number(device, fmt::format("baudrate_{}", kilobits).c_str(), 1, knows); !read) return read;
      if (knows != 0) description_.bit_rates.insert(kilobits * 1000);
    }
    return {};
  }

  /// The standard itself spells the section's name with one m.
  Expected<> read_commissioning() {
    for (const char* name : {"devicecomissioning", "devicecommissioning"}) {
      const auto found = document_.find(name);
      if (found == document_.end()) continue;
      unsigned node = 0;
      unsigned kilobits = 0;
      constexpr unsigned kMostNodes = 127;
      if (auto read = number(found->second, "nodeid", kMostNodes, node); !read) return read;
      if (auto read = number(found->second, "baudrate", 1000, kilobits); !read) return read;
      if (node != 0) description_.node = static_cast<std::uint8_t>(node);
      if (kilobits != 0) description_.bit_rate = kilobits * 1000;
    }
    return {};
  }

  Expected<> read_lists() {
    for (const char* name : kObjectLists) {
      const auto found = document_.find(name);
      if (found == document_.end()) continue;
      const IniSection& list = found->second;
      unsigned count = 0;
      if (auto read = number(list, "supportedobjects", 0xFFFF, count); !read) return read;
      for (unsigned i = 1; i <= count; ++i) {
        const IniValue* value = list.find(std::to_string(i));
        const auto index = value != nullptr ? read_count(value->text, 0xFFFF) : std::nullopt;
        if (!index) {
          return mistake(file_, value != nullptr ? value->line : list.line,
                         fmt::format("[{}] announces {} objects, and its number {} is {}", list.name, count, i,
                                     value != nullptr ? "no index from 0 to 0xFFFF" : "missing"));
        }
        listed_.try_emplace(static_cast<std::uint16_t>(*index), value->line);
      }
    }
    return {};
  }

  Expected<> read_objects() {
    ObjectReader objects(document_, file_, description_.entries);
    for (const auto& [key, section] : document_) {
      const auto index = object_of_section(key);
      if (!index) continue;
      if (!listed_.contains(*index)) {
        return mistake(file_, section.line,
                       fmt::format("[{}] stands in none of [MandatoryObjects], [OptionalObjects] and "
                                   "[ManufacturerObjects]; add it where it belongs",
                                   section.name));
      }
      if (auto read = objects.read(*index, section); !read) return read;
    }
    return objects.check_strays();
  }

  Expected<> check_lists() {
    for (const auto& [index, line] : listed_) {
      if (!document_.contains(fmt::format("{:x}", index)) && !document_.contains(fmt::format("{:04x}", index))) {
        return mistake(file_, line, fmt::format("the object is listed, and there is no section [{:04X}]", index));
      }
    }
    return {};
  }

  /// [DummyUsage]: which data types can fill room in an RPDO.
  Expected<> read_dummies() {
    const auto found = document_.find("dummyusage");
    if (found == document_.end()) return {};
    for (const DataType type : {DataType::Integer8, DataType::Integer16, DataType::Integer32, DataType::Unsigned8,
                                DataType::Unsigned16, DataType::Unsigned32}) {
      const std::string name = fmt::format("Dummy{:04X}", static_cast<unsigned>(type));
      ObjectEntry dummy;
      dummy.name = name;
      dummy.type = type;
      if (auto read = number(found->second, lower_case(name).c_str(), 1, dummy.mappable); !read) return read;
      const IniValue* value = found->second.find(lower_case(name));
      dummy.line = value != nullptr ? value->line : found->second.line;
      description_.dummies[static_cast<std::uint16_t>(type)] = std::move(dummy);
    }
    return {};
  }

  Expected<> read_compact_pdos() {
    const IniSection& device = document_.find("deviceinfo")->second;
    CompactPdos pdos;
    if (auto read = number(device, "compactpdo", 0xFF, pdos.subs); !read || pdos.subs == 0) return read;
    if (auto read = number(device, "nrofrxpdo", kMostPdos, pdos.rpdos); !read) return read;
    if (auto read = number(device, "nroftxpdo", kMostPdos, pdos.tpdos); !read) return read;
    pdos.line = device.find("compactpdo")->line;
    add_compact_pdos(pdos, description_.entries);
    return {};
  }

  const IniDocument& document_;
  const std::string& file_;
  DeviceDescription description_;
  std::map<std::uint16_t, std::size_t> listed_;  ///< with the line
};

}  // namespace

const ObjectEntry* DeviceDescription::find(ObjectAddress address) const {
  const auto found = entries.find(address);
  return found == entries.end() ? nullptr : &found->second;
}

bool DeviceDescription::has(std::uint16_t index) const {
  const auto first = entries.lower_bound({index, 0});
  return first != entries.end() && first->first.index == index;
}

std::string DeviceDescription::place_of(const ObjectEntry& entry) const {
  return fmt::format("{}:{}", file, entry.line);
}

Expected<DeviceDescription> parse_device_description(std::string_view text, const std::string& file) {
  const auto document = parse_ini(text, file);
  if (!document) return tl::unexpected(document.error());
  return Reader(*document, file).read();
}

Expected<DeviceDescription> read_device_description(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (error || !stream) {
    return failure(MinorCode::InvalidParameterValue, fmt::format("{}: the file cannot be read", file.string()));
  }
  if (size > kMostBytes) {
    return failure(
        MinorCode::InvalidParameterValue,
        fmt::format("{}: {} bytes are too many for an EDS; at most {} are read", file.string(), size, kMostBytes));
  }
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return parse_device_description(text, file.string());
}

}  // namespace rmac::fieldbus::eds
