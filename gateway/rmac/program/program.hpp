#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gateway/rmac/program/timing.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// One request of a `.rmac` file. A program may have millions, and parsed they take several times as much.
struct Request {
  int line = 0;
  std::string text;  ///< the whole request, as the file has it
  std::string method;
  Timing timing = Timing::Settled;
  std::int64_t move_id = 0;  ///< of a `Move`
  bool tool_change = false;  ///< a `Move` without an id

  /// Null where it has none.
  [[nodiscard]] nlohmann::json params() const;
};

/// A `.rmac` file: one JSON-RPC request a line, empty lines allowed.
struct Program {
  std::string file;
  std::vector<Request> requests;
  std::size_t moves = 0;
  bool starts_cycle = false;
  bool loads_mechanism = false;
};

/// Whether a request loads a machine.
[[nodiscard]] bool loads_mechanism(const Request& request);

/// Reads and checks the whole file before anything moves ("-" is standard input). An error names file and line.
[[nodiscard]] Result<Program> read_program(const std::string& file);
/// The same of what another control's program became. The id of each request is the line of `file` that it comes from.
[[nodiscard]] Result<Program> read_imported(std::string requests, const std::string& file);

}  // namespace rmac::cli
