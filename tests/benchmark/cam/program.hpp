#pragma once

#include <string>
#include <vector>

#include "rmac/motion/move.hpp"
#include "rmac/motion/planner_model.hpp"
#include "tl/expected.hpp"

namespace rmac::bench {

/// Corners of a program of lines, with the tolerance (mm) and feed (mm/s) of each.
struct Program {
  std::vector<Vector> corners;
  double tolerance_mm = 0.01;
  double feed_mm_s = 200;
};

/// Coordinates as a post-processor writes them: to a multiple of `to_mm`; points that then repeat are left out.
[[nodiscard]] std::vector<Vector> rounded(std::vector<Vector> corners, double to_mm);

/// What became of a program on a machine.
struct Machined {
  double time_s = 0;          ///< in motion, from rest to rest
  double planning_s = 0;      ///< CPU time of the planner
  double longest_step_s = 0;  ///< CPU time of its longest step
  double limits = 0;          ///< largest demand on a joint, as a part of its limit
  double deviation_mm = 0;    ///< of the setpoints from the polyline that was sent, or of its corners from them
  int rests = 0;              ///< between its begin and its end
};

/// Machines a program that is queued whole, from rest to rest; the message where it is refused or never ends.
[[nodiscard]] tl::expected<Machined, std::string> machine(const Program& program, const PlannerModel& model);
/// Why there is no such figure.
struct NotMachined {
  bool refused = false;  ///< a move of it was; otherwise it never ended
  std::string why;
};
/// The same of moves of any kind. Its deviation is that from the moves as they were sent, place by place.
[[nodiscard]] tl::expected<Machined, NotMachined> machine(const std::vector<Move>& moves, const PlannerModel& model);
/// The same of one NURBS.
[[nodiscard]] tl::expected<Machined, std::string> machine(const Nurbs& nurbs, double tolerance_mm, double feed_mm_s,
                                                          const PlannerModel& model);

}  // namespace rmac::bench
