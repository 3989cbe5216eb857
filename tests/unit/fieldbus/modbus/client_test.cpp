#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <random>
#include <stdexcept>

#include "rmac/fieldbus/modbus/backoff.hpp"
#include "unit/fieldbus/modbus/modbus_peer.hpp"
#include "unit/fieldbus/modbus/still_clock.hpp"

namespace rmac::fieldbus::modbus {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using Kind = Failure::Kind;
using Manner = ModbusPeer::Manner;
using Wire = ModbusPeer::Wire;

constexpr int kSlave = 17;
constexpr std::size_t kProbe = 9;  ///< more than any read here
// What a transaction may take beyond its deadline on a computer that does much else: one that ignores it never ends.
constexpr auto kGrace = 20s;

std::string wire_name(const testing::TestParamInfo<Wire>& wire) {
  return wire.param == Wire::Tcp ? "Tcp" : "Rtu";
}

class OnAWire : public testing::TestWithParam<Wire> {
 protected:
  OnAWire() : peer(GetParam()) {}

  void open(std::chrono::milliseconds deadline) {
    auto made = Client::create(peer.endpoint(), deadline);
    ASSERT_TRUE(made) << made.error().message;
    client = std::move(*made);
    ASSERT_TRUE(client->connect());
  }
  /// As its owner would: connects where that is needed, ends doubt, then reads.
  Answer<Clock::time_point> read_registers(std::span<std::uint16_t> values) {
    if (!client->connected()) {
      if (auto connected = client->connect(); !connected) return tl::unexpected(connected.error());
    }
    if (auto sure = client->resynchronise(kSlave, Table::HoldingRegisters, 0, kProbe); !sure) {
      return tl::unexpected(sure.error());
    }
    return client->read(kSlave, Table::HoldingRegisters, 0, values);
  }

  ModbusPeer peer;
  std::unique_ptr<Client> client;
};

using ModbusClient = OnAWire;
INSTANTIATE_TEST_SUITE_P(Wires, ModbusClient, testing::Values(Wire::Tcp, Wire::Rtu), wire_name);

TEST_P(ModbusClient, ReadsAndWritesAllTables) {
  open(10s);
  ASSERT_TRUE(client->resynchronise(kSlave, Table::HoldingRegisters, 0, kProbe));
  peer.respond([](const Bytes& request) -> Bytes {
    switch (request[1]) {
      case 1:
      case 2:
        return {kSlave, request[1], 2, 0b10000101, 0b00000010};
      case 3:
      case 4:
        return {kSlave, request[1], 4, 0x12, 0x34, 0xFE, 0xDC};
      default:
        return {request.begin(), request.begin() + 6};
    }
  });
  std::array<std::uint16_t, 10> bits{};
  std::array<std::uint16_t, 2> words{};
  for (const Table table : {Table::Coils, Table::DiscreteInputs}) {
    bits.fill(7);
    ASSERT_TRUE(client->read(kSlave, table, 3, bits));
    EXPECT_EQ(bits, (std::array<std::uint16_t, 10>{1, 0, 1, 0, 0, 0, 0, 1, 0, 1}));
  }
  for (const Table table : {Table::InputRegisters, Table::HoldingRegisters}) {
    words.fill(0);
    ASSERT_TRUE(client->read(kSlave, table, 0xFFFE, words));
    EXPECT_EQ(words, (std::array<std::uint16_t, 2>{0x1234, 0xFEDC}));
  }
  static_cast<void>(peer.take_requests());
  const std::array<std::uint16_t, 3> values{1, 0, 1};
  ASSERT_TRUE(client->write(kSlave, Table::Coils, 0x100, {values.data(), 1}));
  ASSERT_TRUE(client->write(kSlave, Table::Coils, 0x100, values));
  ASSERT_TRUE(client->write(kSlave, Table::HoldingRegisters, 0x2000, {values.data(), 1}));
  ASSERT_TRUE(client->write(kSlave, Table::HoldingRegisters, 0x2000, {values.data(), 2}));
  EXPECT_EQ(peer.take_requests(), (std::vector<Bytes>{{kSlave, 5, 1, 0, 0xFF, 0},
                                                      {kSlave, 15, 1, 0, 0, 3, 1, 0b101},
                                                      {kSlave, 6, 0x20, 0, 0, 1},
                                                      {kSlave, 16, 0x20, 0, 0, 2, 4, 0, 1, 0, 0}}));
}

TEST_P(ModbusClient, SaysWhoRefusedWhatAndWhy) {
  open(10s);
  ASSERT_TRUE(client->resynchronise(kSlave, Table::HoldingRegisters, 0, kProbe));
  peer.respond([](const Bytes& request) { return Bytes{kSlave, static_cast<std::uint8_t>(request[1] | 0x80U), 2}; });
  std::array<std::uint16_t, 2> words{};
  const auto refused = client->read(kSlave, Table::InputRegisters, 0x2103, words);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, Kind::Exception);
  EXPECT_EQ(refused.error().exception_code, 2);
  EXPECT_THAT(refused.error().message, HasSubstr("slave 17, reading 2 input registers from 2103h: refused with "
                                                 "exception 2: it has no such address"));
}

