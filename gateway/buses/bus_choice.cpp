#include "gateway/buses/bus_choice.hpp"

namespace rmac::gateway {
namespace {

constexpr const char* kInterface = "interface";

/// The bus that a parameter `BUS.name` is for, or nothing.
std::string bus_of(const std::string& key) {
  const std::size_t point = key.rfind('.');
  return point == std::string::npos ? std::string() : key.substr(0, point);
}

}  // namespace

sdk::ModuleChoice interface_of_bus(const std::string& bus, const sdk::ModuleChoice& machine) {
  const bool own = !bus.empty() && machine.texts.contains(bus + "." + kInterface);
  sdk::ModuleChoice choice;
  choice.name = own ? machine.texts.at(bus + "." + kInterface) : machine.name;
  const auto take = [&](const auto& from, auto& to) {
    for (const auto& [key, value] : from) {
      const std::string named = bus_of(key);
      if (own && named == bus) {
        to.emplace(key.substr(bus.size() + 1), value);
      } else if (!own && (named.empty() || named == bus)) {
        to.emplace(key, value);
      }
    }
  };
  take(machine.numbers, choice.numbers);
  take(machine.texts, choice.texts);
  choice.texts.erase(own ? kInterface : "");
  return choice;
}

}  // namespace rmac::gateway
