#include "gateway/forces/edge_forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace rmac::gateway {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr int kLeastPositions = 360;  ///< over a turn, of the tool
constexpr double kMostTurned = 0.3;   ///< rad, in φ or κ, of a piece of edge that is integrated at once
/// Where the arc on which there is a chip changes along the edge, because the tool goes along its axis too.
constexpr double kMostTurnedObliquely = 0.05;
constexpr double kBeside = 1e-9;  ///< rad
constexpr int kHalvings = 40;

/// Gauss and Legendre's five points on 0 … 1.
constexpr std::array<std::pair<double, double>, 5> kGauss{{{0.046910077030668004, 0.11846344252809454},
                                                           {0.23076534494715845, 0.23931433524968324},
                                                           {0.5, 0.28444444444444444},
                                                           {0.76923465505284155, 0.23931433524968324},
                                                           {0.95308992296933200, 0.11846344252809454}}};

}  // namespace

EdgeForces::Chip EdgeForces::chip_of_feed(const EndMill::Place& place) const {
  return {feed_.across_mm * place.sin_k, 0, -feed_.along_mm * place.cos_k};
}

std::array<EdgeForces::Chip, 3> EdgeForces::chips_of_ways(const EndMill::Place& place) {
  return {Chip{place.sin_k, 0, 0}, Chip{0, place.sin_k, 0}, Chip{0, 0, -place.cos_k}};
}

double EdgeForces::chip(const EndMill::Place& place, double angle) const {
  return feed_.across_mm * std::sin(angle) * place.sin_k - feed_.along_mm * place.cos_k;
}

template <class Visit>
void EdgeForces::along_profile(double low_mm, double high_mm, double most_turned, Visit&& visit) const {
  const double corner = mill_.corner_ends_mm(), low = mill_.profile_at(low_mm), high = mill_.profile_at(high_mm);
  const auto pieces = [&](double from, double to, double turned_per_mm) {
    if (to <= from) return;
    const int count = 1 + static_cast<int>((to - from) * turned_per_mm / most_turned);
    for (int i = 0; i < count; ++i) visit(from + (to - from) * i / count, from + (to - from) * (i + 1) / count);
  };
  const double lag = mill_.lag_per_mm();
  if (corner > 0) {
    // Below it a tool that plunges cuts all around, and one that rises nowhere.
    const double around = mill_.corner_radius_mm() * std::atan2(std::abs(feed_.along_mm), feed_.across_mm);
    const double turned = lag + 1 / mill_.corner_radius_mm(), top = std::min(high, corner);
    pieces(low, std::min(top, around), turned);
    pieces(std::max(low, around), top, turned);
  }
  pieces(std::max(low, corner), high, lag);
}

EdgeSum EdgeForces::on_tool(const EndMill::Place& place, double angle, double t, double r, double a) const {
  const double s = std::sin(angle), c = std::cos(angle);
  EdgeSum sum;
  sum.force = {-t * c - (r * place.sin_k + a * place.cos_k) * s, t * s - (r * place.sin_k + a * place.cos_k) * c,
               r * place.cos_k - a * place.sin_k};
  sum.tangential = t;
  sum.torque = t * place.radius_mm;
  return sum;
}

