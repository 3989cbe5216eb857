#include "rmac/fieldbus/canopen/sdo_client.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <random>

#include "unit/fieldbus/canopen/object_bank.hpp"

namespace {

using namespace rmac::fieldbus;
using namespace rmac::fieldbus::canopen;
using rmac::fieldbus::test::Bytes;
using rmac::fieldbus::test::ObjectBank;
using rmac::fieldbus::test::ObjectDictionary;
using rmac::vdrive::SdoServer;
using std::chrono::milliseconds;

constexpr ObjectAddress kObject{0x2000, 1};

Bytes random_bytes(std::mt19937& random, std::size_t size) {
  Bytes bytes(size);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

/// Client and server on a wire that a test may cut, spoil or double. Time passes when nothing else happens.
class SdoWire : public testing::Test {
 protected:
  enum class Fate { Arrives, Lost, Spoiled, Doubled };

  void carry() {
    std::deque<CanFrame> to_server;
    std::deque<CanFrame> to_client;
    for (int idle = 0; idle < 2 && frames_ < 20000;) {
      CanFrame frame;
      bool busy = false;
      while (client_.next_frame(now_, frame)) {
        busy = true;
        convey(frame, to_server);
      }
      for (; !to_server.empty(); to_server.pop_front()) {
        for (const CanFrame& reply : server_.receive(to_server.front())) convey(reply, to_client);
      }
      for (; !to_client.empty(); to_client.pop_front()) {
        busy = true;
        client_.receive(to_client.front(), now_);
      }
      if (!busy) now_ += milliseconds(600);
      idle = busy ? 0 : idle + 1;
    }
  }
  void convey(const CanFrame& frame, std::deque<CanFrame>& to) {
    CanFrame carried = frame;
    ++frames_;
    switch (fate_ ? fate_(carried) : Fate::Arrives) {
      case Fate::Lost:
        return;
      case Fate::Doubled:
        to.push_back(carried);
        break;
      case Fate::Arrives:
      case Fate::Spoiled:
        break;
    }
    to.push_back(carried);
  }
  void download(const Bytes& data) {
    dictionary_[{kObject.index, kObject.sub}] = {};
    client_.download(kObject, data, now_);
    carry();
  }
  Bytes upload(std::size_t room) {
    buffer_.assign(room, 0xEE);
    client_.upload(kObject, buffer_, now_);
    carry();
    return {buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(std::min(client_.size(), room))};
  }
  Bytes& object() { return dictionary_[{kObject.index, kObject.sub}]; }

  ObjectDictionary dictionary_;
  ObjectBank bank_{dictionary_};
  SdoServer server_{5, bank_};
  SdoClient client_{5};
  std::chrono::nanoseconds now_{0};
  std::function<Fate(CanFrame&)> fate_;
  Bytes buffer_;
  int frames_ = 0;
};

TEST_F(SdoWire, CarriesEveryLengthBothWays) {
  std::mt19937 random(301);
  for (const std::size_t block_from : {std::size_t{29}, std::size_t{100000}}) {
    client_ = SdoClient(5, {.block_from = block_from});
    for (std::size_t size = 0; size <= 5000; ++size) {
      frames_ = 0;
      const Bytes data = random_bytes(random, size);
      server_.block_size = static_cast<std::uint8_t>(1 + random() % 127);
      server_.tells_size = random() % 2 == 0;
      server_.knows_crc = random() % 4 != 0;
      download(data);
      ASSERT_EQ(client_.state(), SdoClient::State::Done) << size << " bytes, abort " << client_.abort_code();
      ASSERT_EQ(object(), data) << size;
      ASSERT_EQ(upload(size + random() % 50), data) << size;
      ASSERT_EQ(client_.state(), SdoClient::State::Done) << size << " bytes, abort " << client_.abort_code();
    }
  }
}

TEST_F(SdoWire, NeverPutsUpWithWrongDataWhateverIsLostOrDoubled) {
  std::mt19937 random(402);
  int whole = 0;
  for (int run = 0; run < 3000; ++run) {
    frames_ = 0;
    client_ = SdoClient(5, {.block_from = run % 2 == 0 ? std::size_t{29} : std::size_t{100000},
                            .block_size = static_cast<std::uint8_t>(1 + random() % 127)});
    server_.block_size = static_cast<std::uint8_t>(1 + random() % 127);
    const Bytes data = random_bytes(random, random() % 1500);
    const auto one_in = 20 + random() % 400;
    fate_ = [&](CanFrame&) {
      if (random() % one_in != 0) return Fate::Arrives;
      return random() % 2 == 0 ? Fate::Lost : Fate::Doubled;
    };
    download(data);
    ASSERT_TRUE(client_.finished());
    if (client_.state() == SdoClient::State::Done) {
      ASSERT_EQ(object(), data) << "run " << run;
      ++whole;
    }
    object() = data;
    const Bytes read = upload(1500);
    ASSERT_TRUE(client_.finished());
    if (client_.state() == SdoClient::State::Done) {
      ASSERT_EQ(read, data) << "run " << run;
      ++whole;
    } else {
      ASSERT_NE(client_.abort_code(), 0U);
    }
  }
  EXPECT_GT(whole, 1000) << "hardly anything got through, so hardly anything was tested";
}

TEST_F(SdoWire, FindsABlockThatWasSpoiledByItsChecksum) {
  std::mt19937 random(7);
  for (const bool up : {false, true}) {
    const Bytes data = random_bytes(random, 700);
    object() = data;
    int segment = 0;
    const std::uint16_t from = up ? 0x585 : 0x605;
    fate_ = [&](CanFrame& frame) {
      if (frame.id != from || ++segment != 20) return Fate::Arrives;
      frame.data[4] ^= 0x10;
      return Fate::Spoiled;
    };
    if (up) {
      (void)upload(700);
    } else {
      download(data);
    }
    EXPECT_EQ(client_.abort_code(), sdo_abort::kCrc);
    EXPECT_EQ(client_.state(), up ? SdoClient::State::Failed : SdoClient::State::Refused);
    if (!up) {
      EXPECT_TRUE(object().empty());
    }
  }
}

TEST_F(SdoWire, SendsAgainWhatABlockLacks) {
  std::mt19937 random(8);
  const Bytes data = random_bytes(random, 2000);
  for (const std::uint16_t from : {std::uint16_t{0x605}, std::uint16_t{0x585}}) {
    object() = data;
    int segment = 0;
    fate_ = [&](CanFrame& frame) { return frame.id == from && ++segment == 30 ? Fate::Lost : Fate::Arrives; };
    if (from == 0x605) {
      download(data);
      EXPECT_EQ(object(), data);
    } else {
      EXPECT_EQ(upload(2000), data);
    }
    EXPECT_EQ(client_.state(), SdoClient::State::Done);
  }
}

TEST_F(SdoWire, FallsBackToSegmentsWhereTheServerKnowsNoBlocks) {
  std::mt19937 random(9);
  const Bytes data = random_bytes(random, 500);
  server_.knows_blocks = false;
  download(data);
  EXPECT_EQ(client_.state(), SdoClient::State::Done);
  EXPECT_EQ(object(), data);
  EXPECT_EQ(upload(500), data);
}

TEST_F(SdoWire, SaysWhyTheServerRefused) {
  dictionary_[{0x2000, 2}] = {1};
  EXPECT_TRUE(upload(4).empty());
  EXPECT_EQ(client_.state(), SdoClient::State::Refused);
  EXPECT_EQ(client_.abort_code(), sdo_abort::kNoSubindex);
  EXPECT_STREQ(sdo_abort_text(client_.abort_code()), "sub-index does not exist");
}

TEST_F(SdoWire, RefusesMoreThanItHasRoomFor) {
  std::mt19937 random(10);
  for (const std::size_t size : {3U, 20U, 300U}) {
    for (const bool told : {true, false}) {
      server_.tells_size = told;
      object() = random_bytes(random, size);
      (void)upload(size - 1);
      EXPECT_EQ(client_.state(), SdoClient::State::Failed) << size;
      EXPECT_EQ(client_.abort_code(), sdo_abort::kMemory) << size;
    }
  }
}

TEST_F(SdoWire, GivesUpOnASilentServerInTimeAndTellsIt) {
  fate_ = [](CanFrame& frame) { return frame.id == 0x585 ? Fate::Lost : Fate::Arrives; };
  object() = {1, 2};
  client_.upload(kObject, buffer_, now_);
  CanFrame frame;
  ASSERT_TRUE(client_.next_frame(now_, frame));
  EXPECT_FALSE(client_.next_frame(now_ + milliseconds(499), frame));
  ASSERT_TRUE(client_.next_frame(now_ + milliseconds(500), frame));
  EXPECT_EQ(frame.data[0], 0x80);
  EXPECT_EQ(long_at(&frame.data[4]), sdo_abort::kTimeout);
  EXPECT_EQ(client_.state(), SdoClient::State::Failed);
}

TEST_F(SdoWire, PassesOverALateAnswerToAnEarlierRequest) {
  buffer_.assign(4, 0);
  client_.upload({0x6041, 0}, buffer_, now_);
  CanFrame frame;
  ASSERT_TRUE(client_.next_frame(now_, frame));
  CanFrame late{.id = 0x585, .size = 8, .data = {0x4B, 0x00, 0x10, 0x00, 0x92, 0x01, 0, 0}};  // 1000h:00
  client_.receive(late, now_);
  EXPECT_EQ(client_.state(), SdoClient::State::Busy);
  late.data = {0x80, 0x00, 0x10, 0x00, 0, 0, 2, 6};
  client_.receive(late, now_);
  EXPECT_EQ(client_.state(), SdoClient::State::Busy);
  client_.receive({.id = 0x585, .size = 8, .data = {0x4B, 0x41, 0x60, 0x00, 0x37, 0x02, 0, 0}}, now_);
  EXPECT_EQ(client_.state(), SdoClient::State::Done);
  EXPECT_EQ(word_at(buffer_.data()), 0x0237);
}

TEST_F(SdoWire, EndsWhateverBytesTheServerSends) {
  std::mt19937 random(11);
  for (int run = 0; run < 20000; ++run) {
    const Bytes data = random_bytes(random, random() % 100);
    buffer_.assign(random() % 100, 0);
    now_ += milliseconds(1000);
    if (run % 2 == 0) {
      client_.upload(kObject, buffer_, now_);
    } else {
      client_.download(kObject, data, now_);
    }
    CanFrame frame;
    for (int step = 0; step < 200 && !client_.finished(); ++step) {
      for (int burst = 0; burst < 200 && client_.next_frame(now_, frame); ++burst) {
      }
      frame = {.id = 0x585, .size = static_cast<std::uint8_t>(random() % 16 == 0 ? random() % 9 : 8)};
      for (auto& byte : frame.data) byte = static_cast<std::uint8_t>(random());
      if (random() % 2 == 0) frame.data = {frame.data[0], 0x00, 0x20, 0x01, frame.data[4], frame.data[5], 0, 0};
      client_.receive(frame, now_);
      now_ += milliseconds(random() % 4 == 0 ? 200 : 1);
    }
    while (client_.next_frame(now_ += milliseconds(500), frame)) {
    }
    ASSERT_TRUE(client_.finished()) << run;
    if (client_.state() == SdoClient::State::Done) {
      ASSERT_LE(client_.size(), std::max(buffer_.size(), data.size()));
    }
  }
}

TEST(SdoCrc, IsTheStandardsChecksum) {
  const Bytes digits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(sdo_crc(digits), 0x31C3);
  EXPECT_EQ(sdo_crc({digits.data() + 4, 5}, sdo_crc({digits.data(), 4})), 0x31C3);
  EXPECT_EQ(sdo_crc({}), 0);
}

}  // namespace
