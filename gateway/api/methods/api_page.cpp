// docs/api.md: `rmacd --print-api` writes it, a test compares.
#include <fmt/format.h>

#include <string_view>

#include "gateway/api/methods/method_table.hpp"
#include "gateway/api/methods/openrpc.hpp"

namespace rmac::gateway {

namespace {

constexpr std::string_view kHead = R"(# The API

Written by `rmacd --print-api` from the table that dispatches (`gateway/api`); do not edit. How to talk to the daemon, with
examples, stands in [protocol.md](protocol.md). `rpc.discover` gives the same as an OpenRPC document.

Permission: *anyone* may call it; *authority* needs the lease of `authority.acquire`; *operator* needs that lease or the
place of `operator.acquire`; *stop* needs neither and overtakes what waits on its connection. Effect on motion: what *starts* something and still waits, on any connection, when someone calls what
*holds* or *stops* is refused, and after what *stops*, which empties the queue, so is what *queues* moves. A property reads without `newVal`; with it, it writes, gives `true` and needs authority. Methods
marked † are ours, not the dissertation's. Lengths are mm, angles degrees, feeds mm/min.
)";

std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, 1, '\\');
  return text;
}

std::string unit_of(const std::string& unit) {
  return unit.empty() ? "" : " " + unit;
}

std::string parameters_of(const Method& entry) {
  std::string text;
  for (const ParameterSpec& parameter : entry.parameters) {
    if (!text.empty()) text += "<br>";
    text += fmt::format("`{}` {}{}", parameter.name,
                        parameter.enumeration != nullptr ? parameter.enumeration->name : to_string(parameter.type),
                        unit_of(parameter.unit));
    if (const std::string range = parameter.range.text(); !range.empty()) text += ", " + range;
    if (parameter.optional) text += ", optional";
    if (!parameter.note.empty()) text += "; " + parameter.note;
  }
  return text;
}

std::string result_of(const Method& entry) {
  return fmt::format(
      "{}{}", entry.result.enumeration != nullptr ? entry.result.enumeration->name : to_string(entry.result.type),
      unit_of(entry.result.unit));
}

std::string effect_of(const Method& entry) {
  if (entry.effect == Effect::None) return {};
  if (!entry.harmless) return to_string(entry.effect);
  return fmt::format("{}, not with `{}` {}", to_string(entry.effect), entry.parameters[entry.harmless->parameter].name,
                     entry.harmless->value.dump());
}

std::string interface_of(const Method& entry) {
  const std::size_t dot = entry.name.find('.');
  const std::string prefix = entry.name.substr(0, dot == std::string::npos ? 0 : dot);
  return prefix == "DeviceDriverManager" || prefix == "Device" || prefix == "RMAC_Config" || prefix == "RMAC_CAM"
             ? prefix
             : "Connection";
}

std::string methods_of(std::string_view interface) {
  std::string text = fmt::format(
      "\n## {}\n\n| method | parameters | gives | permission | effect | meaning |\n| --- | --- | --- | --- | --- | --- "
      "|\n",
      interface);
  for (const Method& entry : method_table()) {
    if (interface_of(entry) != interface) continue;
    text += fmt::format("| `{}`{} | {} | {} | {}{} | {} | {} |\n", entry.name,
                        entry.origin == Origin::Extension ? " †" : "", cell(parameters_of(entry)),
                        cell(result_of(entry)), to_string(entry.permission), entry.property ? ", property" : "",
                        effect_of(entry), cell(entry.meaning));
  }
  return text;
}

std::string values_and_errors() {
  std::string text =
      "\n## Named values\n\nThe integer or the name is accepted; integers come back.\n\n| type | values |\n| --- | --- "
      "|\n";
  for (const Enumeration* values : enumerations()) text += fmt::format("| {} | {} |\n", values->name, values->list());
  text += "\n## Errors\n\n| code | name | meaning |\n| --- | --- | --- |\n";
  for (const RpcErrorMeaning& entry : rpc_error_meanings()) {
    text += fmt::format("| {} | {} | {} |\n", entry.code, entry.name, entry.meaning);
  }
  return text;
}

}  // namespace

std::string api_page() {
  std::string page(kHead);
  const auto dissertation = std::ranges::count(method_table(), Origin::Dissertation, &Method::origin);
  page += fmt::format("\n{} methods, {} of them the dissertation's.\n", method_table().size(), dissertation);
  for (const char* interface : {"DeviceDriverManager", "Device", "RMAC_Config", "RMAC_CAM", "Connection"}) {
    page += methods_of(interface);
  }
  return page + values_and_errors();
}

}  // namespace rmac::gateway