void EdgeForces::add_between(double from, double to, const EndMill::Place& place, const Chip& chip,
                             EdgeSum& sum) const {
  if (to <= from) return;
  const auto between = [&](auto&& integral) { return integral(to) - integral(from); };
  using std::cos, std::sin;
  const double angle = to - from, sines = between([](double x) { return -cos(x); }),
               cosines = between([](double x) { return sin(x); });
  const double sine_sines = between([](double x) { return x / 2 - sin(2 * x) / 4; });
  const double sine_cosines = between([](double x) { return sin(x) * sin(x) / 2; });
  const double cosine_cosines = angle - sine_sines;
  const double chips = chip.sine * sines + chip.cosine * cosines + chip.level * angle;
  const double chip_sines = chip.sine * sine_sines + chip.cosine * sine_cosines + chip.level * sines;
  const double chip_cosines = chip.sine * sine_cosines + chip.cosine * cosine_cosines + chip.level * cosines;
  const double longer = place.edge_per_profile;
  // What the directions of a tooth at 90°, where the sine is 1, and at 0, where the cosine is, have of it.
  const auto with = [&](double h, double e) {
    return std::array{k_.ktc * h + k_.kte * longer * e, k_.krc * h + k_.kre * longer * e,
                      k_.kac * h + k_.kae * longer * e};
  };
  const auto all = with(chips, angle), by_sine = with(chip_sines, sines), by_cosine = with(chip_cosines, cosines);
  const auto inward = [&](const std::array<double, 3>& tra) { return tra[1] * place.sin_k + tra[2] * place.cos_k; };
  sum.force += Vector3d(-by_cosine[0] - inward(by_sine), by_sine[0] - inward(by_cosine),
                        all[1] * place.cos_k - all[2] * place.sin_k);
  sum.tangential += all[0];
  sum.torque += all[0] * place.radius_mm;
}

template <class Visit>
void EdgeForces::over_chips(const EndMill::Place& place, const Arc& arc, Visit&& visit) const {
  const auto [wave, none, level] = chip_of_feed(place);
  if (wave <= 0) {
    if (level >= 0) visit(arc.entry, arc.exit);
    return;
  }
  // The chip is there where the sine is at least so much.
  const double least = -level / wave;
  if (least > 1) return;
  if (least <= -1) {
    visit(arc.entry, arc.exit);
    return;
  }
  const double begin = std::asin(least), end = pi - begin;
  for (double turn = 2 * pi * (std::floor((arc.entry - end) / (2 * pi))); begin + turn < arc.exit; turn += 2 * pi) {
    visit(std::max(arc.entry, begin + turn), std::min(arc.exit, end + turn));
  }
}

template <class Visit>
void EdgeForces::over_edges(Visit&& visit) const {
  const double most_turned = feed_.along_mm == 0 ? kMostTurned : kMostTurnedObliquely;
  const double share = mill_.teeth() / (2 * pi);
  for (const EngagedSlice& slice : slices_) {
    along_profile(slice.from_mm, slice.to_mm, most_turned, [&](double from, double to) {
      for (const auto& [part, weight] : kGauss) {
        const EndMill::Place place = mill_.at(from + part * (to - from));
        const double of_piece = share * weight * (to - from);
        const auto at_place = [&](double entry, double exit) { visit(place, entry, exit, of_piece); };
        for (const Arc& arc : slice.arcs) over_chips(place, arc, at_place);
      }
    });
  }
}

template <class Visit>
void EdgeForces::on_piece(double from, double to, double lowest, Visit&& visit) const {
  const auto chip_at = [&](double profile) {
    const EndMill::Place place = mill_.at(profile);
    return chip(place, lowest - mill_.lag_per_mm() * place.z_mm);
  };
  const double at_from = chip_at(from), at_to = chip_at(to);
  if (at_from < 0 && at_to < 0) return;
  if (at_from < 0 || at_to < 0) {
    double without = at_from < 0 ? from : to, with = at_from < 0 ? to : from;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = (without + with) / 2;
      (chip_at(middle) < 0 ? without : with) = middle;
    }
    (at_from < 0 ? from : to) = with;
  }
  for (const auto& [part, weight] : kGauss) {
    const EndMill::Place place = mill_.at(from + part * (to - from));
    visit(place, lowest - mill_.lag_per_mm() * place.z_mm, weight * (to - from));
  }
}

