#pragma once

#include <map>
#include <string>
#include <vector>

namespace rmac::sdk {

/// A module named in `device.json`, with its parameters by name.
struct ModuleChoice {
  std::string name;
  std::map<std::string, std::vector<double>> numbers;
  std::map<std::string, std::string> texts;

  [[nodiscard]] bool operator==(const ModuleChoice& other) const = default;
};

}  // namespace rmac::sdk
