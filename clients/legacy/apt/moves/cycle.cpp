#include "clients/legacy/apt/moves/cycle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "clients/legacy/apt/moves/feeds.hpp"

namespace rmac::apt {

namespace {

constexpr double kMostDwell_s = 3600;

/// Reads the words of one CYCLE into it.
class CycleWords {
 public:
  CycleWords(Arguments& arguments, const Coordinates& coordinates) : arguments_(arguments), coordinates_(coordinates) {}

  Cycle read() {
    read_type();
    if (arguments_.has_number()) set(depth_, length("the depth"), "the depth");
    while (!arguments_.done()) read_part();
    return checked();
  }

 private:
  void read_type() {
    static constexpr std::array<std::string_view, 6> kPlain{"DRILL", "FACE", "SPOT", "CBORE", "CSINK", "SPTDRL"};
    const std::string& type = arguments_.word("a type as DRILL");
    cycle_.comes_up_at_feed = type == "BORE" || type == "REAM";
    if (type == "TAP" || type == "THREAD") {
      refuse(arguments_.last_place(),
             fmt::format("CYCLE/{} needs a feed by the spindle's angle, by which the appliance moves nothing", type));
    }
    if (type == "DEEP" || type == "BRKCHP") {
      set_pecks(type);
    } else if (!cycle_.comes_up_at_feed && std::ranges::find(kPlain, type) == kPlain.end()) {
      refuse(arguments_.last_place(),
             fmt::format("CYCLE/{} is not taken; have the CAM system write its moves instead of the cycle", type));
    }
    if (cycle_.pecks == Cycle::Pecks::None && !cycle_.comes_up_at_feed) {
      for (const std::string_view pecks : {"DEEP", "BRKCHP"}) {
        if (arguments_.take(pecks)) set_pecks(pecks);
      }
    }
  }

  void set_pecks(std::string_view type) {
    cycle_.pecks = type == "DEEP" ? Cycle::Pecks::Clearing : Cycle::Pecks::Breaking;
  }

  void read_part() {
    if (read_feed() || read_lengths()) return;
    if (arguments_.take("DWELL")) {
      set(cycle_.dwell_s, arguments_.number("seconds"), "DWELL");
      if (!(*cycle_.dwell_s >= 0 && *cycle_.dwell_s <= kMostDwell_s))
        refuse(arguments_.last_place(), "a dwell is 0 to 3600 seconds");
    } else if (arguments_.take("RTRCTO") || arguments_.take("RETURN")) {
      read_return();
    } else if (arguments_.has_number()) {
      read_bare_number();
    } else {
      arguments_.end();
    }
  }

  /// A unit and a feed, or FEED and a feed with or without its unit.
  bool read_feed() {
    const bool named = arguments_.take("FEED");
    auto unit = take_feed_unit(arguments_, coordinates_);
    if (!named && !unit) return false;
    const double value = arguments_.number("a feed");
    const std::size_t place = arguments_.last_place();
    if (!unit) unit = take_feed_unit(arguments_, coordinates_);
    set_feed(value * unit.value_or(coordinates_.unit_mm(place)), place);
    return true;
  }

  void set_feed(double mm_min, std::size_t place) {
    if (!legacy::is_feed(mm_min)) refuse(place, "the feed is not within 0.01 and 1 000 000 mm/min");
    set(cycle_.feed_mm_min, mm_min, "the feed");
  }

  bool read_lengths() {
    if (arguments_.take("DEPTH")) {
      set(depth_, length("the depth"), "the depth");
    } else if (arguments_.take("FEDTO")) {
      set(depth_, -length("where the hole ends, below 0"), "the depth");
    } else if (arguments_.take("STEP") || arguments_.take("INCR")) {
      set(peck_, length("the depth of a peck"), "the peck");
    } else if (arguments_.take("CLEAR")) {
      set(clear_, length("how far above the hole rapid ends"), "CLEAR");
    } else if (arguments_.take("RAPTO")) {
      set(rapid_to_, length("how far above the hole rapid ends"), "RAPTO");
    } else {
      return false;
    }
    return true;
  }

  void read_return() {
    if (arguments_.take("AUTO")) {
      cycle_.returns_to_where_it_began = true;
      return;
    }
    set(cycle_.return_mm, length("how far above the hole the tool goes back"), "RETURN");
    if (*cycle_.return_mm <= 0)
      refuse(arguments_.last_place(), "RETURN,0 means a plane that no CL file tells; write how far above the hole");
  }

  /// A feed, where its unit stands behind it; behind the feed, how far above the hole rapid ends.
  void read_bare_number() {
    const double value = arguments_.number("a number");
    const std::size_t place = arguments_.last_place();
    if (!cycle_.feed_mm_min) {
      if (const auto unit = take_feed_unit(arguments_, coordinates_)) return set_feed(value * *unit, place);
    }
    if (!cycle_.feed_mm_min || clear_)
      refuse(place,
             "which of the cycle's numbers this is, no word before it tells; write DEPTH, FEED, CLEAR and so on");
    clear_ = coordinates_.mm(value, place);
  }

  double length(std::string_view expected) {
    const double value = arguments_.number(expected);
    return coordinates_.mm(value, arguments_.last_place());
  }

  void set(std::optional<double>& value, double number, std::string_view what) const {
    if (value) refuse(arguments_.last_place(), fmt::format("{} is said twice", what));
    value = number;
  }

  Cycle checked() {
    const std::size_t place = arguments_.place();
    if (!depth_ || !(*depth_ > 0)) {
      refuse(place, "CYCLE needs the hole's depth, more than 0 below the GOTO of its top (DEPTH,d; FEDTO,-d)");
    }
    if (clear_ && rapid_to_) {
      refuse(place, "CLEAR and RAPTO: CAM systems do not agree on which ends rapid; write only the one that does");
    }
    if (!clear_) clear_ = rapid_to_;
    if (!clear_ || !(*clear_ >= 0)) refuse(place, "CYCLE needs CLEAR, how far above the hole rapid ends: 0 or more");
    const bool pecks = cycle_.pecks != Cycle::Pecks::None;
    if (pecks && !(peck_ && *peck_ > 0)) refuse(place, "CYCLE needs STEP, the depth of a peck: more than 0");
    if (!pecks && peck_) refuse(place, "STEP of a cycle that does not peck; write DEEP or BRKCHP");
    if (cycle_.return_mm && *cycle_.return_mm < *clear_) refuse(place, "RETURN is not above where rapid ends");
    cycle_.depth_mm = *depth_;
    cycle_.clear_mm = *clear_;
    cycle_.peck_mm = peck_.value_or(0);
    return cycle_;
  }

  Arguments& arguments_;
  const Coordinates& coordinates_;
  Cycle cycle_;
  std::optional<double> depth_, clear_, rapid_to_, peck_;
};

}  // namespace

Cycle cycle_of(Arguments& arguments, const Coordinates& coordinates) {
  return CycleWords(arguments, coordinates).read();
}

}  // namespace rmac::apt
