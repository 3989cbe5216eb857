#include "gateway/record/setpoint_record.hpp"

#include <fmt/format.h>

#include <iterator>

namespace rmac::gateway {

void append_columns(const char* name, std::size_t count, std::string& out) {
  for (std::size_t i = 1; i <= count; ++i) fmt::format_to(std::back_inserter(out), ",{}{}", name, i);
}

void append_numbers(std::span<const double> values, std::string& out) {
  for (const double value : values) fmt::format_to(std::back_inserter(out), ",{}", value);
}

void append_setpoint_header(std::size_t joints, bool measured, std::string& out) {
  out += "t_s,move_id,s_mm,feed_mm_s,x,y,z,i,j,k";
  for (const char* setpoint : {"q", "qd", "qdd"}) append_columns(setpoint, joints, out);
  if (!measured) return;
  for (const char* seen : {"a", "error"}) append_columns(seen, joints, out);
}

void append_setpoint_row(const SetpointRow& row, std::string& out) {
  fmt::format_to(std::back_inserter(out), "{},{},{},{}", row.t_s, row.move_id, row.s_mm, row.feed_mm_s);
  for (const auto& values :
       {row.pose, row.position_set, row.velocity_set, row.acceleration_set, row.position, row.following_error}) {
    append_numbers(values, out);
  }
}

}  // namespace rmac::gateway
