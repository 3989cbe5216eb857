#include "gateway/forces/turn_forces.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
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
/// A cut is as deep as the flutes are long where it is no more than this beyond them.
constexpr double kSlack_mm = 1e-6;

/// Gauss and Legendre's five points on 0 … 1.
constexpr std::array<std::pair<double, double>, 5> kGauss{{{0.046910077030668004, 0.11846344252809454},
                                                           {0.23076534494715845, 0.23931433524968324},
                                                           {0.5, 0.28444444444444444},
                                                           {0.76923465505284155, 0.23931433524968324},
                                                           {0.95308992296933200, 0.11846344252809454}}};

/// What pieces of edge give: force by its three directions on the tool, against their motion, and torque.
struct Sum {
  Vector3d force{0, 0, 0};  ///< N
  double tangential = 0;    ///< N
  double torque = 0;        ///< N·mm

  void add(double by, const Sum& other) {
    force += by * other.force, tangential += by * other.tangential, torque += by * other.torque;
  }
};

class Model {
 public:
  Model(const EndMill& mill, const ForceCoefficients& material, std::span<const EngagedSlice> slices,
        const ToothFeed& feed)
      : mill_(mill), k_(material), slices_(slices), feed_(feed) {}

  /// Of all teeth, over the time.
  [[nodiscard]] Sum mean() const {
    Sum sum;
    over_edges([&](const EndMill::Place& place, double from, double to, double weight) {
      Sum of;
      add_between(from, to, place, chip_of_feed(place), of);
      sum.add(weight, of);
    });
    return sum;
  }

  /// By how much the mean force changes with the way of the tool since the tooth before, N/mm: a column for each of its
  /// x, y and z.
  [[nodiscard]] Eigen::Matrix3d change() const {
    Eigen::Matrix3d columns = Eigen::Matrix3d::Zero();
    over_edges([&](const EndMill::Place& place, double from, double to, double weight) {
      const std::array ways{Chip{place.sin_k, 0, 0}, Chip{0, place.sin_k, 0}, Chip{0, 0, -place.cos_k}};
      for (std::size_t i = 0; i < ways.size(); ++i) {
        Sum of;
        add_between(from, to, place, ways[i], of);
        columns.col(static_cast<Eigen::Index>(i)) += weight * of.force;
      }
    });
    return columns;
  }

  /// Of all teeth, the lowest point of one of them at this angle.
  [[nodiscard]] Sum at(double angle) const {
    Sum sum;
    for (int tooth = 0; tooth < mill_.teeth(); ++tooth) {
      const double lowest = angle + 2 * pi * tooth / mill_.teeth();
      for (const EngagedSlice& slice : slices_) {
        for (const Arc& arc : slice.arcs) add_tooth(slice, arc, lowest, sum);
      }
    }
    return sum;
  }

