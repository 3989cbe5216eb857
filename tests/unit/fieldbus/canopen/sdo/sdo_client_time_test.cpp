// Which frames a client of service data objects takes for answers, and how long it waits for one.
#include <gtest/gtest.h>

#include <vector>

#include "rmac/fieldbus/canopen/sdo_client.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using State = SdoClient::State;

constexpr ObjectAddress kObject{0x2001, 3};
constexpr std::uint16_t kAnswerId = 0x585;

class ClientAlone : public testing::Test {
 protected:
  CanFrame sent() {
    CanFrame frame;
    EXPECT_TRUE(client_.next_frame(now_, frame));
    return frame;
  }
  bool silent() {
    CanFrame frame;
    return !client_.next_frame(now_, frame);
  }
  void answer(const SdoBytes& bytes, std::uint8_t size = 8) {
    client_.receive({.id = kAnswerId, .size = size, .data = bytes}, now_);
  }

  SdoClient client_{5};
  nanoseconds now_{milliseconds(1000)};
  std::vector<std::uint8_t> into_ = std::vector<std::uint8_t>(20), data_ = std::vector<std::uint8_t>(40, 7);
};

TEST_F(ClientAlone, AsksTheNodeThatItIsFor) {
  client_.upload(kObject, into_, now_);
  EXPECT_EQ(sent(), (CanFrame{.id = 0x605, .size = 8, .data = {0x40, 1, 0x20, 3}}));
}

TEST_F(ClientAlone, TakesNothingThatIsShorterThanAnAnswer) {
  for (std::uint8_t size = 0; size < 8; ++size) {
    client_.upload(kObject, into_, now_);
    (void)sent();
    answer({0x4F, 1, 0x20, 3, 9}, size);
    EXPECT_EQ(client_.state(), State::Busy);
    answer({0x80, 1, 0x20, 3}, size);
    EXPECT_EQ(client_.state(), State::Busy);
  }
}

TEST_F(ClientAlone, TakesNothingMoreOnceItIsThrough) {
  client_.upload(kObject, into_, now_);
  (void)sent();
  answer({0x4F, 1, 0x20, 3, 9});
  ASSERT_EQ(client_.state(), State::Done);
  answer({0x80, 1, 0x20, 3, 0, 0, 2, 6});
  answer({0x43, 1, 0x20, 3, 1, 2, 3, 4});
  EXPECT_EQ(client_.state(), State::Done);
  EXPECT_EQ(client_.size(), 1U);
  EXPECT_EQ(into_[0], 9);
  EXPECT_TRUE(silent());
}

TEST_F(ClientAlone, TakesAnAbortOfItsObjectOrOfNone) {
  struct Case {
    std::uint16_t index;
    std::uint8_t sub;
    bool its_own;
  };
  for (const Case& one : {Case{0x2001, 3, true}, Case{0, 0, true}, Case{0, 1, false}, Case{0, 3, false},
                          Case{0x2001, 0, false}, Case{0x2001, 4, false}, Case{0x2002, 3, false}}) {
    client_.upload(kObject, into_, now_);
    (void)sent();
    SdoBytes abort{0x80, 0, 0, one.sub, 0x11, 0, 9, 6};
    put_word(&abort[1], one.index);
    answer(abort);
    EXPECT_EQ(client_.state(), one.its_own ? State::Refused : State::Busy) << one.index << " " << int{one.sub};
    EXPECT_EQ(client_.abort_code(), one.its_own ? 0x06090011U : 0U);
    client_.abandon();
  }
}

TEST_F(ClientAlone, SendsNothingBehindAnAbort) {
  client_.upload(kObject, into_, now_);
  (void)sent();
  answer({0x41, 1, 0x20, 3, 20});  // the next question is not fetched yet
  answer({0x80, 1, 0x20, 3, 0, 0, 0, 8});
  EXPECT_TRUE(client_.finished());
  EXPECT_EQ(client_.state(), State::Refused);
  EXPECT_TRUE(silent());
}

TEST_F(ClientAlone, IsThroughWhenItsLastFrameWasFetched) {
  into_.resize(40);
  client_.upload(kObject, into_, now_);
  EXPECT_EQ(sent().data[0], 0xA4);
  answer({0xC0, 1, 0x20, 3});
  EXPECT_EQ(sent().data[0], 0xA3);
  answer({0x81, 1, 2, 3, 4, 5, 6, 7});
  (void)sent();
  answer({0xC1});
  EXPECT_EQ(client_.state(), State::Done);
  EXPECT_FALSE(client_.finished()) << "the server waits for the end";
  EXPECT_EQ(sent().data[0], 0xA1);
  EXPECT_TRUE(client_.finished());
}

