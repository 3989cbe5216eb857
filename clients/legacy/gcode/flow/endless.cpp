#include "clients/legacy/gcode/flow/endless.hpp"

#include <fmt/format.h>

#include "clients/legacy/gcode/blocks/refusal.hpp"

namespace rmac::gcode {

void Endless::come_again(std::size_t place) {
  const Made made = made_();
  if (made.bytes > bounds_.output_mb * 1'000'000)
    refuse(place, fmt::format(
                      "the program became more than {} MB here and goes on; end this loop, or those around it, sooner, "
                      "or give --output-limit if it is to be that long",
                      bounds_.output_mb));
  if (made.moves != moves_) {
    moves_ = made.moves;
    lines_at_move_ = lines_;
  } else if (lines_ - lines_at_move_ > bounds_.idle_lines) {
    refuse(place, fmt::format("{} lines were carried out without a move, and it goes on: this loop, or one around it, "
                              "does not end",
                              bounds_.idle_lines));
  }
}

}  // namespace rmac::gcode
