#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "rmac/motion/plan_channel.hpp"

namespace rmac::gateway {

/// Outputs that switch at a place of the path.
struct OutputMark {
  std::uint64_t number = 0;       ///< counts all marks, from 1
  std::uint64_t after_moves = 0;  ///< its place: where so many moves are done (`ServoStatus::moves_done`)
  std::uint64_t mask = 0;
  std::uint64_t values = 0;
};

/// Marks on their way to the servo thread, in the order of their places.
using MarkRing = SpscRing<OutputMark, 256>;

/// The machine's outputs, cycle by cycle: as they are wished, and as the marks switch them that the path has passed
/// and that the wishes do not know of yet. Moves are done once, whichever way the tool goes over their ends, so a mark
/// is passed once. Real-time safe; the servo thread.
class PathOutputs {
 public:
  explicit PathOutputs(MarkRing& ahead) noexcept : ahead_(ahead) {}

  /// The outputs of a cycle by whose end `moves_done` moves are done. `settled`: marks up to this one are in `wished`,
  /// or are dropped.
  [[nodiscard]] std::uint64_t step(std::uint64_t wished, std::uint64_t settled, std::uint64_t moves_done) noexcept;
  /// The last mark that was passed.
  [[nodiscard]] std::uint64_t passed() const noexcept { return passed_; }

 private:
  void pass(const OutputMark& mark) noexcept;

  MarkRing& ahead_;
  std::optional<OutputMark> next_;
  std::array<OutputMark, 64> unsettled_{};  ///< passed, in order
  std::size_t count_ = 0;                   ///< of them
  std::uint64_t passed_ = 0;
};

}  // namespace rmac::gateway
