#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gateway/rmac/failure.hpp"

namespace rmac::cli {

/// How a request of a program stands to the moves before it.
enum class Timing {
  Move,     ///< queued behind the moves before it
  Stream,   ///< takes effect on what is queued after it, or only asks: sent without waiting
  Start,    ///< starts the cycle: sent at once, for the moves before it wait for it
  Settled,  ///< acts on the machine at once (spindle, frames, configuration, loading): sent when all before it is done
};

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

[[nodiscard]] inline bool measures(const std::string& method) {
  return method == "RMAC_CAM.AutoMeasure";
}
[[nodiscard]] Timing timing_of(const std::string& method);

/// Reads and checks the whole file before anything moves ("-" is standard input). An error names file and line.
[[nodiscard]] Result<Program> read_program(const std::string& file);

}  // namespace rmac::cli
