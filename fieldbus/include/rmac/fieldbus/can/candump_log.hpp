#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "rmac/fieldbus/can/can_port.hpp"

namespace rmac::fieldbus {

/// One line of a file that candump wrote. CANopen is made of data frames alone; the others are told by what they are.
struct LoggedFrame {
  enum class Kind : std::uint8_t {
    Data,      ///< with an 11-bit identifier
    Remote,    ///< a request, with an 11-bit identifier
    Extended,  ///< with a 29-bit identifier, data or remote
    Fd,        ///< CAN FD, and what comes after it
    Error,     ///< of the controller that listened
  };
  Kind kind = Kind::Data;
  std::string interface;
  CanFrame frame;        ///< of Data all of it; of Remote without data. Its stamp is 0 where the line has no time
  std::uint32_t id = 0;  ///< of Extended and Fd the identifier, of Error the classes of linux/can/error.h
};

/// Reads a line as `candump -l` writes it, "(1436509052.249713) can0 181#AABB", or as candump shows it without that,
/// " can0  181   [2]  AA BB", with or without the time in front. What stands behind the data is passed over. Nothing
/// where it is no frame, or half of one.
[[nodiscard]] std::optional<LoggedFrame> read_log_line(std::string_view line);

/// The line of a data frame as `candump -l` writes it, without its end.
[[nodiscard]] std::string to_log_line(const LoggedFrame& logged);
/// Its beginning, of any frame: time and interface.
[[nodiscard]] std::string log_line_head(const LoggedFrame& logged);

/// What a frame is that CANopen does not use: "error frame: bus-off".
[[nodiscard]] std::string foreign_frame_text(const LoggedFrame& logged);

}  // namespace rmac::fieldbus
