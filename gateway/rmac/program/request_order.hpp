#pragma once

#include "gateway/rmac/program/program.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// What the next request of a program waits for, by those that were sent before it. Who runs a program and who
/// simulates it go by the same rules.
class RequestOrder {
 public:
  explicit RequestOrder(const Program& program) : program_(program) {}

  /// Refuses a request that would wait for moves which nothing starts.
  [[nodiscard]] Result<> check(const Request& request, bool moves_unfinished) const;
  /// Refuses the end of a program that leaves its moves in the queue.
  [[nodiscard]] Result<> check_end(bool moves_unfinished) const;

  /// The request goes out when the machine stands and all before it is done: it acts on the machine itself, or is the
  /// first move or start behind one that does.
  [[nodiscard]] bool waits_for_rest(const Request& request) const;
  /// The request goes out when the point before it is measured.
  [[nodiscard]] bool waits_for_measurement() const { return measuring_ && started_; }
  /// The request is a first move, of a program that leaves starting the cycle to who runs it.
  [[nodiscard]] bool needs_cycle(const Request& request) const;

  /// A cycle was started for the program.
  void cycle_started() { started_ = true; }
  void sent(const Request& request);
  /// The program's cycle was started, so that its moves become done.
  [[nodiscard]] bool started() const { return started_; }

 private:
  const Program& program_;
  bool started_ = false;
  bool unsettled_ = true;   ///< something acted on the machine since the last move: its rest must be looked at
  bool measuring_ = false;  ///< the last request measures a point
  bool between_ = false;    ///< something that is no move was queued, and may not be done
};

}  // namespace rmac::cli
