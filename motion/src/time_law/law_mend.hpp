#pragma once

#include <cstddef>
#include <vector>

#include "time_law/law_problem.hpp"

namespace rmac {

/// Grid intervals [first, last).
struct IntervalRange {
  std::size_t first = 0, last = 0;
};

/// Tightens the joint bounds of intervals that a check found in excess (`excess`: an interval, 1 is just at a limit)
/// and solves the law again around them, from and to the states that it has there: what lies further away stays as it
/// is, to the last bit. Where that has no solution, all of it is solved again. The intervals that changed; none when
/// there is no solution at all.
[[nodiscard]] std::vector<IntervalRange> mend_law(LawProblem& problem, const std::vector<double>& excess,
                                                  std::vector<double>& coefficients);

}  // namespace rmac
