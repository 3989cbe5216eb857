#pragma once

#include <cstddef>
#include <vector>

#include "time_law/law_problem.hpp"
#include "time_law/path_view.hpp"

namespace rmac {

/// Grid intervals [first, last).
struct IntervalRange {
  std::size_t first = 0, last = 0;
};

/// Lets the joints' bounds be kept at path length s within an interval too. Where a joint asks most between two nodes,
/// tighter bounds at these are no way to it: there another joint may be at its bound, and nothing gives way. False
/// where s is no place between the nodes, or as good as that of another cut.
[[nodiscard]] bool cut_at(LawProblem& problem, const PathView& path, std::size_t interval, double s);

/// Tightens the joint bounds of intervals that a check found in excess (`excess`: an interval, 1 is just at a limit)
/// and solves the law again around them, from and to the states that it has there: what lies further away stays as it
/// is, to the last bit. Where that has no solution, all of it is solved again. The intervals that changed; none when
/// there is no solution at all.
[[nodiscard]] std::vector<IntervalRange> mend_law(LawProblem& problem, const std::vector<double>& excess,
                                                  std::vector<double>& coefficients);

}  // namespace rmac