TEST_F(ClientAlone, WaitsForEachAnswerAnewAsLongAsItIsTold) {
  client_.set_timeout(milliseconds(100));
  client_.upload(kObject, into_, now_);
  (void)sent();
  for (std::uint8_t toggle = 0; toggle < 2; ++toggle) {
    now_ += milliseconds(99);
    EXPECT_TRUE(silent());
    answer(toggle == 0 ? SdoBytes{0x40, 1, 0x20, 3} : SdoBytes{0x00, 1, 2, 3, 4, 5, 6, 7});
    (void)sent();
  }
  now_ += milliseconds(100);
  EXPECT_EQ(sent(), (CanFrame{.id = 0x605, .size = 8, .data = {0x80, 1, 0x20, 3, 0, 0, 4, 5}}));
  EXPECT_EQ(client_.state(), State::Failed);
  EXPECT_EQ(client_.abort_code(), sdo_abort::kTimeout);
  client_.upload(kObject, into_, now_);
  EXPECT_EQ(client_.abort_code(), 0U);
}

// Red when what is no answer to its question has it wait longer.
TEST_F(ClientAlone, IsNotKeptWaitingByAnswersToOthers) {
  client_.upload(kObject, into_, now_);
  (void)sent();
  now_ += milliseconds(400);
  answer({0x4F, 2, 0x20, 3, 9});
  answer({0x80, 2, 0x20, 3});
  now_ += milliseconds(100);
  EXPECT_EQ(sent().data[0], 0x80);
}

TEST_F(ClientAlone, WaitsForTheAnswerToABlockFromItsLastSegmentOn) {
  client_.download(kObject, data_, now_);
  (void)sent();
  answer({0xA0, 1, 0x20, 3, 127});
  for (int segment = 1; segment <= 6; ++segment) {
    now_ += milliseconds(300);
    EXPECT_EQ(sent().data[0] & 0x7F, segment);
  }
  now_ += milliseconds(499);
  EXPECT_TRUE(silent());
  now_ += milliseconds(1);
  EXPECT_EQ(sent().data[0], 0x80);
}

// Red when a block that was given up has the next transfer pass over its answers.
TEST_F(ClientAlone, ReadsAfterABlockThatItGaveUp) {
  client_.download(kObject, data_, now_);
  (void)sent();
  answer({0xA0, 1, 0x20, 3, 127});
  (void)sent();
  client_.abandon();
  EXPECT_EQ(client_.state(), State::Idle);
  EXPECT_TRUE(silent());
  client_.upload(kObject, into_, now_);
  (void)sent();
  answer({0x4F, 1, 0x20, 3, 9});
  EXPECT_EQ(client_.state(), State::Done);
}

TEST_F(ClientAlone, AsksForBlocksOfOneTo127Segments) {
  for (const auto& [wanted, asked] : {std::pair{0, 1}, {1, 1}, {2, 2}, {127, 127}, {128, 127}, {255, 127}}) {
    SdoClient client(5, {.block_from = 1, .block_size = static_cast<std::uint8_t>(wanted)});
    client.upload(kObject, into_, now_);
    CanFrame frame;
    ASSERT_TRUE(client.next_frame(now_, frame));
    EXPECT_EQ(frame.data[4], asked);
  }
}

// Red when a server that knows no blocks is refused, or one that knows them and refuses the object is asked again.
TEST_F(ClientAlone, AsksAgainWithoutBlocksWhereTheServerDoesNotKnowThemAlone) {
  for (const bool writes : {false, true}) {
    for (const std::uint32_t code : {sdo_abort::kCommand, sdo_abort::kNoObject}) {
      SdoClient client(5, {.block_from = 1});
      writes ? client.download(kObject, data_, now_) : client.upload(kObject, into_, now_);
      CanFrame frame;
      ASSERT_TRUE(client.next_frame(now_, frame));
      SdoBytes abort{0x80, 1, 0x20, 3};
      put_long(&abort[4], code);
      for (int times = 0; times < 2; ++times) {
        client.receive({.id = kAnswerId, .size = 8, .data = abort}, now_);
        const bool again = code == sdo_abort::kCommand && times == 0;
        EXPECT_EQ(client.state(), again ? State::Busy : State::Refused) << times;
        ASSERT_EQ(client.next_frame(now_, frame), again);
        if (again) {
          EXPECT_EQ(frame.data[0], writes ? 0x21 : 0x40);
        }
      }
      EXPECT_EQ(client.abort_code(), code);
    }
  }
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
