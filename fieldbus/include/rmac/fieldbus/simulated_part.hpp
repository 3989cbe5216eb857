#pragma once

#include <vector>

#include "rmac/motion/pose.hpp"

namespace rmac::fieldbus {

/// A part on the table and what a probe may be measured on, in the machine frame, mm: blocks less bores, in one place,
/// and spheres that stand by themselves.
struct SimulatedPart {
  struct Block {
    Vector low{}, high{};  ///< corners, before the part is put in its place
  };
  /// A round hole along Z.
  struct Bore {
    double x = 0, y = 0, radius = 0, bottom = 0, top = 0;
  };
  struct Sphere {
    Vector center{};
    double radius = 0;
  };
  Frame place;  ///< of the part; blocks and bores are in its frame
  std::vector<Block> blocks;
  std::vector<Bore> bores;
  std::vector<Sphere> spheres;

  /// Distance of a point from the nearest surface, negative inside: exact outside and on faces. Real-time safe.
  [[nodiscard]] double distance(const Vector& point) const noexcept;
};

/// A touch probe in the spindle, as it really is; the controller has to find out.
struct SimulatedProbe {
  int touch_input = -1;   ///< bit that is on while it is deflected
  int ready_input = -1;   ///< bit that is on while it has power; -1: there is none
  Vector stylus{};        ///< centre of its tip on the tool interface, mm
  double radius = 0;      ///< of the tip, mm
  double bounce_s = 0;    ///< its contact bounces for so long
  double switch_rpm = 0;  ///< spun faster than this and stopped again, it goes on, or off; 0: it is always on
};

}  // namespace rmac::fieldbus
