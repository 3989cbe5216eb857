#include "servo/laws/effort_filter.hpp"

#include <cmath>
#include <numbers>

namespace rmac {

EffortFilter::EffortFilter(const JointMechanics& mechanics, double period_s) {
  for (const Resonance& resonance : mechanics.resonances) {
    add(resonance.frequency_hz, period_s, resonance.damping, resonance.width, true);
  }
  if (mechanics.low_pass_hz > 0) add(mechanics.low_pass_hz, period_s, 0, std::numbers::sqrt2 / 2, false);
}

// Notch: (p² + 2 z p + 1) / (p² + 2 d p + 1); low-pass: 1 / (p² + 2 d p + 1); p = (1/w) (q - 1) / (q + 1) with
// w = tan(pi f T), q one cycle ahead.
void EffortFilter::add(double frequency_hz, double period_s, double zero_damping, double pole_damping, bool notch) {
  const double w = std::tan(std::numbers::pi * frequency_hz * period_s);
  const double scale = 1 + 2 * pole_damping * w + w * w;
  Section section{};
  section.a1 = 2 * (w * w - 1) / scale;
  section.a2 = (1 - 2 * pole_damping * w + w * w) / scale;
  if (notch) {
    section.b0 = (1 + 2 * zero_damping * w + w * w) / scale;
    section.b1 = section.a1;
    section.b2 = (1 - 2 * zero_damping * w + w * w) / scale;
  } else {
    section.b0 = section.b2 = w * w / scale;
    section.b1 = 2 * section.b0;
  }
  sections_.push_back(section);
}

void EffortFilter::engage(double effort) noexcept {
  for (Section& section : sections_) section.x1 = section.x2 = section.y1 = section.y2 = effort;
}

double EffortFilter::update(double effort) noexcept {
  for (Section& s : sections_) {
    const double out = s.b0 * effort + s.b1 * s.x1 + s.b2 * s.x2 - s.a1 * s.y1 - s.a2 * s.y2;
    s.x2 = s.x1;
    s.x1 = effort;
    s.y2 = s.y1;
    s.y1 = out;
    effort = out;
  }
  return effort;
}

}  // namespace rmac
