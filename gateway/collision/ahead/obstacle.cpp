#include "gateway/collision/ahead/obstacle.hpp"

#include <fmt/format.h>

#include "rmac/motion/move_name.hpp"

namespace rmac::gateway {

std::string described(const Obstacle& obstacle) {
  const std::string move = move_name(obstacle.move_id);
  if (obstacle.first.empty())
    return fmt::format("{}: its joints are not known on the way, so that it is not run", move);
  const auto& p = obstacle.place;
  const std::string bodies = fmt::format("{} and {}", obstacle.first, obstacle.second);
  const std::string place =
      fmt::format("at {:.3f}, {:.3f}, {:.3f} mm in the part frame of the set-up", p[0], p[1], p[2]);
  if (obstacle.at_begin) {
    return fmt::format(
        "{}: {} meet where the machine stands, {:.3f} mm deep, {}; drop what is queued (StopNow), switch "
        "the check off (SetCollisionCheck), and part them, or send the set-up as it is",
        move, bodies, obstacle.depth_mm, place);
  }
  const std::string how = obstacle.depth_mm > 0 ? fmt::format("would meet, {:.3f} mm deep,", obstacle.depth_mm)
                                                : std::string("would come nearer than the clearance");
  return fmt::format("{}: {} {} {}; the machine comes to rest {:.3f} mm into the move, where they are {:.3f} mm apart",
                     move, bodies, how, place, obstacle.s_mm, obstacle.distance_mm);
}

}  // namespace rmac::gateway
