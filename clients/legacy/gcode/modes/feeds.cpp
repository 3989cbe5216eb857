#include "clients/legacy/gcode/modes/feeds.hpp"

namespace rmac::gcode {

namespace {

void set_mode(const Block& block, Modes& modes) {
  constexpr int kInverseTime = 930;
  modes.moves_per_min = 0;
  const auto& mode = block.g(GGroup::Feed);
  if (!mode || (mode->number == kInverseTime) == modes.inverse_time) return;
  modes.inverse_time = !modes.inverse_time;
  modes.feed_mm_min = 0;
}

}  // namespace

void set_feed(Block& block, const std::optional<double>& unit, const Rules& rules, Modes& modes) {
  set_mode(block, modes);
  const Word* feed = block.find('F');
  if (feed == nullptr) return;
  if (modes.inverse_time) {
    if (!(feed->value > 0)) refuse(feed->place, "F under G93 is how many such moves a minute has, more than 0");
    modes.moves_per_min = feed->value;
    return;
  }
  if (feed->value < 0) refuse(feed->place, "a negative feed");
  // By the report's table F comes before the unit.
  const bool in_new_unit = unit && (rules.unit_ends_feed || !modes.unit_is_said);
  const double counted = in_new_unit ? *unit : modes.unit(feed->place);
  modes.feed_mm_min = modes.feed(*feed, counted);
  modes.feed_degrees_min = modes.feed_mm_min / counted;
}

}  // namespace rmac::gcode
