#pragma once

#include <cstddef>
#include <functional>

namespace rmac::gcode {

/// What ends a program that would never end by itself.
struct Bounds {
  std::size_t idle_lines = 1'000'000;  ///< carried out one after the other without a move
  std::size_t output_mb = 1024;        ///< of a program with loops or subprograms; 10^6 bytes each
};

/// What came of a program so far.
struct Made {
  std::size_t moves = 0, bytes = 0;
};

/// Notices a program that goes on for ever. Only where lines come again a program can; nothing is looked at elsewhere.
class Endless {
 public:
  Endless(Bounds bounds, std::function<Made()> made) : bounds_(bounds), made_(std::move(made)) {}

  /// A line was come to.
  void count() noexcept { ++lines_; }
  /// Lines come again by what stands at `place` of the last one. Throws a Refusal beyond the bounds.
  void come_again(std::size_t place);

 private:
  Bounds bounds_;
  std::function<Made()> made_;
  std::size_t lines_ = 0, lines_at_move_ = 0, moves_ = 0;
};

}  // namespace rmac::gcode
