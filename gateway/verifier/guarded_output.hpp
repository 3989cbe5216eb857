#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace rmac::verifier {

/// Lends a call an output of its own, between guard words, in place of its caller's: what is written before its
/// beginning or beyond its end shows, and spoils nothing.
class GuardedOutput {
 public:
  /// What goes beyond the guards, too, hits nobody.
  GuardedOutput() { words_.reserve(4096); }
  /// As large as `output`, with what is in it.
  [[nodiscard]] std::span<double> lend(std::span<const double> output) {
    const std::size_t size = output.size() + 2 * kGuards;
    if (words_.size() != size) words_.assign(size, std::bit_cast<double>(kGuard));
    std::copy(output.begin(), output.end(), words_.begin() + kGuards);
    return std::span(words_).subspan(kGuards, output.size());
  }
  /// What the call wrote into what was lent.
  void give_back(std::span<double> output) const noexcept {
    std::copy_n(words_.begin() + kGuards, output.size(), output.begin());
  }
  [[nodiscard]] bool overrun() const noexcept {
    const auto touched = [](double word) { return std::bit_cast<std::uint64_t>(word) != kGuard; };
    return std::any_of(words_.begin(), words_.begin() + kGuards, touched) ||
           std::any_of(words_.end() - kGuards, words_.end(), touched);
  }

 private:
  static constexpr std::ptrdiff_t kGuards = 32;
  static constexpr std::uint64_t kGuard = 0x7ff0'dead'beef'0001;  ///< no number that anything computes

  std::vector<double> words_;
};

}  // namespace rmac::verifier
