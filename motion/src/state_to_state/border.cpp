#include "state_to_state/border.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {
namespace {

/// The place between `low` and `high`, where f changes from below zero to above it, by Newton's method kept inside of
/// a shrinking bracket. f gives its value and slope.
template <typename Function>
double rising_root(double low, double high, double guess, Function&& f) noexcept {
  constexpr int kMostSteps = 80;
  double x = guess;
  for (int i = 0; i < kMostSteps; ++i) {
    const auto [value, slope] = f(x);
    if (value == 0) return x;
    (value < 0 ? low : high) = x;
    double next = x - value / slope;
    const bool newton = next >= low && next <= high && i < 12;  // false for a NaN
    if (!newton) next = 0.5 * (low + high);
    // A small step of Newton's method leaves an error of its square.
    if (std::abs(next - x) <= (newton ? 1e-11 : 1e-16) * std::abs(x) || next == low || next == high) return next;
    x = next;
  }
  return x;
}

struct ValueSlope {
  double value, slope;
};

}  // namespace

Border::Border(const Transfer& transfer, const Durations& durations, Part part) noexcept : x_(transfer) {
  const bool before = part == Part::BeforeGap;
  const double start = settled_velocity(x_.v0, x_.a0), end = settled_velocity(x_.v1, -x_.a1);
  reversed_ = before ? x_.a0 > 0 : end > start;
  if (reversed_) x_ = x_.reversed();
  has_plateau_ = !before;
  has_early_ = before || (!durations.gap() && x_.a0 < 0 && end != start);

  const double gain = x_.v1 - x_.v0;
  if (has_early_) {
    k_ = 0.5 * (x_.a1 * x_.a1 - x_.a0 * x_.a0) - gain;
    early_end_ = before ? -root(gain + 0.5 * (x_.a0 * x_.a0 + x_.a1 * x_.a1)) : 0.0;
    early_end_ = std::max(early_end_, x_.a0);
    early_end_duration_ = early(early_end_).duration;
  }
  v_from_ = x_.v0 - 0.5 * x_.a0 * x_.a0;
  v_to_ = x_.v1 - 0.5 * x_.a1 * x_.a1;
  offset_ = -x_.a0 * (v_from_ + x_.a0 * x_.a0 / 6) + x_.a1 * (v_to_ + x_.a1 * x_.a1 / 6);
  w_begin_ = std::max(x_.a0, 0.0);
  w_end_ = std::max(root(x_.v_top - v_from_), w_begin_);
}

Border::Early Border::early(double peak) const noexcept {
  Early e{};
  const double unbounded = root(peak * peak + k_);
  const double depth = std::max(std::min(unbounded, x_.a_bottom), -std::min(peak, x_.a1));
  e.trough = -depth;
  if (unbounded > x_.a_bottom) e.dwell = (unbounded * unbounded - depth * depth) / x_.a_bottom;
  const double t1 = peak - x_.a0, t2 = peak - e.trough, t4 = x_.a1 - e.trough;
  e.duration = t1 + t2 + e.dwell + t4;
  const double v_peak = x_.v0 + 0.5 * (peak * peak - x_.a0 * x_.a0);
  const double v_trough = v_peak + 0.5 * (peak * peak - depth * depth);
  e.distance = t1 * (x_.v0 + t1 * (x_.a0 / 2 + t1 / 6)) + t2 * (v_peak + t2 * (peak / 2 - t2 / 6)) +
               e.dwell * (v_trough - 0.5 * depth * e.dwell) + t4 * (x_.v1 + t4 * (-x_.a1 / 2 + t4 / 6));
  e.rate = v_peak + 0.5 * peak * t2;
  e.slope = depth > 0 ? e.rate * 2 * (1 + peak / depth) : 0;
  return e;
}

Border::Plateau Border::plateau(double w) const noexcept {
  const double v = v_from_ + w * w;
  const double z = root(v - v_to_);
  const double a_up = std::min(w, x_.a_top), a_down = std::min(z, x_.a_bottom);
  const double t_up = w <= x_.a_top ? 2 * w : x_.a_top + w * w / x_.a_top;
  const double t_down = z <= x_.a_bottom ? 2 * z : x_.a_bottom + z * z / x_.a_bottom;
  const double up = w <= x_.a_top ? 1.0 : w / x_.a_top;
  const double down = a_down > 0 ? w / a_down : 1.0;
  return {t_up + t_down - x_.a0 + x_.a1, 0.5 * ((v_from_ + v) * t_up + (v_to_ + v) * t_down) + offset_,
          2 * (v * (up + down) + 0.5 * (up * a_up * a_up + down * a_down * a_down))};
}

/// w when the rise from v_from_ and the fall to v_to_ take t together (eq. 11).
double Border::plateau_peak(double t) const noexcept {
  if (!(t > 0)) return 0;
  const double difference = v_from_ - v_to_;  // w² + difference is the same for the fall
  const double top = x_.a_top, bottom = x_.a_bottom;
  const double none = 0.5 * (0.5 * t - 2 * difference / t);
  if (none <= top && none * none + difference <= bottom * bottom) return none;
  const double fall = root(difference + t * top) - top;  // the rise alone dwells
  if (fall <= bottom && fall * fall - difference >= top * top) return root(fall * fall - difference);
  const double rise = root(t * bottom - difference) - bottom;  // the fall alone dwells
  if (rise <= top && rise * rise + difference >= bottom * bottom) return rise;
  return root((t - top - bottom - difference / bottom) / (1 / top + 1 / bottom));
}

Border::Place Border::begin() const noexcept {
  return has_early_ ? Place{Place::Kind::Early, x_.a0} : Place{Place::Kind::Plateau, w_begin_};
}

