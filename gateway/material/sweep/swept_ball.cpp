#include "gateway/material/sweep/swept_ball.hpp"

#include <cmath>
#include <cstring>

namespace rmac::gateway {

/// `on_part` of four lines at once, without a branch: what differs from line to line is chosen, not jumped to.
struct SweptBall::Lines::Rows {
  static constexpr std::size_t kLanes = 4;
  using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));

  [[gnu::always_inline]] static inline void root_of_positive(Lanes& x) noexcept {
    x = x > 0 ? x : Lanes{};
    for (std::size_t i = 0; i < kLanes; ++i) x[i] = std::sqrt(x[i]);
  }

  [[gnu::always_inline]] static inline void meet(const Lines& l, const double* first, double second, double begin,
                                                 double end, double* from, double* to) noexcept {
    const Lanes none{}, low_end = none + begin, high_end = none + end;
    Lanes u;
    std::memcpy(&u, first, sizeof u);
    u = u - l.first_;
    const double v = second - l.second_;
    const Lanes dot = u * l.way_first_ + v * l.way_second_, beside = u * l.way_second_ - v * l.way_first_;
    const Lanes under = l.radius2_ - beside * beside * l.per_across2_;
    const Lanes middle = dot * l.way_along_ * l.per_across2_;
    Lanes half = under * l.length2_ * l.per_across2_;
    root_of_positive(half);
    const Lanes low = (dot + (middle - half) * l.way_along_) * l.per_length2_;
    const Lanes high = (dot + (middle + half) * l.way_along_) * l.per_length2_;
    const auto low_before = low<begin, low_behind = low> end, high_before = high<begin, high_behind = high> end;
    const Lanes low_at = low_before ? low_end : low_behind ? high_end : low;
    const Lanes high_at = high_before ? low_end : high_behind ? high_end : high;
    const Lanes low_u = u - low_at * l.way_first_, low_v = v - low_at * l.way_second_;
    const Lanes high_u = u - high_at * l.way_first_, high_v = v - high_at * l.way_second_;
    const Lanes low_half2 = l.radius2_ - low_u * low_u - low_v * low_v;
    Lanes low_half = low_half2, high_half = l.radius2_ - high_u * high_u - high_v * high_v;
    root_of_positive(low_half);
    root_of_positive(high_half);
    // With both beyond the same end the ball there is all that can be met.
    const auto one_end = (low_before & high_before) | (low_behind & high_behind);
    const auto missed = (under <= 0) | (one_end & (low_half2 <= 0));
    Lanes a = l.along_ + ((low_before | low_behind) ? low_at * l.way_along_ - low_half : middle - half);
    Lanes b = l.along_ + ((high_before | high_behind) ? high_at * l.way_along_ + high_half : middle + half);
    a = missed ? none + RowMet::kNever : a;
    b = missed ? none - RowMet::kNever : b;
    std::memcpy(from, &a, sizeof a);
    std::memcpy(to, &b, sizeof b);
  }

  [[gnu::always_inline]] static inline void meet(const Lines& lines, const RayRow& row, double begin, double end,
                                                 RowMet& met) noexcept {
    for (std::size_t i = 0; i < RayRow::kRays; i += kLanes) {
      meet(lines, row.first.data() + i, row.second, begin, end, met.from.data() + i, met.to.data() + i);
    }
  }

#ifdef __x86_64__
  /// Debian's amd64 has registers for two.
  [[gnu::target("avx2")]] static void meet_with_avx2(const Lines& lines, const RayRow& row, double begin, double end,
                                                     RowMet& met) noexcept {
    meet(lines, row, begin, end, met);
  }
#endif
};

void SweptBall::Lines::on_part(const RayRow& row, double begin, double end, RowMet& met) const noexcept {
  if (per_across2_ == 0) {
    for (std::size_t i = 0; i < RayRow::kRays; ++i) {
      if (!on_part(row.first[i], row.second, begin, end, met.from[i], met.to[i])) met.none(i);
    }
    return;
  }
#ifdef __x86_64__
  static const bool kHasAvx2 = __builtin_cpu_supports("avx2") != 0;
  if (kHasAvx2) {
    Rows::meet_with_avx2(*this, row, begin, end, met);
    return;
  }
#endif
  Rows::meet(*this, row, begin, end, met);
}

}  // namespace rmac::gateway
