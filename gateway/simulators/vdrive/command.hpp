#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/simulators/vdrive/node.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::vdrive {

using Nodes = std::vector<std::unique_ptr<Node>>;

/// The grammar of `execute`, for --help and for the command `help`.
[[nodiscard]] std::string_view command_help();

/// Carries out one line, "1 mute on": a node id or `all`, and what happens to it. Returns what to answer.
[[nodiscard]] Expected<std::string> execute(std::string_view line, Nodes& nodes, Time now);

/// A line that is carried out later: "2.5 1 mute on", seconds from the start before it.
struct Scheduled {
  Time at{0};
  std::string line;
};
[[nodiscard]] Expected<Scheduled> read_scheduled(std::string_view text);

}  // namespace rmac::vdrive
