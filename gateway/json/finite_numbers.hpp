#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

namespace rmac::gateway {

/// Has a command line take finite numbers only, in all options that it has by now: words such as nan are numbers to
/// CLI11, and no range refuses a nan.
inline void take_finite_numbers_only(CLI::App& app) {
  const CLI::Validator finite(
      [](const std::string& word) {
        double number = 0;
        return CLI::detail::lexical_cast(word, number) && !std::isfinite(number) ? word + " is no finite number" : "";
      },
      "");
  const auto takes_number = [](const CLI::Option* option) { return option->get_type_name().starts_with("FLOAT"); };
  for (auto* option : app.get_options(takes_number)) option->check(finite);
  for (auto* command : app.get_subcommands([](const CLI::App*) { return true; })) take_finite_numbers_only(*command);
}

}  // namespace rmac::gateway
