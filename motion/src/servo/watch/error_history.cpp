#include "servo/watch/error_history.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {

namespace {

constexpr std::size_t kLeast = 3;    // samples: less may be a word that came late
constexpr double kGrowsBy = 0.02;    // of the bound, in a sample: one word that is wrong makes one step
constexpr double kStaysShare = 0.5;  // of what it was to go: less, and something holds it
constexpr double kLeastWay = 0.05;   // mm or degrees: sound joints stand for so much where friction turns round
constexpr double kFar = 0.25;        // of the error: what stands beside its setpoint trembles
constexpr double kRunsOn = 0.9;      // as in WrongDirection: less, and the effort holds it better and better

}  // namespace

ErrorHistory::ErrorHistory(double period_s, double sample_s) noexcept
    : cycles_a_sample_(std::max(1, static_cast<int>(std::lround(sample_s / period_s)))), period_s_(period_s) {}

// The latest sample is that of the latest cycle; it is kept where its turn has come.
void ErrorHistory::step(const ResponseSeen& seen) noexcept {
  const bool keeps = kept_ == 0 || ++cycle_ >= cycles_a_sample_;
  if (keeps) {
    next_ = (next_ + 1) % kMost;
    kept_ = std::min(kept_ + 1, kMost);
    cycle_ = 0;
  }
  samples_[(next_ + kMost - 1) % kMost] = {seen.position, seen.position_set, seen.effort};
}

std::size_t ErrorHistory::wanted_since(double bound) const noexcept {
  std::size_t samples = std::min(kLeast, kept_ - 1);
  while (samples + 1 < kept_ && std::abs(ago(0).position_set - ago(samples).position_set) < bound) ++samples;
  return samples;
}

double ErrorHistory::wanted(double bound) const noexcept {
  return kept_ < 2 ? 0 : ago(0).position_set - ago(wanted_since(bound)).position_set;
}
double ErrorHistory::duration_s(double bound) const noexcept {
  return kept_ < 2 ? 0 : static_cast<double>(wanted_since(bound)) * cycles_a_sample_ * period_s_;
}
double ErrorHistory::gone() const noexcept {
  return kept_ < 2 ? 0 : ago(0).position - ago(kept_ - 1).position;
}

// In each third of the time it goes further away from its setpoint, against its effort, and by more and more.
bool ErrorHistory::runs_away() const noexcept {
  const std::size_t third = (kept_ - 1) / 3;
  if (third == 0) return false;
  const double error = ago(0).position_set - ago(0).position;
  const double before = ago(3 * third).position_set - ago(3 * third).position;
  std::array<double, 3> ways{};
  for (std::size_t k = 0; k < 3; ++k) ways[k] = ago(k * third).position - ago((k + 1) * third).position;
  const double away = error < 0 ? 1 : -1;
  const auto& [last, middle, first] = ways;
  // The weight of what hangs is in both.
  const double pushes = ago(0).effort - ago(3 * third).effort;
  const bool against = pushes * away < 0 || (pushes == 0 && ago(0).effort * away < 0);
  const bool leaves = std::abs(error) - std::abs(before) > kStaysShare * std::abs(last + middle + first);
  const bool far = std::abs(last + middle + first) > kFar * std::abs(error);
  return against && far && leaves && first * away > -kStaysShare * last * away && last * away > 0 &&
         (middle - first) * away > 0 && (last - middle) * away >= kRunsOn * (middle - first) * away;
}

// What is held swings against what holds it: now, or on average, more than before. The weight of what hangs is
// in all of them.
bool ErrorHistory::pushes(std::size_t since, double error) const noexcept {
  if (ago(0).effort * error > 0) return true;
  double sum = 0;
  for (std::size_t k = 0; k < since; ++k) sum += ago(k).effort;
  return (sum / static_cast<double>(since) - ago(since).effort) * error > 0;
}

// One word that is wrong makes one step, from an error as it was before.
bool ErrorHistory::is_no_step(std::size_t since, double bound) const noexcept {
  const auto error_ago = [this](std::size_t k) { return std::abs(ago(k).position_set - ago(k).position); };
  const bool grows = error_ago(0) > error_ago(1) && error_ago(1) > error_ago(2) + kGrowsBy * bound;
  const double before = std::max(error_ago(1), error_ago(2));
  return grows || before > std::max(kStaysShare * bound, error_ago(since) + kGrowsBy * bound);
}

ErrorHistory::Cause ErrorHistory::cause(double bound) const noexcept {
  if (kept_ <= kLeast) return Cause::Unknown;
  if (runs_away()) return Cause::WrongDirection;
  const std::size_t since = wanted_since(bound);
  const double wanted = ago(0).position_set - ago(since).position_set;
  const double went = ago(0).position - ago(since).position;
  const double error = ago(0).position_set - ago(0).position;
  const bool behind = error * wanted > 0 && std::abs(wanted) > std::max(kStaysShare * bound, kLeastWay);
  if (behind && pushes(since, error) && is_no_step(since, bound) && went * wanted < kStaysShare * wanted * wanted)
    return Cause::StandsStill;
  return Cause::Unknown;
}

}  // namespace rmac
