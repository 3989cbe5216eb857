#pragma once

#include <array>

#include "time_law/law_problem.hpp"

namespace rmac {

using Weights = std::array<double, 3>;

[[nodiscard]] inline double dot(const Weights& w, const double* c) noexcept {
  return w[0] * c[0] + w[1] * c[1] + w[2] * c[2];
}

/// Value, slope and curvature of q at one end of interval k as weights of c[k], c[k+1], c[k+2] (eq. 7).
struct LawBasis {
  Weights q, dq, ddq;
};
[[nodiscard]] LawBasis basis(const LawProblem& problem, std::size_t k, bool right) noexcept;

/// And within it.
[[nodiscard]] LawBasis basis_within(const LawProblem& problem, std::size_t k, double part) noexcept;

/// A first guess of the coefficients between the ends: a profile not far from what the bounds allow.
void guess_coefficients(const LawProblem& problem, std::vector<double>& coefficients);

}  // namespace rmac