TEST_P(ModbusClient, SendsNothingThatBreaksTheProtocol) {
  open(10s);
  std::array<std::uint16_t, 126> words{};
  const std::uint64_t before = peer.requests();
  const auto kind = [](const auto& answer) { return answer ? Kind::Timeout : answer.error().kind; };
  EXPECT_EQ(kind(client->read(kSlave, Table::HoldingRegisters, 0, words)), Kind::BadRequest);
  EXPECT_EQ(kind(client->read(kSlave, Table::HoldingRegisters, 0, {})), Kind::BadRequest);
  EXPECT_EQ(kind(client->read(kSlave, Table::HoldingRegisters, 0xFFFF, {words.data(), 2})), Kind::BadRequest);
  EXPECT_EQ(kind(client->read(0, Table::HoldingRegisters, 0, {words.data(), 1})), Kind::BadRequest);
  EXPECT_EQ(kind(client->read(248, Table::HoldingRegisters, 0, {words.data(), 1})), Kind::BadRequest);
  EXPECT_EQ(kind(client->write(kSlave, Table::InputRegisters, 0, {words.data(), 1})), Kind::BadRequest);
  EXPECT_EQ(kind(client->write(kSlave, Table::HoldingRegisters, 0, {words.data(), 124})), Kind::BadRequest);
  EXPECT_EQ(peer.requests(), before);
}

/// One peer of bad manners, asked again and again: each transaction ends in time, and what is accepted answers the very
/// question that was asked last.
void expect_nothing_stale(ModbusPeer& peer,
                          const std::function<Answer<Clock::time_point>(std::span<std::uint16_t>)>& ask,
                          std::chrono::milliseconds deadline, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    std::array<std::uint16_t, 2> words{};
    const auto begun = Clock::now();
    const auto answer = ask(words);
    // Up to three transactions: connect, resynchronise, read.
    ASSERT_LT(Clock::now() - begun, 3 * (deadline + kGrace)) << "round " << round;
    if (!answer) continue;
    ASSERT_GE(*answer, begun);
    ASSERT_EQ(words[0], static_cast<std::uint16_t>(peer.requests())) << "an old answer was taken in round " << round;
  }
}

TEST_P(ModbusClient, EndsInTimeWhateverThePeerDoes) {
  constexpr auto kDeadline = 20ms;
  open(kDeadline);
  const auto ask = [this](std::span<std::uint16_t> words) { return read_registers(words); };
  for (const Manner manner : {Manner::Silent, Manner::WrongId, Manner::Garbage, Manner::Resetting}) {
    SCOPED_TRACE(testing::Message() << "manner " << static_cast<int>(manner));
    peer.behave(manner);
    expect_nothing_stale(peer, ask, kDeadline, 20);
  }
}

/// The byte that is counted and does not come would be taken for the first of the next answer.
TEST(ModbusTcpClient, RefusesAnAnswerWhoseHeaderCountsOtherBytesThanCame) {
  ModbusPeer peer(Wire::Tcp);
  auto client = std::move(*Client::create(peer.endpoint(), 10s));
  peer.behave(Manner::WrongLength);
  for (int answers = 0; answers < 50; ++answers) {
    ASSERT_TRUE(client->connect());
    std::array<std::uint16_t, 2> words{7, 7};
    const auto answer = client->read(kSlave, Table::HoldingRegisters, 0, words);
    ASSERT_FALSE(answer) << "answer " << answers;
    ASSERT_EQ(answer.error().kind, Kind::WrongAnswer);
    ASSERT_THAT(answer.error().message, HasSubstr("counts other bytes"));
    ASSERT_EQ(words, (std::array<std::uint16_t, 2>{7, 7}));
    ASSERT_FALSE(client->connected());
  }
}

