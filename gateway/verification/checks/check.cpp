#include "gateway/verification/checks/check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace rmac::verifier {

std::string to_string(const CounterExample& example) {
  std::string text = fmt::format("{}: {}", example.check, example.what);
  std::string at = example.sample >= 0 ? fmt::format("sample {}", example.sample) : "";
  for (const NamedNumbers& value : example.values) {
    at += fmt::format("{}{} {}", at.empty() ? "" : "; ", value.name, fmt::join(value.numbers, " "));
  }
  return at.empty() ? text : fmt::format("{} ({})", text, at);
}

}  // namespace rmac::verifier