Border::Place Border::at_duration(double duration) const noexcept {
  if (has_early_ && (duration < early_end_duration_ || !has_plateau_)) {
    const double q = duration + x_.a0 - x_.a1;
    double peak = 0.5 * (0.5 * q - 2 * k_ / q);
    if (peak * peak + k_ > x_.a_bottom * x_.a_bottom) peak = root(q * x_.a_bottom - k_) - x_.a_bottom;
    if (!std::isfinite(peak)) peak = x_.a0;
    return {Place::Kind::Early, std::clamp(peak, x_.a0, early_end_)};
  }
  const double w = std::max(plateau_peak(duration + x_.a0 - x_.a1), w_begin_);
  if (w < w_end_) return {Place::Kind::Plateau, w};
  return {Place::Kind::Cruise, std::max(duration - plateau(w_end_).duration, 0.0)};
}

double Border::distance(const Place& place) const noexcept {
  if (place.kind == Place::Kind::Early) return early(place.value).distance;
  if (place.kind == Place::Kind::Plateau) return plateau(place.value).distance;
  return plateau(w_end_).distance + (v_from_ + w_end_ * w_end_) * place.value;
}

double Border::duration(const Place& place) const noexcept {
  if (place.kind == Place::Kind::Early) return early(place.value).duration;
  if (place.kind == Place::Kind::Plateau) return plateau(place.value).duration;
  return plateau(w_end_).duration + place.value;
}

/// Where the rate of the distance is smallest (eq. 10).
double Border::slowest_peak() const noexcept {
  const double dwelling = -0.25 * x_.a_bottom;
  if (dwelling * dwelling + k_ >= x_.a_bottom * x_.a_bottom) return std::clamp(dwelling, x_.a0, early_end_);
  if (!(k_ > 0)) return early_end_;
  constexpr double kRatio = 0.26794919243112270647;  // 2 - √3
  double peak = -kRatio * root(k_ / (1 - kRatio * kRatio));
  // Dwelling ends before its own smallest rate, and behind it the rate rises.
  if (peak * peak + k_ > x_.a_bottom * x_.a_bottom) peak = -root(x_.a_bottom * x_.a_bottom - k_);
  return std::clamp(peak, x_.a0, early_end_);
}

std::optional<Border::Place> Border::first_early(double distance, double from) const noexcept {
  const auto f = [&](double peak) {
    const Early e = early(peak);
    return ValueSlope{e.distance - distance, e.slope};
  };
  const auto found = [&](double low, double high) {
    return Place{Place::Kind::Early, rising_root(low, high, 0.5 * (low + high), f)};
  };
  const double slowest = std::max(slowest_peak(), from);
  double falls_to = from;  // below `distance`, and the border rises from there, or falls and rises
  if (early(slowest).rate < 0 && early(from).rate > 0) {
    // It rises, falls, and rises again: the top of the first rise.
    const double top = rising_root(from, slowest, 0.5 * (from + slowest), [&](double peak) {
      return ValueSlope{-early(peak).rate, 0.0};
    });
    if (f(top).value >= 0) return found(from, top);
    falls_to = slowest;
  }
  if (f(early_end_).value >= 0) return found(falls_to, early_end_);
  return std::nullopt;
}

std::optional<Border::Place> Border::first_reaching(double distance, const Place& from) const noexcept {
  if (from.kind == Place::Kind::Cruise) {
    const double cruise = v_from_ + w_end_ * w_end_;
    return Place{Place::Kind::Cruise, (distance - plateau(w_end_).distance) / cruise};
  }
  if (from.kind == Place::Kind::Early) {
    if (auto place = first_early(distance, from.value)) return place;
    if (!has_plateau_) return std::nullopt;
  }
  const Plateau fastest = plateau(w_end_);
  if (fastest.distance <= distance) {
    return Place{Place::Kind::Cruise, (distance - fastest.distance) / (v_from_ + w_end_ * w_end_)};
  }
  // On the plateau the border is convex in time (eq. 12): below it at one end, above at the other, it passes once.
  const double low = from.kind == Place::Kind::Plateau ? from.value : w_begin_;
  const double below = std::max(distance - plateau(low).distance, 0.0);
  const double share = below / (below + fastest.distance - distance);
  const double guess = low + (w_end_ - low) * std::sqrt(share);
  return Place{Place::Kind::Plateau, rising_root(low, w_end_, guess, [&](double w) {
                 const Plateau p = plateau(w);
                 return ValueSlope{p.distance - distance, p.slope};
               })};
}

Phases Border::phases(const Place& place) const noexcept {
  Phases result;
  if (place.kind == Place::Kind::Early) {
    const Early e = early(place.value);
    result.add(place.value - x_.a0, 1);
    result.add(place.value - e.trough, -1);
    result.add(e.dwell, 0);
    result.add(x_.a1 - e.trough, 1);
  } else {
    const bool cruises = place.kind == Place::Kind::Cruise;
    const double w = cruises ? w_end_ : place.value;
    const double z = root(v_from_ + w * w - v_to_);
    const double up = std::max(std::min(w, x_.a_top), x_.a0), down = std::max(std::min(z, x_.a_bottom), -x_.a1);
    result.add(up - x_.a0, 1);
    if (w > x_.a_top) result.add((w * w - up * up) / x_.a_top, 0);
    result.add(up, -1);
    if (cruises) result.add(place.value, 0);
    result.add(down, -1);
    if (z > x_.a_bottom) result.add((z * z - down * down) / x_.a_bottom, 0);
    result.add(x_.a1 + down, 1);
  }
  if (reversed_) result.reverse();
  return result;
}

}  // namespace rmac
