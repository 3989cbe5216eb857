#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rmac::fieldbus {

/// What a control interface implements beside its port when its drives have error codes of their own in place of CiA
/// 402's.
class FaultTexts {
 public:
  virtual ~FaultTexts() = default;
  /// A drive's error code in words. Off the cycle; does not change while the interface lives.
  [[nodiscard]] virtual std::string fault_text(std::size_t axis, std::uint16_t error_code) const = 0;
};

/// What an interface, of drives or of I/O, implements beside its port when it can say why `exchange` fails.
class ExchangeFaultText {
 public:
  virtual ~ExchangeFaultText() = default;
  /// What is wrong, and what to do. Any thread but the servo thread.
  [[nodiscard]] virtual std::string fault_text() const = 0;
};

/// What a control interface implements beside its port when it may know why a drive counts as silent.
class SilenceText {
 public:
  virtual ~SilenceText() = default;
  /// What is wrong with the drive that does not answer, or did not last, and what to do; nothing where that is unknown.
  /// Any thread but the servo thread.
  [[nodiscard]] virtual std::optional<std::string> silence_text(std::size_t axis) const = 0;
};

/// What a control interface implements beside its port when it may have started with less than it asked for.
class StartNotes {
 public:
  virtual ~StartNotes() = default;
  /// One sentence each, of the last start. On the thread that starts it.
  [[nodiscard]] virtual std::vector<std::string> start_notes() const = 0;
};

}  // namespace rmac::fieldbus
