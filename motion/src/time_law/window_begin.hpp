#pragma once

#include <vector>

#include "time_law/law_problem.hpp"
#include "time_law/window.hpp"

namespace rmac {

// How a window begins in motion: in a state that was taken from the law before.

/// Nodes of the law before near the window's begin, at s_begin; `step` is the grid's first. The state there may lie at
/// the very edge of what is viable, where that law itself is as good as the only one: on a grid that holds its nodes it
/// is one of the splines.
[[nodiscard]] std::vector<double> nodes_kept(const std::vector<LawPiece>& before, double s_begin, double s_end,
                                             double step);

/// Takes up the law before (`window.before`): it is the first guess, and the first stretch may use most of the margin
/// that it left. Whether the feed gives way to the state at the begin, which is or becomes too fast for it.
[[nodiscard]] bool go_on_from(LawProblem& problem, const Window& window);

}  // namespace rmac
