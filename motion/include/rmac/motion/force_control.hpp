#pragma once

#include <cstdint>

namespace rmac {

/// How a joint keeps a contact force (docs/servo.md, "Force"). Forces are what the joint pushes with, in N or N·m,
/// positive towards larger positions; mm and s, or degrees and s.
struct ForceControl {
  double approach_speed = 0;  ///< until there is contact
  double contact_force = 0;   ///< from which on there is contact; below half of it there is none any more
  double gain = 0;          ///< at most this speed a unit of force error, mm/(s·N); 0: what the part's stiffness takes
  double reset_time_s = 0;  ///< of the integral part, or longer where the loop takes longer; 0: as long as that takes
  double max_speed = 0;     ///< in contact
  double max_force = 0;     ///< beyond it, either way, the machine stops
  double max_search = 0;    ///< way that the joint may go without contact before the machine stops
  double max_acceleration = 0;
  double mass = 0;       ///< effort an acceleration of the joint takes, N·s²/mm; 0: nobody knows
  double stiffness = 0;  ///< of the stiffest part that it comes upon, N/mm; 0: any
};

/// Where a joint under force control is.
enum class ContactState : std::uint8_t {
  None,         ///< the joint's position is controlled
  Holding,      ///< no force is wanted: it holds its position
  Approaching,  ///< on its way to contact
  Touching,     ///< in contact, its force is controlled
};

[[nodiscard]] const char* to_string(ContactState state) noexcept;

}  // namespace rmac
