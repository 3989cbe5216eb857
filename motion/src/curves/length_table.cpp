#include "length_table.hpp"

#include <algorithm>
#include <limits>

#include "chebyshev.hpp"

namespace rmac::curves {
namespace {

constexpr std::size_t kSpeedDegree = 16;
constexpr int kMaxHalvings = 44;
/// Relative to the piece: what is left out of the speed's series, and how far t(s) may miss s.
constexpr double kSeriesTail = 2e-13;
constexpr double kInverseError = 1e-12;

/// Coefficients of the speed below this part of the first are nothing.
constexpr double kNegligible = 1e-14;

/// Arc length along one piece, as a polynomial of x in [-1, 1] (eq. 8 of the derivation).
struct PieceLength {
  std::array<double, kSpeedDegree + 1> speed{};
  std::array<double, kSpeedDegree + 2> integral{};
  std::size_t terms = 0;  ///< of the speed

  template <std::size_t N>
  [[nodiscard]] std::array<double, N> at(const std::array<double, N>& x) const noexcept {
    return chebyshev_sums<N>({integral.data(), terms + 1}, x);
  }

  /// From the speed; the total.
  double integrate() noexcept {
    terms = speed.size();
    while (terms > 1 && std::abs(speed[terms - 1]) < kNegligible * speed[0]) --terms;
    const auto coefficient = [this](std::size_t k) { return k < terms ? speed[k] : 0.0; };
    for (std::size_t k = 1; k <= terms; ++k) {
      const double before = k == 1 ? 2 * coefficient(0) : coefficient(k - 1);
      integral[k] = (before - coefficient(k + 1)) / (2 * static_cast<double>(k));
    }
    const auto [begin, end] = at(std::array{-1.0, 1.0});
    integral[0] = -begin;
    return end - begin;
  }

  /// Each x where the length is one of `targets`; Newton from a guess, monotone because the speed is positive.
  template <std::size_t N>
  [[nodiscard]] std::optional<std::array<double, N>> inverse(const std::array<double, N>& targets,
                                                             std::array<double, N> x) const noexcept {
    for (int i = 0; i < 30; ++i) {
      const auto lengths = at(x), rates = chebyshev_sums<N>({speed.data(), terms}, x);
      // Convergence is quadratic: the step after one this small would be lost in rounding.
      bool converged = true;
      for (std::size_t j = 0; j < N; ++j) {
        const double step = (targets[j] - lengths[j]) / rates[j];
        x[j] = std::clamp(x[j] + step, -1.0, 1.0);
        converged = converged && std::abs(step) < 1e-9;
      }
      if (converged) return x;
    }
    return std::nullopt;
  }
};

}  // namespace

struct LengthTable::Span {
  std::size_t index;
  double width;
  double least_speed;
  double noise;  ///< rounding in the speed, which no halving takes away
  const Speed& speed;
};

std::optional<LengthTable::Flaw> LengthTable::add_span(std::size_t span, double width, double least_speed,
                                                       const Speed& speed) {
  double fastest = 0;
  for (int i = 0; i <= 4; ++i) fastest = std::max(fastest, speed(span, width * i / 4));
  // A speed this much lower than the rest of its span is a cusp that rounding has filled in.
  const double noise = 8 * std::numeric_limits<double>::epsilon() * fastest;
  return add({span, width, std::max(least_speed, 1e-9 * fastest), noise, speed}, 0, width, 0);
}

std::optional<LengthTable::Flaw> LengthTable::add(const Span& span, double from, double to, int depth) {
  static const Chebyshev<kSpeedDegree> kSpeedNodes;
  static const Chebyshev<kDegree> kNodes;
  const double half = (to - from) / 2;
  const double middle = from + half;
  const auto split = [&]() -> std::optional<Flaw> {
    if (depth == kMaxHalvings) return Flaw{span.index, middle};
    if (auto flaw = add(span, from, middle, depth + 1)) return flaw;
    return add(span, middle, to, depth + 1);
  };

  std::array<double, kSpeedDegree + 1> speeds;
  for (std::size_t j = 0; j <= kSpeedDegree; ++j) {
    const double t = std::clamp(middle + half * kSpeedNodes.node(j), from, to);
    speeds[j] = span.speed(span.index, t);
    if (!(speeds[j] > span.least_speed)) return Flaw{span.index, t};
  }
  PieceLength piece;
  piece.speed = kSpeedNodes.coefficients(speeds);
  const double tail = std::max({std::abs(piece.speed[kSpeedDegree]), std::abs(piece.speed[kSpeedDegree - 1]),
                                std::abs(piece.speed[kSpeedDegree - 2])});
  if (tail > kSeriesTail * piece.speed[0] + span.noise) return split();
  const double total = piece.integrate();
  std::array<double, kDegree - 1> inside, targets;
  for (std::size_t j = 0; j < inside.size(); ++j) {
    inside[j] = kNodes.node(j + 1);
    targets[j] = total * (1 + inside[j]) / 2;
  }
  const auto x = piece.inverse(targets, inside);
  if (!x) return split();
  std::array<double, kDegree + 1> t;
  t.front() = to;
  for (std::size_t j = 0; j < inside.size(); ++j) t[j + 1] = middle + half * (*x)[j];
  t.back() = from;
  const auto inverse = kNodes.powers(kNodes.coefficients(t));
  // Rounding of t alone moves x by eps t / half: no reason to halve again.
  const double allowed =
      kInverseError * total + 4 * std::numeric_limits<double>::epsilon() * to / half * piece.speed[0];
  std::array<double, kDegree> between, reached;
  for (std::size_t j = 0; j < kDegree; ++j) {
    between[j] = (kNodes.node(j) + kNodes.node(j + 1)) / 2;
    reached[j] = (power_sum(inverse, between[j]) - middle) / half;
  }
  const auto lengths = piece.at(reached);
  for (std::size_t j = 0; j < kDegree; ++j) {
    if (!(std::abs(lengths[j] - total * (1 + between[j]) / 2) <= allowed)) return split();
  }

  const double length = total * half;
  if (!(length > 0)) return Flaw{span.index, middle};
  starts_.push_back(length_);
  pieces_.push_back({length_ + length / 2, 2 / length, span.width, inverse, static_cast<std::uint32_t>(span.index)});
  length_ += length;
  return std::nullopt;
}

LengthTable::Place LengthTable::locate(double s, int side) const noexcept {
  // A caller that comes to a border by sums of lengths misses it by rounding, and still means the side it asked for.
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * length_;
  const auto next = std::upper_bound(starts_.begin() + 1, starts_.end(), side < 0 ? s - 2 * rounding : s + rounding);
  const Piece& piece = pieces_[static_cast<std::size_t>(next - starts_.begin()) - 1];
  const double y = std::clamp((s - piece.middle_s) * piece.inverse_half, -1.0, 1.0);
  return {piece.span, std::clamp(power_sum(piece.t, y), 0.0, piece.width)};
}

}  // namespace rmac::curves
