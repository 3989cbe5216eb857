#include "clients/legacy/gcode/flow/extent.hpp"

#include <fmt/format.h>

#include "clients/legacy/gcode/blocks/refusal.hpp"

namespace rmac::gcode {

namespace {

void require_main(std::size_t place, const std::string& running) {
  if (!running.empty())
    refuse(place, fmt::format("the file ends within {}, which M99 is to end; it may be cut off", running));
}

}  // namespace

bool Extent::mark(const std::string& running) {
  if (begun_ && !marked_) refuse(0, "a % in a program that did not begin with one");
  if (marked_) require_main(0, running);
  ended_ = marked_;
  marked_ = true;
  return ended_;
}

void Extent::require_end(std::size_t place, const std::string& running) const {
  require_main(place, running);
  if (ends_anyhow_) return;
  refuse(place, marked_ ? "the program ends without its second %; it may be cut off: write that, or give --assume-end"
                        : "the program ends without M30 or M2; it may be cut off: write M2, or give --assume-end");
}

}  // namespace rmac::gcode
