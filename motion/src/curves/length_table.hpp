#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace rmac::curves {

/// The parameter of a curve as a function of its arc length, by pieces of Chebyshev polynomials
/// (docs/derivations/curves.md, section 4). Immutable once built; `locate` is real-time safe.
class LengthTable {
 public:
  /// Speed of the curve, |dC/dt|, at t in a span.
  using Speed = std::function<double(std::size_t span, double t)>;
  /// A place where the speed vanishes, or the length cannot be inverted to the accuracy promised.
  struct Flaw {
    std::size_t span = 0;
    double t = 0;
  };
  struct Place {
    std::size_t span = 0;
    double t = 0;
  };

  /// Appends the span [0, width]; spans are added in order. `least_speed` is what counts as standing still. A flaw
  /// leaves the table unusable.
  [[nodiscard]] std::optional<Flaw> add_span(std::size_t span, double width, double least_speed, const Speed& speed);

  [[nodiscard]] double length() const noexcept { return length_; }
  /// Arc lengths at which the pieces begin.
  [[nodiscard]] std::span<const double> starts() const noexcept { return starts_; }
  /// Where arc length s lies; on a border between pieces `side` < 0 chooses the one that ends there.
  [[nodiscard]] Place locate(double s, int side) const noexcept;

 private:
  static constexpr std::size_t kDegree = 9;
  struct Piece {
    double middle_s;
    double inverse_half;                ///< 1 / half of the piece's length
    double width;                       ///< of the span
    std::array<double, kDegree + 1> t;  ///< by powers of the place on the piece, from -1 to 1
    std::uint32_t span;
  };
  struct Span;
  [[nodiscard]] std::optional<Flaw> add(const Span& span, double from, double to, int depth);

  std::vector<double> starts_;  ///< arc length at which each piece begins, apart from the pieces for the search's sake
  std::vector<Piece> pieces_;
  double length_ = 0;
};

}  // namespace rmac::curves
