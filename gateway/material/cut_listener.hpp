#pragma once

#include <Eigen/Core>

#include "gateway/collision/finding.hpp"
#include "gateway/material/dexel_grid.hpp"
#include "gateway/material/sweep/stroke_maker.hpp"

namespace rmac::gateway {

/// Hears, every so far, where the tool goes while its cutting part may take material away.
class CutListener {
 public:
  virtual ~CutListener() = default;
  /// `tool` moves by `velocity` (mm/s, part frame, of its tip, a mean over the last `steady_s`; not 0), and what it
  /// passed until then is gone.
  virtual void cuts(const DexelGrid& grid, const ToolAt& tool, const Eigen::Vector3d& velocity, double t_s,
                    const MoveNow& move) = 0;
  /// So much was taken away, mm³, before the next `cuts` or the end.
  virtual void takes(double mm3) noexcept = 0;
  /// How far the tool goes until it is told again, mm.
  [[nodiscard]] virtual double every_mm() const = 0;
  [[nodiscard]] virtual double steady_s() const { return 0; }
};

}  // namespace rmac::gateway
