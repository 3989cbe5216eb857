#pragma once

#include <span>

namespace rmac::gateway {

/// Filters `values`, which are 0 before and after, forwards and backwards with a Butterworth low-pass of second order:
/// without any shift of phase, 1/(1 + (f/corner)⁴) in amplitude.
void filter_zero_phase(std::span<double> values, double corner_hz, double period_s);

}  // namespace rmac::gateway