template <class Visit>
void EdgeForces::on_tooth(const EngagedSlice& slice, const Arc& arc, double lowest, Visit&& visit) const {
  const double lag = mill_.lag_per_mm();
  // The arc once for each turn that the tooth lags behind in the slice.
  const double first = lowest - lag * slice.to_mm, last = lowest - lag * slice.from_mm;
  const int turns_from = static_cast<int>(std::floor((first - arc.exit) / (2 * pi)));
  const int turns_to = static_cast<int>(std::ceil((last - arc.entry) / (2 * pi)));
  for (int turn = turns_from; turn <= turns_to; ++turn) {
    const double entry = arc.entry + 2 * pi * turn, exit = arc.exit + 2 * pi * turn;
    double low = slice.from_mm, high = slice.to_mm;
    if (lag > 0) {
      low = std::max(low, (lowest - exit) / lag), high = std::min(high, (lowest - entry) / lag);
    } else if (lowest < entry || lowest > exit) {
      continue;
    }
    if (high <= low) continue;
    along_profile(low, high, kMostTurned, [&](double from, double to) { on_piece(from, to, lowest, visit); });
  }
}

template <class Visit>
void EdgeForces::at_edges(double angle, Visit&& visit) const {
  for (int tooth = 0; tooth < mill_.teeth(); ++tooth) {
    const double lowest = angle + 2 * pi * tooth / mill_.teeth();
    for (const EngagedSlice& slice : slices_) {
      for (const Arc& arc : slice.arcs) on_tooth(slice, arc, lowest, visit);
    }
  }
}

EdgeSum EdgeForces::mean() const {
  EdgeSum sum;
  over_edges([&](const EndMill::Place& place, double from, double to, double weight) {
    EdgeSum of;
    add_between(from, to, place, chip_of_feed(place), of);
    sum.add(weight, of);
  });
  return sum;
}

EdgeSum EdgeForces::at(double angle) const {
  EdgeSum sum;
  at_edges(angle, [&](const EndMill::Place& place, double at, double weight) {
    const double h = std::max(0.0, chip(place, at)), edge = place.edge_per_profile;
    sum.add(weight,
            on_tool(place, at, k_.ktc * h + k_.kte * edge, k_.krc * h + k_.kre * edge, k_.kac * h + k_.kae * edge));
  });
  return sum;
}

Eigen::Matrix3d EdgeForces::mean_change() const {
  Eigen::Matrix3d columns = Eigen::Matrix3d::Zero();
  over_edges([&](const EndMill::Place& place, double from, double to, double weight) {
    const auto ways = chips_of_ways(place);
    for (std::size_t i = 0; i < ways.size(); ++i) {
      EdgeSum of;
      add_between(from, to, place, ways[i], of);
      columns.col(static_cast<Eigen::Index>(i)) += weight * of.force;
    }
  });
  return columns;
}

Eigen::Matrix3d EdgeForces::change_at(double angle) const {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  at_edges(angle, [&](const EndMill::Place& place, double at, double weight) {
    const Vector3d chips(std::sin(at) * place.sin_k, std::cos(at) * place.sin_k, -place.cos_k);
    sum += weight * on_tool(place, at, k_.ktc, k_.krc, k_.kac).force * chips.transpose();
  });
  return sum;
}

std::vector<double> EdgeForces::positions() const {
  const double pitch = 2 * pi / mill_.teeth();
  const int count = (kLeastPositions + mill_.teeth() - 1) / mill_.teeth();
  std::vector<double> angles;
  angles.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) angles.push_back(pitch * (i + 0.5) / count);
  for (const EngagedSlice& slice : slices_) {
    for (const Arc& arc : slice.arcs) {
      for (const double z : {slice.from_mm, slice.to_mm}) {
        for (const double edge : {arc.entry + kBeside, arc.exit - kBeside}) {
          const double angle = std::fmod(edge + mill_.lag_per_mm() * z, pitch);
          angles.push_back(angle < 0 ? angle + pitch : angle);
        }
      }
    }
  }
  std::ranges::sort(angles);
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  return angles;
}

double EdgeForces::chip_mm3() const {
  // A material that gives 1 N/mm² of torque for each chip alone.
  const ForceCoefficients unit{.ktc = 1, .krc = 0, .kac = 0, .kte = 0, .kre = 0, .kae = 0};
  return 2 * pi * EdgeForces(mill_, unit, slices_, feed_).mean().torque;
}

}  // namespace rmac::gateway
