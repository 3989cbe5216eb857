#include "rmac/fieldbus/modbus/client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "modbus/open_line.hpp"
#include "modbus/pdu.hpp"
#include "modbus/unit_record.hpp"

namespace rmac::fieldbus::modbus {
namespace {

using Kind = Failure::Kind;

constexpr int kMostSlave = 247;      // Modbus over Serial Line V1.02, 2.2
constexpr int kAnyUnit = 255;        // a TCP device without a gateway behind it (Messaging on TCP/IP V1.0b, 4.4.2.6)
constexpr std::size_t kProbes = 64;  ///< lengths that a probe can have

std::string error_text(int error) {
  const char* text = strerrordesc_np(error);
  return text != nullptr ? text : fmt::format("error {}", error);
}

/// The length of one of `kProbes` probes: their answers differ in bytes from each other's, and from that to any
/// question below `count`.
std::size_t probe_length(Table table, std::size_t count, std::size_t step) {
  if (of_bits(table)) return 8 * ((count + 6) / 8 + 1 + step);
  return count + step;
}

/// Whether a TCP frame begins with the header of an answer to us: transaction 0, which a raw question has, and nothing
/// answers an earlier one on the same connection; protocol 0; and the bytes that follow. libmodbus looks at none of it.
bool is_header_of(std::span<const std::uint8_t> frame) {
  constexpr std::size_t kBeforeCounted = 6;
  return std::all_of(frame.begin(), frame.begin() + 4, [](auto byte) { return byte == 0; }) &&
         static_cast<std::size_t>(frame[4] << 8 | frame[5]) == frame.size() - kBeforeCounted;
}

/// It speaks for a slave that has not answered it (V1.1b3, 7).
bool from_gateway(int exception_code) noexcept {
  return exception_code == MODBUS_EXCEPTION_GATEWAY_PATH || exception_code == MODBUS_EXCEPTION_GATEWAY_TARGET;
}

}  // namespace

const char* to_string(Table table) noexcept {
  switch (table) {
    case Table::Coils:
      return "coil";
    case Table::DiscreteInputs:
      return "discrete input";
    case Table::InputRegisters:
      return "input register";
    case Table::HoldingRegisters:
      return "holding register";
  }
  return "value";
}

std::string to_string(const Endpoint& endpoint) {
  if (const auto* tcp = std::get_if<TcpEndpoint>(&endpoint)) {
    return fmt::format("{} port {}", tcp->address, tcp->port);
  }
  return std::get<RtuEndpoint>(endpoint).device;
}

struct Client::Impl {
  Impl(Endpoint of, std::chrono::milliseconds within, Now clock)
      : endpoint(std::move(of)), deadline(within), now(std::move(clock)) {}

  /// What is known of a slave on a serial line.
  struct Slave {
    bool doubt = false;
    bool refuses_probes = false;
    Clock::time_point asked{};                ///< last; never: the epoch
    std::vector<Clock::time_point> probed{};  ///< when it was asked for each length of a probe last
  };

  Endpoint endpoint;
  std::chrono::milliseconds deadline;
  Now now;
  Context context{};
  bool open = false;
  std::array<Slave, kAnyUnit + 1> slaves{};
  UnitRecords records{};

  [[nodiscard]] bool serial() const noexcept { return std::holds_alternative<RtuEndpoint>(endpoint); }
  [[nodiscard]] Slave& slave(const Request& request) noexcept {
    return slaves[static_cast<std::size_t>(request.slave) % slaves.size()];
  }

  [[nodiscard]] tl::unexpected<Failure> fail(Kind kind, const Request& request, std::string what, int code = 0) const {
    return tl::unexpected<Failure>(
        {kind, code,
         fmt::format("{}: slave {}, {} {} {}{} from {:04X}h: {}", to_string(endpoint), request.slave,
                     request.writes ? "writing" : "reading", request.count, to_string(request.table),
                     request.count == 1 ? "" : "s", request.address, what)});
  }

  /// Nothing may be sent that breaks the protocol, or that the context could not take.
  [[nodiscard]] Answer<> check(const Request& request) const {
    const bool unit = request.slave > 0 && (request.slave <= kMostSlave || (!serial() && request.slave == kAnyUnit));
    if (!unit) return fail(Kind::BadRequest, request, "slaves are 1 to 247");
    if (request.writes && !writable(request.table)) return fail(Kind::BadRequest, request, "these cannot be written");
    if (request.count == 0 || request.count > most_values(request)) {
      return fail(Kind::BadRequest, request, fmt::format("1 to {} fit into a frame", most_values(request)));
    }
    if (request.address + request.count > kAddresses) {
      return fail(Kind::BadRequest, request, "addresses end at FFFFh");
    }
    if (!open) return fail(Kind::NotConnected, request, "not connected");
    return {};
  }