// Red when an exception casts doubt (a line on which a slave was busy once was left alone for seconds), and when a
// gateway's casts none.
TEST(ModbusClientRtu, DoubtsNoSlaveThatRefusesUnlessAGatewaySpeaksForIt) {
  ModbusPeer peer(Wire::Rtu);
  const auto client = std::move(*Client::create(peer.endpoint(), 60s));
  ASSERT_TRUE(client->connect());
  std::array<std::uint16_t, 1> word{};
  for (const int code : {1, 2, 3, 4, 5, 6, 8, 10, 11}) {
    peer.respond({});
    ASSERT_TRUE(client->resynchronise(kSlave, Table::HoldingRegisters, 0, kProbe));
    peer.respond([code](const Bytes& request) {
      return Bytes{kSlave, static_cast<std::uint8_t>(request[1] | 0x80U), static_cast<std::uint8_t>(code)};
    });
    const auto refused = client->read(kSlave, Table::HoldingRegisters, 0, word);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, Kind::Exception) << code;
    EXPECT_EQ(refused.error().busy(), code == 5 || code == 6) << code;
    EXPECT_EQ(client->in_doubt(kSlave), code >= 10) << code;
  }
}

// Red when a slave that is busy counts as one that refuses long reads: it would be left alone for two seconds.
TEST(ModbusClientRtu, AsksASlaveThatWasBusyAgainAtOnce) {
  ModbusPeer peer(Wire::Rtu);
  const auto client = std::move(*Client::create(peer.endpoint(), 60s));
  ASSERT_TRUE(client->connect());
  ASSERT_TRUE(client->resynchronise(kSlave, Table::HoldingRegisters, 0, kProbe));
  std::array<std::uint16_t, 1> word{};
  peer.behave(Manner::WrongId);
  ASSERT_FALSE(client->read(kSlave, Table::HoldingRegisters, 0, word));
  ASSERT_TRUE(client->in_doubt(kSlave));
  peer.behave(Manner::Busy);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(client->resynchronise(kSlave, Table::HoldingRegisters, 0, kProbe));
  const std::uint64_t before = peer.requests();
  peer.behave(Manner::Honest);
  EXPECT_TRUE(client->resynchronise(kSlave, Table::HoldingRegisters, 0, kProbe));
  EXPECT_EQ(peer.requests(), before + 1);
}

TEST_P(ModbusClient, EndsInTimeWhileAnAnswerDrips) {
  constexpr auto kDeadline = 50ms;
  open(10s);
  client = std::move(*Client::create(peer.endpoint(), kDeadline));
  ASSERT_TRUE(client->connect());
  // 250 bytes: were the time counted from byte to byte, they would all come, in ten seconds.
  peer.behave(Manner::Dripping, 40ms);
  std::array<std::uint16_t, 120> words{};
  const auto answer = read_registers(words);
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().kind, Kind::Timeout);
}

TEST_P(ModbusClient, TakesNoLateAnswerForANewOne) {
  constexpr auto kDeadline = 10ms;
  open(kDeadline);
  std::mt19937 random(20260501);  // NOLINT: the same peers in every run
  const auto ask = [this](std::span<std::uint16_t> words) { return read_registers(words); };
  for (int peers = 0; peers < 40; ++peers) {
    const std::chrono::microseconds pause(std::uniform_int_distribution(0, 30'000)(random));
    SCOPED_TRACE(testing::Message() << "answers after " << pause.count() << " us");
    peer.behave(Manner::Late, pause);
    expect_nothing_stale(peer, ask, kDeadline, 8);
  }
}

TEST_P(ModbusClient, TakesNoAnswerFromAQueueOfLateOnes) {
  // Asked faster than it answers, all the time: the questions queue up in front of it.
  constexpr auto kDeadline = 2ms;
  open(kDeadline);
  peer.behave(Manner::Late, 4ms);
  const auto ask = [this](std::span<std::uint16_t> words) { return read_registers(words); };
  expect_nothing_stale(peer, ask, kDeadline, 400);
}

TEST_P(ModbusClient, WorksAgainOnceThePeerBehaves) {
  open(20ms);
  std::array<std::uint16_t, 2> words{};
  for (const Manner manner : {Manner::Silent, Manner::WrongId, Manner::Garbage, Manner::Resetting}) {
    peer.behave(manner);
    EXPECT_FALSE(read_registers(words));
    peer.behave(Manner::Honest);
    const auto give_up = Clock::now() + 60s;
    while (!read_registers(words)) {
      ASSERT_LT(Clock::now(), give_up) << "after manner " << static_cast<int>(manner);
      std::this_thread::yield();
    }
    EXPECT_EQ(words[0], static_cast<std::uint16_t>(peer.requests()));
  }
}

TEST_P(ModbusClient, SaysThatThePeerWentAway) {
  open(10s);
  std::array<std::uint16_t, 2> words{};
  ASSERT_TRUE(read_registers(words));
  peer.vanish();
  const auto gone = read_registers(words);
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().kind, Kind::Disconnected) << gone.error().message;
  EXPECT_FALSE(client->connected());
  const auto again = read_registers(words);
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().message, HasSubstr("cannot be opened: "));
}

