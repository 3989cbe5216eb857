#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace rmac::gateway {

/// One cycle of a setpoint record: CSV with a header, one row a cycle, every number with all its digits. mm, deg, s;
/// feed in mm/s.
struct SetpointRow {
  double t_s = 0;
  std::int64_t move_id = 0;
  double s_mm = 0, feed_mm_s = 0;
  std::span<const double> pose;  ///< x y z i j k of the setpoint, part frame
  std::span<const double> position_set, velocity_set, acceleration_set;
  std::span<const double> position;         ///< measured; empty where no drives ran
  std::span<const double> following_error;  ///< where the joint was wanted when that was measured, minus `position`
};

/// Appends the columns' names, without an end of line: more columns may follow.
void append_setpoint_header(std::size_t joints, bool measured, std::string& out);
void append_setpoint_row(const SetpointRow& row, std::string& out);

/// Appends `,name1,name2,…`.
void append_columns(const char* name, std::size_t count, std::string& out);
/// Appends `,value,value,…`.
void append_numbers(std::span<const double> values, std::string& out);

}  // namespace rmac::gateway
