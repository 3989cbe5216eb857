#include "clients/legacy/apt/moves/feeds.hpp"

#include <array>
#include <string_view>

namespace rmac::apt {

std::optional<double> take_feed_unit(Arguments& arguments, const Coordinates& coordinates) {
  static constexpr std::array<std::string_view, 6> kRefused{"MMPR", "IPR", "PERREV", "FPR", "INVERS", "FRN"};
  for (const std::string_view word : kRefused) {
    if (arguments.take(word)) {
      refuse(arguments.last_place(),
             "feed is in mm or inch a minute here, not by the turn of the spindle or the share of the way");
    }
  }
  if (arguments.take("MMPM")) return 1;
  if (arguments.take("IPM")) return 25.4;
  if (arguments.take("PERMIN")) return coordinates.unit_mm(arguments.last_place());
  return std::nullopt;
}

double feed_of(Arguments& arguments, const Coordinates& coordinates, std::optional<double>& unit) {
  auto said = take_feed_unit(arguments, coordinates);
  const double value = arguments.number("a feed");
  const std::size_t place = arguments.last_place();
  if (!said) said = take_feed_unit(arguments, coordinates);
  arguments.end();
  if (said) unit = said;
  const double mm_min = value * (unit ? *unit : coordinates.unit_mm(place));
  if (!legacy::is_feed(mm_min)) refuse(place, "the feed is not within 0.01 and 1 000 000 mm/min");
  return mm_min;
}

}  // namespace rmac::apt