TEST(ModbusClientRtu, AsksNothingInDoubtAndBelievesNoConfirmation) {
  ModbusPeer peer(Wire::Rtu);
  const auto client = std::move(*Client::create(peer.endpoint(), 60s));
  ASSERT_TRUE(client->connect());
  EXPECT_TRUE(client->in_doubt(kSlave)) << "what the line was used for before is not known";
  std::array<std::uint16_t, 2> words{};
  const auto read = client->read(kSlave, Table::HoldingRegisters, 0, words);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, Kind::InDoubt);
  EXPECT_EQ(peer.requests(), 0U);
  // A stop is sent all the same.
  const auto stop = client->write(kSlave, Table::HoldingRegisters, 0x2000, {words.data(), 1});
  ASSERT_FALSE(stop);
  EXPECT_EQ(stop.error().kind, Kind::InDoubt);
  EXPECT_EQ(peer.requests(), 1U);
}

TEST(ModbusClientRtu, DoubtOfOneSlaveIsNotTheOthers) {
  ModbusPeer peer(Wire::Rtu);
  const auto client = std::move(*Client::create(peer.endpoint(), 60s));
  ASSERT_TRUE(client->connect());
  for (const int slave : {1, 2}) ASSERT_TRUE(client->resynchronise(slave, Table::HoldingRegisters, 0, kProbe));
  peer.respond([](const Bytes& request) { return request[0] == 1 ? Bytes{9, 3, 2, 0, 42} : Bytes{2, 3, 2, 0, 42}; });
  std::array<std::uint16_t, 1> word{};
  EXPECT_FALSE(client->read(1, Table::HoldingRegisters, 0, word));
  EXPECT_TRUE(client->in_doubt(1));
  EXPECT_FALSE(client->in_doubt(2));
  ASSERT_TRUE(client->read(2, Table::HoldingRegisters, 0, word));
  EXPECT_EQ(word[0], 42);
}

TEST(ModbusClientRtu, TakesNoExceptionForTheEndOfDoubtWhileAnotherMayBeUnderWay) {
  ModbusPeer peer(Wire::Rtu);
  const auto client = std::move(*Client::create(peer.endpoint(), 60s));
  ASSERT_TRUE(client->connect());
  // A slave that gives one register at a time.
  peer.respond([](const Bytes& request) {
    return request[5] == 1 ? Bytes{kSlave, 3, 2, 0, 42} : Bytes{kSlave, 0x83, 3};
  });
  ASSERT_TRUE(client->resynchronise(kSlave, Table::HoldingRegisters, 0, 2)) << "nothing was asked before";
  std::array<std::uint16_t, 1> word{};
  ASSERT_TRUE(client->read(kSlave, Table::HoldingRegisters, 0, word));
  EXPECT_EQ(word[0], 42);
  peer.behave(Manner::WrongId);
  ASSERT_FALSE(client->read(kSlave, Table::HoldingRegisters, 0, word));
  peer.behave(Manner::Honest);
  const std::uint64_t before = peer.requests();
  for (int i = 0; i < 10; ++i) {
    const auto sure = client->resynchronise(kSlave, Table::HoldingRegisters, 0, 2);
    ASSERT_FALSE(sure);
    EXPECT_TRUE(client->in_doubt(kSlave));
  }
  EXPECT_LE(peer.requests(), before + 1) << "it is left alone until nothing late can come";
}