  /// Angles of the tool to look at within a pitch of its teeth.
  [[nodiscard]] std::vector<double> positions() const {
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

  /// mm³ for each turn.
  [[nodiscard]] double chip_mm3() const {
    // A material that gives 1 N/mm² of torque for each chip alone.
    const ForceCoefficients unit{.ktc = 1, .krc = 0, .kac = 0, .kte = 0, .kre = 0, .kae = 0};
    return 2 * pi * Model(mill_, unit, slices_, feed_).mean().torque;
  }

 private:
  [[nodiscard]] double chip(const EndMill::Place& place, double angle) const {
    return feed_.across_mm * std::sin(angle) * place.sin_k - feed_.along_mm * place.cos_k;
  }

  /// Calls `visit(from, to)` for pieces of the profile between two heights on which nothing turns far.
  template <class Visit>
  void along_profile(double low_mm, double high_mm, double most_turned, Visit&& visit) const {
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

  /// Calls `visit(place, from, to, weight)` for places of the edges and the angles at which there is a chip; with their
  /// weights they make a mean over a turn, of all teeth.
  template <class Visit>
  void over_edges(Visit&& visit) const {
    const double most_turned = feed_.along_mm == 0 ? kMostTurned : kMostTurnedObliquely;
    const double share = mill_.teeth() / (2 * pi);
    for (const EngagedSlice& slice : slices_) {
      along_profile(slice.from_mm, slice.to_mm, most_turned, [&](double from, double to) {
        for (const auto& [part, weight] : kGauss) {
          const EndMill::Place place = mill_.at(from + part * (to - from));
          const auto at_place = [&](double entry, double exit) {
            visit(place, entry, exit, share * weight * (to - from));
          };
          for (const Arc& arc : slice.arcs) over_chips(place, arc, at_place);
        }
      });
    }
  }

  [[nodiscard]] Sum on_tool(const EndMill::Place& place, double angle, double t, double r, double a) const {
    const double s = std::sin(angle), c = std::cos(angle);
    Sum sum;
    sum.force = {-t * c - (r * place.sin_k + a * place.cos_k) * s, t * s - (r * place.sin_k + a * place.cos_k) * c,
                 r * place.cos_k - a * place.sin_k};
    sum.tangential = t;
    sum.torque = t * place.radius_mm;
    return sum;
  }

  /// How thick a chip is along the angle φ: so much of its sine, so much of its cosine, and a level.
  struct Chip {
    double sine = 0, cosine = 0, level = 0;
  };
  [[nodiscard]] Chip chip_of_feed(const EndMill::Place& place) const {
    return {feed_.across_mm * place.sin_k, 0, -feed_.along_mm * place.cos_k};
  }

  /// Of one tooth at one place, for each millimetre of profile, integrated between two angles.
  void add_between(double from, double to, const EndMill::Place& place, const Chip& chip, Sum& sum) const {
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

  /// Calls `visit(from, to)` for the angles of an arc at which the feed leaves a chip.
  template <class Visit>
  void over_chips(const EndMill::Place& place, const Arc& arc, Visit&& visit) const {
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

  /// What one tooth gives in an arc of a slice.
  void add_tooth(const EngagedSlice& slice, const Arc& arc, double lowest, Sum& sum) const {
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
      along_profile(low, high, kMostTurned, [&](double from, double to) { add_piece(from, to, lowest, sum); });
    }
  }

  /// A piece so short that the chip begins or ends at most once on it.
  void add_piece(double from, double to, double lowest, Sum& sum) const {
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
      const double angle = lowest - mill_.lag_per_mm() * place.z_mm, h = std::max(0.0, chip(place, angle)),
                   edge = place.edge_per_profile;
      sum.add(weight * (to - from), on_tool(place, angle, k_.ktc * h + k_.kte * edge, k_.krc * h + k_.kre * edge,
                                            k_.kac * h + k_.kae * edge));
    }
  }

  const EndMill& mill_;
  ForceCoefficients k_;
  std::span<const EngagedSlice> slices_;
  ToothFeed feed_;
};

std::optional<std::string> problem(const EndMill& mill, std::span<const EngagedSlice> slices, const ToothFeed& feed,
                                   double spindle_rpm) {
  if (!(spindle_rpm > 0)) return "the spindle stands: without its speed there is no feed per tooth";
  const double most = mill.radius_mm();
  if (!(feed.across_mm >= 0 && feed.across_mm <= most && std::abs(feed.along_mm) <= most)) {
    return fmt::format(
        "the feed per tooth is {:g} mm across and {:g} mm along the tool's axis; allowed is 0 to its radius, {:g} mm: "
        "is the feed in mm/s, and the spindle's speed in rpm?",
        feed.across_mm, feed.along_mm, most);
  }
  for (const EngagedSlice& slice : slices) {
    if (slice.to_mm <= mill.cutting_length_mm() + kSlack_mm) continue;
    return fmt::format("the cut is {:g} mm deep, and the tool cuts up to LCF, {:g} mm", slice.to_mm,
                       mill.cutting_length_mm());
  }
  return std::nullopt;
}

void look(OverTurn& over, double value) {
  if (std::abs(value) > std::abs(over.peak)) over.peak = value;
}

}  // namespace

Expected<TurnForces> forces_over_turn(const EndMill& mill, const ForceCoefficients& material,
                                      std::span<const EngagedSlice> slices, const ToothFeed& feed, double spindle_rpm) {
  if (auto wrong = problem(mill, slices, feed, spindle_rpm)) {
    return failure(MinorCode::InvalidParameterValue, std::move(*wrong));
  }
  constexpr double kMillimetres = 1e3;
  const double per_second = 2 * pi * spindle_rpm / 60;
  const Model model(mill, material, slices, feed);
  TurnForces forces;
  const Sum mean = model.mean();
  forces.tangential_n.mean = mean.tangential;
  forces.x_n.mean = mean.force[0], forces.y_n.mean = mean.force[1], forces.z_n.mean = mean.force[2];
  forces.total_n.mean = mean.force.norm();
  forces.torque_nm.mean = mean.torque / kMillimetres;
  for (const double angle : model.positions()) {
    const Sum now = model.at(angle);
    look(forces.tangential_n, now.tangential);
    look(forces.x_n, now.force[0]), look(forces.y_n, now.force[1]), look(forces.z_n, now.force[2]);
    look(forces.total_n, now.force.norm());
    look(forces.torque_nm, now.torque / kMillimetres);
  }
  forces.power_w = {forces.torque_nm.mean * per_second, forces.torque_nm.peak * per_second};
  return forces;
}

Expected<Eigen::Matrix3d> chip_stiffness(const EndMill& mill, const ForceCoefficients& material,
                                         std::span<const EngagedSlice> slices, const ToothFeed& feed) {
  constexpr double kAnySpeed_rpm = 1;
  if (auto wrong = problem(mill, slices, feed, kAnySpeed_rpm)) {
    return failure(MinorCode::InvalidParameterValue, std::move(*wrong));
  }
  const ForceCoefficients of_chips{.ktc = material.ktc, .krc = material.krc, .kac = material.kac};
  return Model(mill, of_chips, slices, feed).change();
}

double removal_rate_mm3_s(const EndMill& mill, std::span<const EngagedSlice> slices, const ToothFeed& feed,
                          double spindle_rpm) {
  return Model(mill, {}, slices, feed).chip_mm3() * spindle_rpm / 60;
}

}  // namespace rmac::gateway
