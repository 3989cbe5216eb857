#pragma once

#include <vector>

#include "rmac/motion/joint_mechanics.hpp"

namespace rmac {

/// Notches and a low-pass between a servo law and its drive, second-order sections one after the other, each with a
/// gain of 1 for steady efforts. Sections come from their Laplace forms by the bilinear transform, bent so that the
/// frequency in question stays where it is.
class EffortFilter {
 public:
  EffortFilter(const JointMechanics& mechanics, double period_s);

  /// As if `effort` had been there for ever.
  void engage(double effort) noexcept;
  [[nodiscard]] double update(double effort) noexcept;

 private:
  /// y = b0 x0 + b1 x1 + b2 x2 - a1 y1 - a2 y2
  struct Section {
    double b0, b1, b2, a1, a2;
    double x1 = 0, x2 = 0, y1 = 0, y2 = 0;
  };
  void add(double frequency_hz, double period_s, double zero_damping, double pole_damping, bool notch);

  std::vector<Section> sections_;
};

}  // namespace rmac
