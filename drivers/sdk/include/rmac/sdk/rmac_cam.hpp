#pragma once

#include "rmac/sdk/cam/cmm_moves.hpp"
#include "rmac/sdk/cam/cycle_control.hpp"
#include "rmac/sdk/cam/frame_settings.hpp"
#include "rmac/sdk/cam/joint_forces.hpp"
#include "rmac/sdk/cam/joint_settings.hpp"
#include "rmac/sdk/cam/move_queue.hpp"
#include "rmac/sdk/cam/parking.hpp"
#include "rmac/sdk/cam/path_settings.hpp"
#include "rmac/sdk/cam/positioning.hpp"
#include "rmac/sdk/cam/program_flow.hpp"
#include "rmac/sdk/cam/spindle_control.hpp"

namespace rmac::sdk {

/// The RMAC_CAM interface (dissertation 4.5, Appendix IV): motion and control commands, and the machine's answers, part
/// by part. Units are the wire's: mm, deg, mm/min, rpm. Gateway thread only. Measuring is rmac/sdk/measuring.hpp.
class RmacCam {
 public:
  virtual ~RmacCam() = default;

  [[nodiscard]] virtual CycleControl& cycle() = 0;
  [[nodiscard]] virtual MoveQueue& queue() = 0;
  [[nodiscard]] virtual CmmMoves& cmm_moves() = 0;
  [[nodiscard]] virtual PathSettings& path() = 0;
  [[nodiscard]] virtual JointSettings& joints() = 0;
  [[nodiscard]] virtual FrameSettings& frames() = 0;
  [[nodiscard]] virtual SpindleControl& spindles() = 0;
  [[nodiscard]] virtual Positioning& positioning() = 0;
  [[nodiscard]] virtual Parking& parking() = 0;
  [[nodiscard]] virtual JointForces& forces() = 0;
  [[nodiscard]] virtual ProgramFlow& flow() = 0;
};

}  // namespace rmac::sdk