TEST(ModbusClientRtu, SaysThatThereIsNoSuchPort) {
  const auto client = std::move(*Client::create(RtuEndpoint{"/dev/no-such-port"}, 20ms));
  const auto opened = client->connect();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().message, "/dev/no-such-port: cannot be opened: No such file or directory");
}

/// A port that takes no more connections: what its backlog holds is never accepted.
class FullPort {
 public:
  FullPort() : listener_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    if (bind(listener_, any, size) != 0 || listen(listener_, 0) != 0 || getsockname(listener_, any, &size) != 0) {
      throw std::runtime_error("no port to listen on");
    }
    port_ = ntohs(address.sin_port);
    for (int waiting = 0; waiting < 4; ++waiting) {
      guests_.push_back(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
      static_cast<void>(connect(guests_.back(), any, size));
    }
  }
  ~FullPort() {
    for (const int guest : guests_) close(guest);
    close(listener_);
  }
  FullPort(const FullPort&) = delete;
  FullPort& operator=(const FullPort&) = delete;
  [[nodiscard]] Endpoint endpoint() const { return TcpEndpoint{"127.0.0.1", port_}; }

 private:
  int listener_;
  std::uint16_t port_ = 0;
  std::vector<int> guests_;
};

TEST(ModbusTcpClient, WaitsForAConnectionAsLongAsItsDeadline) {
  const FullPort port;
  const auto client = std::move(*Client::create(port.endpoint(), 40ms));
  const auto begun = Clock::now();
  const auto connected = client->connect();
  EXPECT_GE(Clock::now() - begun, 40ms);
  ASSERT_FALSE(connected);
  EXPECT_EQ(connected.error().kind, Kind::Timeout);
  EXPECT_THAT(connected.error().message, HasSubstr("cannot be opened: Connection timed out"));
  EXPECT_FALSE(client->connected());
}

// A slave that answers late: a length that was asked for may be told within two seconds.
TEST(ModbusClientRtu, AsksForNoLengthTwiceWithinTwoSeconds) {
  StillClock clock;
  ModbusPeer peer(Wire::Rtu);
  const auto client = std::move(*Client::create(peer.endpoint(), 60s, clock.now()));
  ASSERT_TRUE(client->connect());
  peer.behave(Manner::WrongId);
  const auto lengths = [&](int probes) {
    std::vector<int> asked;
    static_cast<void>(peer.take_requests());
    for (int i = 0; i < probes; ++i) EXPECT_FALSE(client->resynchronise(kSlave, Table::HoldingRegisters, 0, kProbe));
    for (const Bytes& request : peer.take_requests()) asked.push_back(request[5]);
    return asked;
  };
  EXPECT_EQ(lengths(3), (std::vector<int>{9, 10, 11}));
  clock.pass(1999ms);
  EXPECT_EQ(lengths(1), (std::vector<int>{12}));
  clock.pass(1ms);
  EXPECT_EQ(lengths(4), (std::vector<int>{9, 10, 11, 13}));
  EXPECT_EQ(lengths(100).size(), 64U - 5) << "until no length is left";
  EXPECT_TRUE(client->in_doubt(kSlave));
  clock.pass(2s);
  peer.behave(Manner::Honest);
  EXPECT_TRUE(client->resynchronise(kSlave, Table::HoldingRegisters, 0, kProbe));
  EXPECT_FALSE(client->in_doubt(kSlave));
}

TEST_P(ModbusClient, KeepsARecordOfEachUnit) {
  open(60s);
  std::array<std::uint16_t, 1> word{};
  ASSERT_TRUE(read_registers(word));
  const UnitTraffic before = client->traffic(kSlave);
  EXPECT_EQ(before.requests, before.answers);
  EXPECT_FALSE(before.last_trouble);
  peer.behave(Manner::WrongId);
  ASSERT_FALSE(client->read(kSlave, Table::HoldingRegisters, 0, word));
  const UnitTraffic after = client->traffic(kSlave);
  EXPECT_EQ(after.requests, before.requests + 1);
  EXPECT_EQ(after.answers, before.answers);
  EXPECT_EQ(after.wrong_answers, 1U);
  ASSERT_TRUE(after.last_trouble);
  EXPECT_THAT(after.last_trouble->message, HasSubstr("another slave answered"));
  EXPECT_EQ(client->traffic(kSlave + 1).requests, 0U);
}

