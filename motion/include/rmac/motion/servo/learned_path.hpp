#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rmac/motion/error.hpp"
#include "rmac/motion/machine_size.hpp"

namespace rmac {

/// What was learned of a program that is repeated: by how much each joint's setpoint is to be moved, as a function of
/// the place on the path, so that the joint comes out where the program wants it. Mm or degrees. Places count from the
/// beginning of the first move, through all moves; knots stand equally far apart in the time of the pass that they were
/// learned in. Made off the cycle; read by the servo thread, real-time safe.
class LearnedPath {
 public:
  static constexpr std::size_t kMostKnots = 250'000;

  /// One move of the program, by the client's id, which no other has.
  struct Move {
    std::int64_t id = 0;
    double begin_mm = 0;  ///< its place
  };
  struct Parts {
    std::vector<Move> moves;     ///< in the program's order
    double end_mm = 0;           ///< of the last move
    std::vector<double> places;  ///< of the knots, mm, ascending
    std::size_t joints = 0;
    std::vector<double> offsets;  ///< of all joints at the first knot, then at the second, …
  };
  /// Where somebody is on the path, who asks once a cycle.
  struct Cursor {
    double along_mm = 0, step_mm = 0;
    std::size_t move = 0;
    int unknown = 0;     ///< cycles on end in moves that are not known
    bool on_it = false;  ///< the path was known in the cycle before
  };

  /// The error names what makes no sense.
  [[nodiscard]] static Expected<LearnedPath> create(Parts parts);

  /// The offsets at a place of a move, one for each joint; false where the path is not known. Moves that were passed
  /// within less than a cycle when the path was learned are gone through by the way that the cycle before made.
  [[nodiscard]] bool at(Cursor& cursor, std::int64_t move_id, double s_mm, std::span<double> offsets) const noexcept;

  [[nodiscard]] std::size_t joints() const noexcept { return parts_.joints; }
  [[nodiscard]] std::size_t knots() const noexcept { return parts_.places.size(); }
  [[nodiscard]] std::size_t moves() const noexcept { return parts_.moves.size(); }
  /// Largest offset of a joint.
  [[nodiscard]] double largest(std::size_t joint) const noexcept { return largest_[joint]; }
  /// Largest change of any joint's offset from one knot to the next.
  [[nodiscard]] double steepest() const noexcept { return steepest_; }

 private:
  explicit LearnedPath(Parts parts);
  [[nodiscard]] bool find(Cursor& cursor, std::int64_t move_id) const noexcept;
  void interpolate(double along_mm, std::span<double> offsets) const noexcept;

  Parts parts_;
  std::vector<std::size_t> by_id_;  ///< places in `moves`, sorted by their id
  std::array<double, kMaxJoints> largest_{};
  double steepest_ = 0;
};

}  // namespace rmac
