#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "rmac/fieldbus/modbus/client.hpp"

namespace rmac::fieldbus::modbus {

using Bytes = std::vector<std::uint8_t>;

/// A slave of the test's own making, on a TCP port or behind a pseudo-terminal, which answers as badly as it is told
/// to. It shares no protocol code with the client.
class ModbusPeer {
 public:
  enum class Manner {
    Honest,
    Silent,       ///< never answers
    Dripping,     ///< one byte each `pause`
    Late,         ///< each whole answer after `pause`
    WrongId,      ///< as another slave
    WrongLength,  ///< a header that counts other bytes than come, another number each time (TCP)
    Busy,         ///< exception 6 for every request
    Garbage,      ///< bytes of a seeded generator
    Resetting     ///< closes the line in place of an answer (TCP resets it)
  };
  enum class Wire { Tcp, Rtu };

  /// A request as it came: slave, function, data.
  using Responder = std::function<Bytes(const Bytes& request)>;

  explicit ModbusPeer(Wire wire);
  ~ModbusPeer();
  ModbusPeer(const ModbusPeer&) = delete;
  ModbusPeer& operator=(const ModbusPeer&) = delete;

  [[nodiscard]] Endpoint endpoint() const;

  void behave(Manner manner, std::chrono::microseconds pause = {});
  /// What is answered: slave, function, data. By default reads of registers give the number of the request, counted
  /// from 1, in every register, and writes are confirmed.
  void respond(Responder responder);
  /// Goes away for good: the port closes, or the pseudo-terminal hangs up.
  void vanish();

  [[nodiscard]] std::uint64_t requests() const noexcept { return requests_; }
  /// The requests so far, oldest first, and forgets them.
  [[nodiscard]] std::vector<Bytes> take_requests();
  /// Blocks until a request came that `wanted` accepts; false after a minute.
  bool wait_for(const std::function<bool(const Bytes&)>& wanted);

 private:
  void run();
  void serve(int descriptor);
  [[nodiscard]] std::optional<Bytes> read_request(int descriptor, Bytes& header);
  [[nodiscard]] bool read_exactly(int descriptor, std::uint8_t* to, std::size_t count);
  [[nodiscard]] bool wait_readable(int descriptor);
  [[nodiscard]] bool pause_for(std::chrono::microseconds pause);
  [[nodiscard]] bool answer(int descriptor, const Bytes& header, const Bytes& request);
  [[nodiscard]] Bytes frame(const Bytes& header, const Bytes& pdu);
  [[nodiscard]] std::uint32_t next_noise();
  [[nodiscard]] Bytes default_answer(const Bytes& request) const;

  Wire wire_;
  int listener_ = -1;  ///< or the master side of the pseudo-terminal
  int slave_side_ = -1;
  int end_ = -1;  ///< an event: the thread is to end
  std::uint16_t port_ = 0;
  std::string device_;
  std::atomic<Manner> manner_{Manner::Honest};
  std::atomic<std::int64_t> pause_us_{0};
  std::atomic<std::uint64_t> requests_{0};
  std::mutex mutex_;
  std::condition_variable_any came_;
  Responder responder_;
  std::vector<Bytes> seen_;
  std::uint32_t noise_ = 1;
  std::thread thread_;
};

/// CRC-16 of RTU frames (Modbus over Serial Line V1.02, 6.2.2), low byte first on the wire.
[[nodiscard]] std::uint16_t modbus_crc(const Bytes& bytes);

}  // namespace rmac::fieldbus::modbus