TEST(ModbusTcpClient, AsksADeviceWithoutAGatewayByItsOwnNumber) {
  ModbusPeer peer(Wire::Tcp);
  auto client = std::move(*Client::create(peer.endpoint(), 60s));
  std::array<std::uint16_t, 1> word{};
  const auto unopened = client->read(255, Table::HoldingRegisters, 0, word);
  ASSERT_FALSE(unopened);
  EXPECT_EQ(unopened.error().kind, Kind::NotConnected);
  ASSERT_TRUE(client->connect());
  EXPECT_TRUE(client->read(255, Table::HoldingRegisters, 0, word));
  EXPECT_TRUE(client->read(247, Table::HoldingRegisters, 0, word));
  EXPECT_TRUE(client->read(1, Table::HoldingRegisters, 0xFFFF, word)) << "the last address";
  EXPECT_FALSE(client->read(254, Table::HoldingRegisters, 0, word));
}

TEST(ModbusClientCreation, TakesWhatALineCanHave) {
  const auto made = [](Endpoint endpoint, std::chrono::milliseconds deadline = 100ms) {
    return Client::create(std::move(endpoint), deadline).has_value();
  };
  for (const int rate : {1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200, 230400, 460800, 500000, 921600}) {
    EXPECT_TRUE(made(RtuEndpoint{"/dev/ttyS0", rate})) << rate;
  }
  for (const char parity : {'N', 'E', 'O'}) EXPECT_TRUE(made(RtuEndpoint{"/dev/ttyS0", 9600, parity})) << parity;
  for (const int bits : {1, 2}) EXPECT_TRUE(made(RtuEndpoint{"/dev/ttyS0", 9600, 'N', bits})) << bits;
  EXPECT_FALSE(made(RtuEndpoint{"/dev/ttyS0", 9600, 'N', 0}));
  EXPECT_FALSE(made(RtuEndpoint{""}));
  EXPECT_FALSE(made(TcpEndpoint{"127.0.0.1", 0}));
  EXPECT_TRUE(made(TcpEndpoint{"127.0.0.1", 1}));
  EXPECT_TRUE(made(TcpEndpoint{"127.0.0.1"}, 1ms));
  EXPECT_TRUE(made(TcpEndpoint{"127.0.0.1"}, 1min));
  EXPECT_FALSE(made(TcpEndpoint{"127.0.0.1"}, 60001ms));
}

TEST(ModbusClientCreation, NamesWhatIsWrongInAnEndpoint) {
  const auto error = [](Endpoint endpoint, std::chrono::milliseconds deadline = 100ms) {
    const auto made = Client::create(std::move(endpoint), deadline);
    return made ? std::string("made") : made.error().message;
  };
  EXPECT_EQ(error(TcpEndpoint{"spindle.local"}),
            "Modbus line spindle.local port 502: \"spindle.local\" is no numeric IP address, for example 192.168.1.20; "
            "names are not looked up");
  EXPECT_EQ(error(TcpEndpoint{"::1"}), "made");
  EXPECT_THAT(error(TcpEndpoint{"localhost"}), HasSubstr("is no numeric IP address")) << "though it needs no network";
  EXPECT_THAT(error(RtuEndpoint{"/dev/ttyS0", 31250}), HasSubstr("bit rate 31250; there are 1200, 2400"));
  EXPECT_THAT(error(RtuEndpoint{"/dev/ttyS0", 9600, 'X'}), HasSubstr("parity 'X'"));
  EXPECT_THAT(error(RtuEndpoint{"/dev/ttyS0", 9600, 'N', 3}), HasSubstr("3 stop bits"));
  EXPECT_THAT(error(TcpEndpoint{"127.0.0.1"}, 0ms), HasSubstr("a deadline of 0 ms"));
}

TEST(ModbusBackoff, DoublesItsPausesUpToTheLongest) {
  Backoff backoff(100ms, 350ms);
  Clock::time_point now{};
  EXPECT_TRUE(backoff.due(now));
  for (const auto pause : {100ms, 200ms, 350ms, 350ms}) {
    backoff.failed(now);
    EXPECT_FALSE(backoff.due(now + pause - 1ms));
    EXPECT_TRUE(backoff.due(now + pause));
    now += pause;
  }
  backoff.succeeded();
  EXPECT_TRUE(backoff.due(now));
  backoff.failed(now);
  EXPECT_TRUE(backoff.due(now + 100ms));
}

}  // namespace
}  // namespace rmac::fieldbus::modbus