  [[nodiscard]] Answer<> ask(const Request& request, std::span<const std::uint16_t> written,
                             std::span<std::uint16_t> values) {
    records.asked(request.slave);
    auto answer = transact(request, written, values);
    records.ended(request.slave, answer, now());
    return answer;
  }

  /// Sends what `request` is, and fills `values` where it reads.
  [[nodiscard]] Answer<> transact(const Request& request, std::span<const std::uint16_t> written,
                                  std::span<std::uint16_t> values) {
    modbus_set_slave(context.get(), request.slave);
    // What came since the last answer belongs to no question any more.
    if (serial()) static_cast<void>(modbus_flush(context.get()));
    const std::vector<std::uint8_t> question = encode(request, written);
    slave(request).asked = now();
    if (modbus_send_raw_request(context.get(), question.data(), static_cast<int>(question.size())) < 0) {
      return broken(request, errno);
    }
    std::array<std::uint8_t, MODBUS_MAX_ADU_LENGTH> frame{};
    const int got = modbus_receive_confirmation(context.get(), frame.data());
    if (got < 0) return unanswered(request, errno);
    const auto header = static_cast<std::size_t>(modbus_get_header_length(context.get()));
    const std::size_t checksum = serial() ? 2 : 0;
    const auto size = static_cast<std::size_t>(got);
    if (size < header + checksum + 1) return wrong(request, "another slave answered");
    if (!serial() && !is_header_of(std::span(frame).first(size))) {
      return wrong(request, "the answer's header is another question's or counts other bytes than came");
    }
    const auto answer = std::span(frame).subspan(header - 1, size - checksum - header + 1);
    const Decoded decoded = decode(request, question, answer, values);
    switch (decoded.verdict) {
      case Verdict::Fits:
        return {};
      case Verdict::Exception:
        if (from_gateway(decoded.exception_code)) doubt(request);
        return fail(Kind::Exception, request,
                    fmt::format("refused with exception {}: {}", decoded.exception_code,
                                exception_text(decoded.exception_code)),
                    decoded.exception_code);
      case Verdict::Wrong:
        break;
    }
    return wrong(request,
                 answer[0] == request.slave ? "the answer does not fit the question" : "another slave answered");
  }

  /// libmodbus got no frame that is one.
  [[nodiscard]] tl::unexpected<Failure> unanswered(const Request& request, int error) {
    if (error == EMBBADCRC) return wrong(request, "the answer has a wrong checksum");
    if (error == EMBBADDATA) return wrong(request, "the answer is longer than a frame can be");
    if (error != ETIMEDOUT) return broken(request, error);
    lose_answer(request);
    return fail(Kind::Timeout, request, fmt::format("no whole answer within {} ms", deadline.count()));
  }
  [[nodiscard]] tl::unexpected<Failure> wrong(const Request& request, const char* what) {
    lose_answer(request);
    return fail(Kind::WrongAnswer, request, what);
  }
  [[nodiscard]] tl::unexpected<Failure> broken(const Request& request, int error) {
    close();
    return fail(Kind::Disconnected, request,
                fmt::format("{}: {}", serial() ? "the serial port failed" : "the connection broke", error_text(error)));
  }

  void doubt(const Request& request) noexcept { slave(request).doubt = serial(); }
  void lose_answer(const Request& request) noexcept {
    doubt(request);
    if (!serial()) close();
  }
  void close() noexcept {
    close_line(context.get(), endpoint);
    open = false;
  }
};

Expected<std::unique_ptr<Client>> Client::create(Endpoint endpoint, std::chrono::milliseconds deadline, Now now) {
  if (const std::string wrong = check(endpoint); !wrong.empty()) {
    return failure(MinorCode::InvalidParameterValue, fmt::format("Modbus line {}: {}", to_string(endpoint), wrong));
  }
  if (deadline < std::chrono::milliseconds(1) || deadline > std::chrono::minutes(1)) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("Modbus line {}: a deadline of {} ms; allowed is 1 ms to 1 minute", to_string(endpoint),
                               deadline.count()));
  }
  auto impl = std::make_unique<Impl>(std::move(endpoint), deadline, std::move(now));
  impl->context = make_context(impl->endpoint);
  if (!impl->context) {
    return failure(MinorCode::Other, fmt::format("Modbus line {}: {}", to_string(impl->endpoint), error_text(errno)));
  }
  const auto seconds = std::chrono::floor<std::chrono::seconds>(deadline);
  const std::chrono::microseconds rest = deadline - seconds;
  modbus_set_response_timeout(impl->context.get(), static_cast<std::uint32_t>(seconds.count()),
                              static_cast<std::uint32_t>(rest.count()));
  modbus_set_byte_timeout(impl->context.get(), 0, 0);
  modbus_set_error_recovery(impl->context.get(), MODBUS_ERROR_RECOVERY_NONE);
  return std::unique_ptr<Client>(new Client(std::move(impl)));
}

