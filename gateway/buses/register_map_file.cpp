#include "gateway/buses/register_map_file.hpp"

#include <fmt/format.h>

#include "gateway/json/json_document.hpp"
#include "gateway/json/schemas.hpp"

namespace rmac::gateway {
namespace {

using fieldbus::modbus::BitRange;
using fieldbus::modbus::Condition;
using fieldbus::modbus::IoMap;
using fieldbus::modbus::of_bits;
using fieldbus::modbus::Place;
using fieldbus::modbus::Quantity;
using fieldbus::modbus::RegisterWrite;
using fieldbus::modbus::SpindleMap;
using fieldbus::modbus::Table;
using Json = nlohmann::json;

// What the schemas let pass: the readers below rely on it.

/// A number, or hexadecimal digits with an h behind them.
std::uint32_t number_of(const Json& value) {
  if (value.is_number()) return value.get<std::uint32_t>();
  return static_cast<std::uint32_t>(std::stoul(value.get<std::string>(), nullptr, 16));
}

std::uint16_t address(const Json& value) {
  return static_cast<std::uint16_t>(number_of(value));
}

Table table(const Json& entry) {
  const std::string name = entry.value("Table", "HoldingRegisters");
  if (name == "Coils") return Table::Coils;
  if (name == "DiscreteInputs") return Table::DiscreteInputs;
  return name == "InputRegisters" ? Table::InputRegisters : Table::HoldingRegisters;
}

Place place(const Json& entry) {
  Place read;
  read.table = table(entry);
  read.address = address(entry["Address"]);
  read.bits = of_bits(read.table) && !entry.contains("Bits") ? std::uint8_t{1} : entry.value("Bits", std::uint8_t{16});
  read.is_signed = entry.value("Signed", false);
  read.low_word_first = entry.value("WordOrder", "HighFirst") == "LowFirst";
  if (entry.contains("Mask")) read.mask = number_of(entry["Mask"]);
  return read;
}

Quantity quantity(const Json& entry) {
  return {place(entry), entry["PerUnit"].get<double>()};
}

Condition condition(const Json& entry) {
  Condition read{place(entry), {}};
  for (const Json& value : entry["Is"]) read.is.push_back(number_of(value));
  return read;
}

std::vector<RegisterWrite> writes(const Json& entries) {
  std::vector<RegisterWrite> read;
  for (const Json& entry : entries) read.push_back({table(entry), address(entry["Address"]), address(entry["Value"])});
  return read;
}

std::vector<BitRange> bit_ranges(const Json& entries) {
  std::vector<BitRange> read;
  for (const Json& entry : entries) {
    read.push_back({place(entry), entry["Count"].get<std::size_t>(), entry.value("FirstBit", std::size_t{0}),
                    entry.value("Inverted", false)});
  }
  return read;
}

void read_fault(const Json& fault, SpindleMap& map) {
  if (fault.contains("Tripped")) map.tripped = condition(fault["Tripped"]);
  if (fault.contains("Code")) map.fault_code = place(fault["Code"]);
  const Json texts = fault.value("Texts", Json::object());
  for (const auto& [code, text] : texts.items()) {
    map.fault_texts[static_cast<std::uint32_t>(std::stoul(code))] = text.get<std::string>();
  }
}

SpindleMap spindle_map(const Json& document) {
  SpindleMap map;
  map.name = document["Name"];
  map.manual = document["Manual"];
  map.most_per_read = document.value("MostPerRead", std::size_t{1});
  const Json& command = document["SpeedCommand"];
  map.speed_command = quantity(command);
  map.speed_command_unit = command.value("Unit", "Hz") == "Hz" ? SpindleMap::Unit::Hertz : SpindleMap::Unit::OfMaximum;
  if (command.contains("ReadBack")) {
    map.speed_read_back = map.speed_command.place;
    map.speed_read_back->address = address(command["ReadBack"]);
  }
  map.speed = quantity(document["Speed"]);
  if (document.contains("Running")) map.running = condition(document["Running"]);
  if (document.contains("Reversed")) map.backward = condition(document["Reversed"]);
  read_fault(document["Fault"], map);
  map.forward_run = writes(document["Forward"]);
  map.backward_run = writes(document.value("Reverse", Json::array()));
  map.stop = writes(document["Stop"]);
  map.reset_fault = writes(document["ResetFault"]);
  return map;
}

IoMap io_map(const Json& document) {
  constexpr std::size_t kMostPerRead = 16;
  return {document["Name"], document["Manual"], document.value("MostPerRead", kMostPerRead),
          bit_ranges(document.value("Inputs", Json::array())), bit_ranges(document.value("Outputs", Json::array()))};
}

/// The map as a whole, with the file's name before what is wrong in it.
template <typename Map>
Expected<Map> checked(const std::filesystem::path& file, Map map) {
  if (auto sound = fieldbus::modbus::check(map); !sound) {
    return failure(sound.error().code, fmt::format("{}: {}", file.string(), sound.error().message));
  }
  return map;
}

}  // namespace

Expected<SpindleMap> read_spindle_map(const std::filesystem::path& file) {
  static const JsonSchema kSchema(modbus_spindle_schema_text());
  const auto document = read_json_document(file, kSchema);
  if (!document) return tl::unexpected(document.error());
  return checked(file, spindle_map(*document));
}

Expected<IoMap> read_io_map(const std::filesystem::path& file) {
  static const JsonSchema kSchema(modbus_io_schema_text());
  const auto document = read_json_document(file, kSchema);
  if (!document) return tl::unexpected(document.error());
  return checked(file, io_map(*document));
}

}  // namespace rmac::gateway
