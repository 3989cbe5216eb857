#pragma once

#include <vector>

#include "gateway/tools/tool.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// How a tool gives way at its tip, alike in all directions across its axis.
struct ToolBending {
  double compliance_mm_n = 0;  ///< at rest
  std::vector<TipMode> modes;
};

/// The modes of its `Shape` as they were measured; or those of a beam that is clamped where the holder begins, of its
/// sections and what its body is made of: Timoshenko's, flutes as thick as 0.8 of DC (L. Kops, D. T. Vo, Determination
/// of the equivalent diameter of an end mill based on its compliance, CIRP Annals 39/1, 1990), the three lowest, each
/// with 2 % of critical damping, which is assumed. Refused, with what to give, where neither stands there, and where
/// nothing of it sticks out of its holder.
[[nodiscard]] Expected<ToolBending> bending_of(const Tool& tool);

}  // namespace rmac::gateway
