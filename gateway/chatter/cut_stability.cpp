#include "gateway/chatter/cut_stability.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace rmac::gateway {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;
using Ways = std::array<Complex, 3>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kPointsAMode = 40;
/// Of a mode's frequency, how far below and above it is looked.
constexpr double kBelow = 0.9, kAbove = 3;
/// Of neighbours' eigenvalues, so that what is between them goes straight; closer than by so many halvings none is.
constexpr double kClose = 0.2;
constexpr int kMostHalvings = 6;
/// Of the largest eigenvalue: less is none.
constexpr double kNothing = 1e-9;
/// More lobes than so many between two frequencies lie so close that each speed has one.
constexpr double kManyLobes = 16;

Complex receptance(const VibrationMode& mode, double omega) {
  const double r = omega / (2 * pi * mode.frequency_hz);
  return 1.0 / (mode.stiffness_n_mm * Complex(1 - r * r, 2 * mode.damping_ratio * r));
}

/// Dense where a mode turns its phase: by the sine hyperbolic of its half-widths.
std::vector<double> frequencies(std::span<const VibrationMode> modes) {
  std::vector<double> omegas;
  for (const VibrationMode& mode : modes) {
    const double low = -std::asinh(kBelow / mode.damping_ratio), high = std::asinh(kAbove / mode.damping_ratio);
    for (int i = 0; i < kPointsAMode; ++i) {
      const double widths = std::sinh(std::lerp(low, high, static_cast<double>(i) / (kPointsAMode - 1)));
      omegas.push_back(2 * pi * mode.frequency_hz * (1 + mode.damping_ratio * widths));
    }
  }
  std::ranges::sort(omegas);
  return omegas;
}

/// In the order in which they are the nearest to those before, all three together.
void go_on_from(const Ways& before, Ways& now) {
  constexpr std::array<std::array<std::size_t, 3>, 6> kOrders{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  const auto apart = [&](const std::array<std::size_t, 3>& order) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Complex &a = before[i], &b = now[order[i]];
      if (a != b) sum += std::abs(a - b) / (std::abs(a) + std::abs(b));
    }
    return sum;
  };
  const auto nearest = std::ranges::min_element(kOrders, {}, apart);
  now = {now[(*nearest)[0]], now[(*nearest)[1]], now[(*nearest)[2]]};
}

}  // namespace

CutStability::CutStability(const Eigen::Matrix3d& cutting_n_mm, std::span<const VibrationMode> modes)
    : cutting_(cutting_n_mm), modes_(modes.begin(), modes.end()) {
  for (const double omega : frequencies(modes)) add_up_to(point(omega), kMostHalvings);
}

CutStability::Point CutStability::point(double omega_rad_s) const {
  Eigen::Matrix3cd loop = Eigen::Matrix3cd::Zero();
  for (const VibrationMode& mode : modes_) loop += receptance(mode, omega_rad_s) * (mode.directions * cutting_);
  Eigen::Vector3cd values = loop.eigenvalues();
  Point point{.omega_rad_s = omega_rad_s};
  const double least = kNothing * values.cwiseAbs().maxCoeff();
  for (std::size_t i = 0; i < 3; ++i) {
    const Complex& value = values[static_cast<Eigen::Index>(i)];
    point.inverse[i] = std::abs(value) > least ? 1.0 / value : Complex(0, 0);
  }
  return point;
}

double CutStability::share_of(const Complex& inverse) {
  return inverse.real() > 0 ? std::norm(inverse) / (2 * inverse.real()) : kInfinity;
}

/// share·(1 - e^(-i·phase)) lies on a circle around the share, through 0.
double CutStability::phase_of(const Complex& inverse) {
  if (inverse.real() <= 0) return inverse.imag() < 0 ? 2 * pi : 0;  // as on the way there
  const double phase = std::atan2(inverse.imag(), share_of(inverse) - inverse.real());
  return phase < 0 ? phase + 2 * pi : phase;
}

void CutStability::add_up_to(Point next, int halvings) {
  if (!points_.empty()) {
    const Point& last = points_.back();
    go_on_from(last.inverse, next.inverse);
    const bool close = std::ranges::equal(last.inverse, next.inverse, [](const Complex& a, const Complex& b) {
      return std::abs(a - b) <= kClose * std::min(std::abs(a), std::abs(b)) &&
             std::abs(phase_of(a) - phase_of(b)) <= kClose;
    });
    const double middle = (last.omega_rad_s + next.omega_rad_s) / 2;
    if (!close && halvings > 0) {
      add_up_to(point(middle), halvings - 1);
      add_up_to(next, halvings - 1);
      return;
    }
  }
  points_.push_back(next);
}

double CutStability::least_share(double strongest_n_mm, std::span<const VibrationMode> modes) {
  double most = 0;
  for (const VibrationMode& mode : modes) {
    // At its peak; a mode with more than 0.7 of critical damping has none, and is the softest at rest.
    const double peak = mode.damping_ratio < std::numbers::sqrt2 / 2
                            ? 2 * mode.damping_ratio * std::sqrt(1 - mode.damping_ratio * mode.damping_ratio)
                            : 1;
    most += mode.directions.norm() / (mode.stiffness_n_mm * peak);
  }
  const double gain = 2 * most * strongest_n_mm;
  return gain > 0 ? 1 / gain : kInfinity;
}

ChatterLimit CutStability::at(double tooth_period_s) const {
  ChatterLimit limit;
  for (std::size_t n = 1; n < points_.size(); ++n) {
    const Point &low = points_[n - 1], &high = points_[n];
    const auto take = [&](std::size_t way, double part) {
      const double share = share_of(low.inverse[way] + part * (high.inverse[way] - low.inverse[way]));
      if (share >= limit.share) return;
      limit = {share, std::lerp(low.omega_rad_s, high.omega_rad_s, part) / (2 * pi)};
    };
    for (std::size_t way = 0; way < low.inverse.size(); ++way) {
      if (low.inverse[way].real() <= 0 || high.inverse[way].real() <= 0) continue;
      // Waves that fit between two teeth beside the phase: where these are whole, the speed is a lobe's.
      const double from = (low.omega_rad_s * tooth_period_s - phase_of(low.inverse[way])) / (2 * pi);
      const double to = (high.omega_rad_s * tooth_period_s - phase_of(high.inverse[way])) / (2 * pi);
      if (std::abs(to - from) > kManyLobes) {
        take(way, 0), take(way, 1);
        continue;
      }
      const auto last = static_cast<int>(std::floor(std::max(from, to)));
      for (int waves = std::max(0, static_cast<int>(std::ceil(std::min(from, to)))); waves <= last; ++waves) {
        take(way, to != from ? (waves - from) / (to - from) : 0);
      }
    }
  }
  return limit;
}

}  // namespace rmac::gateway
