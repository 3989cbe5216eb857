#include "clients/legacy/rs274/blocks/control_names.hpp"

#include <algorithm>
#include <array>

namespace rmac::rs274 {

namespace {

struct Entry {
  std::string_view word;
  ControlName name = ControlName::Unknown;
};

constexpr auto kNames = std::to_array<Entry>({
    {"_A"},
    {"_ABSOLUTE", ControlName::Absolute},
    {"_ADAPTIVE_FEED", ControlName::AdaptiveFeed},
    {"_B"},
    {"_C"},
    {"_CALL_LEVEL", ControlName::CallLevel},
    {"_CCOMP"},
    {"_COORD_SYSTEM", ControlName::CoordinateSystem},
    {"_CURRENT_POCKET"},
    {"_CURRENT_TOOL", ControlName::CurrentTool},
    {"_FEED", ControlName::Feed},
    {"_FEED_HOLD", ControlName::FeedHold},
    {"_FEED_OVERRIDE", ControlName::FeedOverride},
    {"_FLOOD", ControlName::Flood},
    {"_IJK_ABSOLUTE_MODE", ControlName::AbsoluteCentres},
    {"_IMPERIAL", ControlName::Imperial},
    {"_INCREMENTAL", ControlName::Incremental},
    {"_INVERSE_TIME", ControlName::InverseTime},
    {"_LATHE_DIAMETER_MODE", ControlName::LatheDiameter},
    {"_LATHE_RADIUS_MODE", ControlName::LatheRadius},
    {"_LINE", ControlName::Line},
    {"_METRIC", ControlName::Metric},
    {"_MIST", ControlName::Mist},
    {"_MOTION_MODE", ControlName::MotionMode},
    {"_PLANE", ControlName::Plane},
    {"_REMAP_LEVEL"},
    {"_RETRACT_OLD_Z", ControlName::RetractToOldZ},
    {"_RETRACT_R_PLANE", ControlName::RetractToR},
    {"_RPM", ControlName::Rpm},
    {"_SELECTED_POCKET"},
    {"_SELECTED_TOOL", ControlName::SelectedTool},
    {"_SPEED_OVERRIDE", ControlName::SpeedOverride},
    {"_SPINDLE_CSS_MODE", ControlName::SpindleCssMode},
    {"_SPINDLE_CW", ControlName::SpindleClockwise},
    {"_SPINDLE_ON", ControlName::SpindleOn},
    {"_SPINDLE_RPM_MODE", ControlName::SpindleRpmMode},
    {"_TASK", ControlName::Task},
    {"_TOOL_OFFSET", ControlName::ToolOffset},
    {"_U"},
    {"_UNITS_PER_MINUTE", ControlName::UnitsPerMinute},
    {"_UNITS_PER_REV", ControlName::UnitsPerTurn},
    {"_V"},
    {"_VMAJOR"},
    {"_VMINOR"},
    {"_W"},
    {"_X", ControlName::X},
    {"_Y", ControlName::Y},
    {"_Z", ControlName::Z},
});
static_assert(std::ranges::is_sorted(kNames, {}, &Entry::word));

}  // namespace

std::optional<ControlName> control_name(std::string_view name) noexcept {
  const auto* found = std::ranges::lower_bound(kNames, name, {}, &Entry::word);
  return found != kNames.end() && found->word == name ? std::optional(found->name) : std::nullopt;
}

}  // namespace rmac::rs274
