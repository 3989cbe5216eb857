#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <variant>

#include "rmac/fieldbus/modbus/line_report.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::fieldbus::modbus {

inline constexpr std::size_t kAddresses = 65536;  ///< of each table

/// The four tables of a slave (Modbus Application Protocol V1.1b3, 4.3).
enum class Table : std::uint8_t { Coils, DiscreteInputs, InputRegisters, HoldingRegisters };

[[nodiscard]] constexpr bool of_bits(Table table) noexcept {
  return table == Table::Coils || table == Table::DiscreteInputs;
}
[[nodiscard]] constexpr bool writable(Table table) noexcept {
  return table == Table::Coils || table == Table::HoldingRegisters;
}
[[nodiscard]] const char* to_string(Table table) noexcept;

/// A slave or a gateway on the network. The address is numeric (IPv4 or IPv6): looking a name up has no deadline.
struct TcpEndpoint {
  std::string address;
  std::uint16_t port = 502;
};

/// A serial line. Eight data bits, as RTU has them.
struct RtuEndpoint {
  std::string device;  ///< "/dev/ttyUSB0"
  int bit_rate = 9600;
  char parity = 'N';  ///< N, E or O
  int stop_bits = 1;
};

using Endpoint = std::variant<TcpEndpoint, RtuEndpoint>;

/// "127.0.0.1 port 502", "/dev/ttyUSB0".
[[nodiscard]] std::string to_string(const Endpoint& endpoint);

/// Why a transaction gave nothing.
struct Failure {
  enum class Kind : std::uint8_t {
    BadRequest,    ///< nothing was sent: the request breaks the protocol's bounds
    NotConnected,  ///< nothing was sent
    InDoubt,       ///< a read was not sent, or an answer to a write cannot be trusted; see `Client`
    Timeout,       ///< no whole answer within the deadline
    WrongAnswer,   ///< of another slave, function or length, or with a wrong checksum
    Exception,     ///< the slave refuses; `exception_code` says why
    Disconnected,  ///< the peer or the serial port went away
  };
  Kind kind = Kind::Timeout;
  int exception_code = 0;
  std::string message;  ///< what was asked, of whom, and what came of it

  /// The slave answers, and asks for patience: exceptions 5 and 6 (V1.1b3, 7).
  [[nodiscard]] bool busy() const noexcept {
    return kind == Kind::Exception && (exception_code == 5 || exception_code == 6);
  }
};

template <typename T = void>
using Answer = tl::expected<T, Failure>;

using Clock = std::chrono::steady_clock;
/// The time that a line lives by. What waits for the kernel, as a transaction does for its deadline, has the kernel's.
using Now = std::function<Clock::time_point()>;

/// One Modbus line, TCP or RTU, over one libmodbus context: that frames, checks sums and waits; whether an answer is
/// the one to the question is checked here (libmodbus 3.1.6 looks neither at a TCP answer's unit nor at what a write
/// echoes).
///
/// Deadline: a transaction, or `connect`, ends within `deadline` of its begin, whatever the peer does. libmodbus is
/// told no byte timeout, so that its response timeout bounds the whole answer, however slowly the bytes drip.
///
/// Late answers: after anything but an answer or a slave's exception a TCP connection is closed, and what comes late
/// goes down with it. An RTU line has no connection and its frames no numbers, so a late answer would be taken for the
/// next one's. Therefore the slave is *in doubt* from then on: no read is sent to it and no answer to a write believed
/// until `resynchronise` got the answer to a question of a length that no other question had within `kSettle`. A slave
/// answers in the order in which it is asked, hence all that was late has come by then. For the same reason an
/// exception casts no doubt where there was none, but for a gateway's, whose slave may still answer.
///
/// It belongs to one thread. Never on the servo thread.
class Client {
 public:
  /// Checks the endpoint and opens nothing. The error names what is wrong in it.
  [[nodiscard]] static Expected<std::unique_ptr<Client>> create(Endpoint endpoint, std::chrono::milliseconds deadline,
                                                                Now now = Clock::now);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  [[nodiscard]] bool connected() const noexcept;
  [[nodiscard]] Clock::time_point now() const;
  /// Connects anew. Does not try again by itself.
  Answer<> connect();
  void disconnect() noexcept;

  /// Reads `values.size()` values; bits come as 0 and 1. Returns when the question was sent: the values are at least as
  /// new as that.
  Answer<Clock::time_point> read(int slave, Table table, std::uint16_t address, std::span<std::uint16_t> values);
  /// Writes one value with function 5 or 6, several with 15 or 16. In doubt it is sent all the same, so that a stop
  /// gets through, and fails with `InDoubt` whatever is answered.
  Answer<> write(int slave, Table table, std::uint16_t address, std::span<const std::uint16_t> values);

  [[nodiscard]] bool in_doubt(int slave) const noexcept;
  /// Asks for `count` values or some more: their answer ends the doubt. `count` must be above that of any read of this
  /// slave. Devices may refuse so many; an exception does not tell which question it belongs to, so it ends the doubt
  /// only where the slave was asked nothing for `kSettle` before, and until then this fails without asking (one that is
  /// busy is asked on: it does not refuse the length). It fails likewise when it was called so often that no length is
  /// left. Nothing happens where there is no doubt.
  Answer<> resynchronise(int slave, Table table, std::uint16_t address, std::size_t count);

  /// What passed with a unit since the client was made. Any thread but the servo thread.
  [[nodiscard]] UnitTraffic traffic(int unit) const;

  /// No slave on a serial line answers later than this after it was asked.
  static constexpr std::chrono::seconds kSettle{2};

 private:
  struct Impl;
  explicit Client(std::unique_ptr<Impl> impl) noexcept;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rmac::fieldbus::modbus
