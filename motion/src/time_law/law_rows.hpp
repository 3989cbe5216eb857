#pragma once

#include <cstddef>
#include <vector>

#include "lanes.hpp"
#include "time_law/law_problem.hpp"

namespace rmac {

/// low <= phi(c) <= 1 on the three coefficients of one interval, two such rows at once, with slack and dual variable
/// of both sides. Most of the time of a plan is spent going through these, so what belongs together lies together, both
/// sides share one gradient, and rows of an interval share the coefficients that they touch.
/// phi is gradient·c, or for jerk (w·c)·√q, eq. 10: that of a joint at both ends of the interval, or of two joints at a
/// place within it.
struct Rows {
  LaneTriple w{}, gradient{};
  Lanes low{};
  struct Side {
    Lanes slack{}, inverse_slack{}, dual{}, residual{}, slack_step{};
    union {
      Lanes dual_step{};
      Lanes product;  ///< of slack and dual, what is to be added for the predictor's steps
    };
  };
  Side above, below;
};

/// Rows of one interval that lie together among all: the linear ones, then those of jerk, up to the next group's; and q
/// where these are, as weights of the coefficients.
struct RowGroup {
  std::size_t interval = 0;
  std::size_t linear = 0, jerk = 0;
  LaneTriple q{};
};

/// Whether a joint has a row of jerk on an interval: not where it rests.
[[nodiscard]] bool moves_on(const LawProblem& problem, std::size_t interval, std::size_t joint) noexcept;

/// What bounds a law: everything that `LawProblem` says, but for the end states, which fix two coefficients each.
struct LawRows {
  std::vector<Rows> all;
  std::vector<RowGroup> groups;  ///< of each interval, of each cut, and one behind the last

  explicit LawRows(const LawProblem& problem);
};

}  // namespace rmac
