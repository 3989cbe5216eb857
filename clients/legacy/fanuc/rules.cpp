#include "clients/legacy/fanuc/rules.hpp"

#include "clients/legacy/fanuc/work_systems.hpp"

namespace rmac::fanuc {

namespace {

constexpr gcode::Rules kRules{
    .system_of = system_of,
    .system_name = system_name,
    .set_coordinates = set_coordinates,
    .radius_is_offset = true,
    .reference_is_zero = true,
    .motion_outlives_cycles = true,
    .stops_behind_motion = true,
    .spindle_needs_speed = true,
    .unit_ends_feed = true,
    .degrees_are_lengths = true,
    .further_in_force = 54.1,
    .whole_dwell_s = 1e-3,
    .cycles = {.repeats = "KL",
               .may_wait = true,
               .words_stay = true,
               .dwell_is_free = true,
               .cross_first = true,
               .bore_to_r = true,
               .may_turn = true,
               .levels_stay = true},
};

constexpr gcode::Rules kHaasRules = [] {
  gcode::Rules rules = kRules;
  rules.system_name = haas_system_name;
  rules.further_in_force = 0;
  rules.stops_switch_off = true;
  rules.cycles.repeats = "L";
  rules.cycles.may_peck_less = true;
  return rules;
}();

}  // namespace

const gcode::Rules& rules(Dialect dialect) noexcept {
  return dialect == Dialect::Haas ? kHaasRules : kRules;
}

}  // namespace rmac::fanuc
