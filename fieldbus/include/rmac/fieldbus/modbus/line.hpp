#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rmac/fieldbus/modbus/client.hpp"

namespace rmac::fieldbus::modbus {

/// One slave of a line, as the line's thread serves it.
class Station {
 public:
  virtual ~Station() = default;
  [[nodiscard]] virtual int slave() const noexcept = 0;
  /// One round: reads what is watched, writes what was asked for. Line's thread.
  virtual Answer<> serve(Client& client) = 0;
  /// The line was opened anew, or an answer was lost: nothing that was written before counts as done. Line's thread.
  virtual void forget() noexcept = 0;
  /// Writes the safe state, whatever was asked for; tried a few times. Line's thread, at the end.
  virtual Answer<> make_safe(Client& client) = 0;
};

struct LineConfig {
  Endpoint endpoint;
  std::chrono::milliseconds deadline{200};  ///< of a transaction, and of connecting
  std::chrono::milliseconds period{50};     ///< between the begins of two rounds, where they do not take longer
  std::chrono::milliseconds first_pause{
      100};  ///< before a line that broke is opened again; doubles until a device answers
  std::chrono::milliseconds longest_pause{5000};
  Now now = Clock::now;
};

/// What a line went through since it was started.
struct LineCounters {
  std::uint64_t rounds = 0;     ///< of all stations
  std::uint64_t failures = 0;   ///< rounds of a station that failed
  std::uint64_t connected = 0;  ///< times the line was opened
  // Why rounds failed, or the line was not opened:
  std::uint64_t timeouts = 0;       ///< no answer within the deadline
  std::uint64_t wrong_answers = 0;  ///< another slave's, or spoilt
  std::uint64_t busy = 0;           ///< the slave asked for patience
  std::uint64_t exceptions = 0;     ///< the slave refused for another reason
  std::uint64_t disconnects = 0;    ///< the connection or the port failed
};

/// A Modbus line with the thread that owns it: serves its stations in turn, each round or when woken; opens the line
/// again, with pauses that double, when it broke.
class Line {
 public:
  /// The stations outlive the line.
  Line(LineConfig config, std::vector<Station*> stations);
  ~Line();
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  /// Starts the thread and waits until every station was served once. The error names the first that was not, how long
  /// was waited, and why.
  [[nodiscard]] Expected<> start(std::chrono::milliseconds patience);
  /// Makes every station safe and ends the thread. Takes a few deadlines at most, and 3 s more where one is busy.
  void stop() noexcept;

  /// The next round begins at once. Any thread, real-time safe.
  void wake() noexcept;
  [[nodiscard]] LineCounters counters() const noexcept;
  /// Any thread but the servo thread; never while it is started or stopped.
  [[nodiscard]] LineReport report() const;
  /// Why a station was not served last, as it goes on behind "the device", and what the line went through; nothing of
  /// one that was served without trouble for a while. Any thread but the servo thread.
  [[nodiscard]] std::optional<std::string> trouble(std::size_t station) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rmac::fieldbus::modbus
