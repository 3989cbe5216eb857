#pragma once

#include <vector>

#include "rmac/motion/servo/cogging.hpp"

namespace rmac {

/// Cogging, arranged so that a cycle has little to reckon. Real-time safe but for what makes it.
class CoggingMap {
 public:
  static constexpr int kHighestOrder = 1000;

  CoggingMap() = default;
  /// Orders of 1 to `kHighestOrder`.
  explicit CoggingMap(const Cogging& cogging);

  [[nodiscard]] bool empty() const noexcept { return harmonics_.empty(); }
  /// In the drive's sense, where the shaft has made so many turns.
  [[nodiscard]] double torque_nm(double turns) const noexcept;

 private:
  std::vector<Cogging::Harmonic> harmonics_;  ///< with orders of `base_`
  int base_ = 1;                              ///< the order that divides all of them: of slots and poles, more than 1
  int highest_ = 1;
};

}  // namespace rmac
