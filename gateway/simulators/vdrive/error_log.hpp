#pragma once

#include <cstdint>

#include "gateway/simulators/vdrive/objects/dictionary.hpp"

namespace rmac::vdrive {

/// The errors of a node as its dictionary tells them: the error register (1001h) and the list of the latest (1003h)
/// (CiA 301, 7.5.2.2 and 7.5.2.3).
class ErrorLog {
 public:
  explicit ErrorLog(Dictionary& dictionary) : dictionary_(dictionary) {}

  /// An error came up; 0: all are gone.
  void note(std::uint16_t code);
  /// The communication was reset. What is wrong with it ends; what is wrong with the drive does not.
  void reset_communication(bool drive_is_faulty);
  /// Empties the list.
  void clear_list();
  /// The data of an emergency message.
  [[nodiscard]] Bytes emergency(std::uint16_t code) const;

 private:
  Dictionary& dictionary_;
  std::uint16_t register_ = 0;
};

}  // namespace rmac::vdrive
