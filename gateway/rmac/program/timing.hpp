#pragma once

#include <string>

namespace rmac::cli {

/// How a request of a program stands to the moves before it.
enum class Timing {
  Move,     ///< queued behind the moves before it
  Stream,   ///< takes effect on what is queued after it, or only asks: sent without waiting
  Start,    ///< starts the cycle: sent at once, for the moves before it wait for it
  Settled,  ///< acts on the machine at once (spindle, frames, configuration, loading): sent when all before it is done
};

/// By the API table; what is not in the table waits for all before it, and the appliance refuses it.
[[nodiscard]] Timing timing_of(const std::string& method);

/// Whether it queues what is done between moves.
[[nodiscard]] bool stands_between_moves(const std::string& method);

/// Whether a move ends where the part is, so that what comes next begins there.
[[nodiscard]] bool measures(const std::string& method);

}  // namespace rmac::cli
