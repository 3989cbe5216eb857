#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clients/legacy/gcode/blocks/block.hpp"
#include "clients/legacy/rs274/blocks/reader.hpp"
#include "clients/legacy/rs274/blocks/refusal.hpp"
#include "clients/legacy/rs274/flow/flow.hpp"

namespace rmac::rs274 {

/// What a program of O words and parameters does: the words of its other lines with their values, as in "X3 Y1", and
/// "[file:]line:column: message" where it is refused. `M98 P… L…` calls.
inline std::vector<std::string> carried_out(const std::string& program, Bounds bounds = {.idle_lines = 1000},
                                            bool block_delete = false, FindFile find_file = {}) {
  std::vector<std::string> done;
  Parameters parameters;
  Flow flow(program, block_delete, bounds, parameters,
            {.made =
                 [&] {
                   return Made{done.size(), 0};
                 },
             .find_file = std::move(find_file)});
  BlockReader reader;
  Block block;
  try {
    while (flow.next()) {
      if (block_delete && flow.line().text().starts_with('/')) continue;
      reader.read(flow.line(), parameters, block);
      if (const auto& code = block.m(gcode::MGroup::Stop)) {
        if (code->number == 2) return done;
        if (code->number == 99) flow.end_of_numbered(code->place);
        if (code->number == 98) {
          const int times = block.has('L') ? static_cast<int>(block.use('L').value) : 1;
          flow.call(static_cast<int>(block.use('P').value), times, code->place);
        }
        continue;
      }
      std::string words;
      for (const char letter : std::string_view("XYZ")) {
        if (block.has(letter))
          words += fmt::format("{}{}{}", words.empty() ? "" : " ", letter, block.use(letter).value);
      }
      if (!words.empty()) done.push_back(words);
    }
  } catch (const Refusal& refusal) {
    const std::string file = flow.file().empty() ? "" : flow.file() + ":";
    done.push_back(fmt::format("{}{}:{}: {}", file, flow.number(), flow.line().column(refusal.place), refusal.message));
  }
  return done;
}

}  // namespace rmac::rs274