Client::Client(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
Client::~Client() {
  disconnect();
}

bool Client::connected() const noexcept {
  return impl_->open;
}
Clock::time_point Client::now() const {
  return impl_->now();
}
void Client::disconnect() noexcept {
  impl_->close();
}
bool Client::in_doubt(int slave) const noexcept {
  return slave > 0 && slave <= kAnyUnit && impl_->slaves[static_cast<std::size_t>(slave)].doubt;
}

UnitTraffic Client::traffic(int unit) const {
  return impl_->records.traffic(unit, now());
}

Answer<> Client::connect() {
  impl_->close();
  if (const int error = open_line(impl_->context.get(), impl_->endpoint, impl_->deadline); error != 0) {
    return tl::unexpected<Failure>(
        {error == ETIMEDOUT ? Kind::Timeout : Kind::Disconnected, 0,
         fmt::format("{}: cannot be opened: {}", to_string(impl_->endpoint), error_text(error))});
  }
  impl_->open = true;
  // What was asked before the line was closed, or by whoever had it before, may still be answered.
  for (Impl::Slave& slave : impl_->slaves) slave.doubt = impl_->serial();
  return {};
}

Answer<Clock::time_point> Client::read(int slave, Table table, std::uint16_t address, std::span<std::uint16_t> values) {
  const Request request{slave, false, table, address, values.size()};
  if (auto fine = impl_->check(request); !fine) return tl::unexpected(std::move(fine.error()));
  if (in_doubt(slave)) {
    return impl_->fail(Kind::InDoubt, request, "not asked, an answer to an earlier question may still come");
  }
  return impl_->ask(request, {}, values).map([&] { return impl_->slave(request).asked; });
}

Answer<> Client::write(int slave, Table table, std::uint16_t address, std::span<const std::uint16_t> values) {
  const Request request{slave, true, table, address, values.size()};
  if (auto fine = impl_->check(request); !fine) return fine;
  const bool doubted = in_doubt(slave);
  auto answer = impl_->ask(request, values, {});
  if (answer && doubted) return impl_->fail(Kind::InDoubt, request, "the answer may be that to an earlier question");
  return answer;
}

Answer<> Client::resynchronise(int slave, Table table, std::uint16_t address, std::size_t count) {
  if (!in_doubt(slave)) return {};
  Impl::Slave& known = impl_->slaves[static_cast<std::size_t>(slave)];
  known.probed.resize(kProbes);
  const auto now = impl_->now();
  const auto long_ago = [now](Clock::time_point asked) { return now - asked >= kSettle; };
  const bool settled = long_ago(known.asked);
  // The shortest length that is this probe's alone, because no answer to an older one of the same length can come.
  const auto probed = std::find_if(known.probed.begin(), known.probed.end(), long_ago);
  const auto step = static_cast<std::size_t>(probed - known.probed.begin());
  const Request request{slave, false, table, address, probe_length(table, count, step)};
  const auto fine = impl_->check(request);
  if (!fine && step == 0) return fine;
  if (!fine || probed == known.probed.end() || (known.refuses_probes && !settled)) {
    return impl_->fail(Kind::InDoubt, request, "not asked, an answer to an earlier question may still come");
  }
  *probed = now;
  std::array<std::uint16_t, MODBUS_MAX_READ_BITS> values{};
  auto answer = impl_->ask(request, {}, {values.data(), request.count});
  const bool exception = !answer && answer.error().kind == Kind::Exception;
  if (answer || (exception && !answer.error().busy())) known.refuses_probes = exception;
  if (!answer && !(exception && settled)) return answer;
  known.doubt = false;
  return {};
}

}  // namespace rmac::fieldbus::modbus
