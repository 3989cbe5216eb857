#include "canopen/trace/sdo_dialogue.hpp"

#include <gtest/gtest.h>

namespace rmac::fieldbus::canopen {
namespace {

using Octets = std::vector<std::uint8_t>;

constexpr ObjectAddress kObject{0x2001, 3};

TEST(SdoDialogue, TellsAnAbortOfEitherSideAndForgetsTheTransfer) {
  for (const bool by_client : {true, false}) {
    SdoDialogue dialogue;
    EXPECT_EQ(dialogue.from_client({0x40, 1, 0x20, 3}).kind, SdoRemark::Kind::Reads);
    EXPECT_EQ(dialogue.from_server({0x41, 1, 0x20, 3, 9}).kind, SdoRemark::Kind::Goes);
    const SdoBytes abort{0x80, 1, 0x20, 3, 0, 0, 4, 5};
    const SdoRemark remark = by_client ? dialogue.from_client(abort) : dialogue.from_server(abort);
    EXPECT_EQ(remark.kind, SdoRemark::Kind::Aborted);
    EXPECT_EQ(remark.object, kObject);
    EXPECT_EQ(remark.abort_code, 0x05040000U);
    EXPECT_EQ(dialogue.from_client({0x60}).kind, SdoRemark::Kind::Unheeded) << "there is no transfer any more";
    EXPECT_EQ(dialogue.from_server({0x01, 1, 2, 3, 4, 5, 6, 7}).kind, SdoRemark::Kind::Unheeded);
  }
}

TEST(SdoDialogue, TellsAnExpeditedValueAsLongAsItIs) {
  struct Case {
    std::uint8_t told, written;
    std::size_t size;
  };
  for (const Case& one :
       {Case{0x4F, 0x2F, 1}, Case{0x4B, 0x2B, 2}, Case{0x47, 0x27, 3}, Case{0x43, 0x23, 4}, Case{0x42, 0x22, 4}}) {
    Octets expected{5, 6, 7, 8};
    expected.resize(one.size);
    SdoDialogue dialogue;
    const SdoRemark read = dialogue.from_server({one.told, 1, 0x20, 3, 5, 6, 7, 8});
    EXPECT_EQ(read.kind, SdoRemark::Kind::Read);
    EXPECT_EQ(read.object, kObject);
    EXPECT_EQ(read.bytes, expected);
    const SdoRemark writes = dialogue.from_client({one.written, 1, 0x20, 3, 5, 6, 7, 8});
    EXPECT_EQ(writes.kind, SdoRemark::Kind::Writes);
    EXPECT_EQ(writes.bytes, expected);
    const SdoRemark written = dialogue.from_server({0x60, 1, 0x20, 3});
    EXPECT_EQ(written.kind, SdoRemark::Kind::Written);
    EXPECT_EQ(written.bytes, expected);
  }
}

TEST(SdoDialogue, PassesOverASegmentThatComesTwice) {
  SdoDialogue dialogue;
  (void)dialogue.from_client({0x40, 1, 0x20, 3});
  (void)dialogue.from_server({0x41, 1, 0x20, 3, 9});
  EXPECT_EQ(dialogue.from_client({0x60}).kind, SdoRemark::Kind::Goes);
  EXPECT_EQ(dialogue.from_server({0x00, 1, 2, 3, 4, 5, 6, 7}).kind, SdoRemark::Kind::Goes);
  EXPECT_EQ(dialogue.from_server({0x00, 1, 2, 3, 4, 5, 6, 7}).kind, SdoRemark::Kind::Goes);
  EXPECT_EQ(dialogue.from_client({0x70}).kind, SdoRemark::Kind::Goes);
  const SdoRemark read = dialogue.from_server({0x1B, 8, 9});
  EXPECT_EQ(read.kind, SdoRemark::Kind::Read);
  EXPECT_EQ(read.bytes, (Octets{1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

// Red when a value counts as written before the server took its last segment.
TEST(SdoDialogue, TellsAValueAsWrittenWithTheLastAcknowledgement) {
  SdoDialogue dialogue;
  EXPECT_TRUE(dialogue.from_client({0x21, 1, 0x20, 3, 9}).bytes.empty());
  EXPECT_EQ(dialogue.from_server({0x60, 1, 0x20, 3}).kind, SdoRemark::Kind::Goes);
  EXPECT_EQ(dialogue.from_client({0x00, 1, 2, 3, 4, 5, 6, 7}).kind, SdoRemark::Kind::Goes);
  EXPECT_EQ(dialogue.from_server({0x20}).kind, SdoRemark::Kind::Goes);
  EXPECT_EQ(dialogue.from_client({0x1B, 8, 9}).kind, SdoRemark::Kind::Goes);
  const SdoRemark written = dialogue.from_server({0x30});
  EXPECT_EQ(written.kind, SdoRemark::Kind::Written);
  EXPECT_EQ(written.bytes, (Octets{1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST(SdoDialogue, FollowsABlockThatIsReadOverItsLosses) {
  SdoDialogue dialogue;
  const SdoRemark reads = dialogue.from_client({0xA4, 1, 0x20, 3, 3});
  EXPECT_EQ(reads.kind, SdoRemark::Kind::Reads);
  EXPECT_EQ(reads.object, kObject);
  EXPECT_EQ(dialogue.from_server({0xC6, 1, 0x20, 3, 16}).kind, SdoRemark::Kind::Goes);
  EXPECT_EQ(dialogue.from_client({0xA3, 1, 1, 1, 1, 1, 1, 1}).kind, SdoRemark::Kind::Goes) << "reserved bytes are free";
  (void)dialogue.from_server({1, 1, 2, 3, 4, 5, 6, 7});
  (void)dialogue.from_server({2, 8, 9, 10, 11, 12, 13, 14});
  (void)dialogue.from_server({0x83, 15, 16});
  EXPECT_EQ(dialogue.from_client({0xA2, 1, 3}).kind, SdoRemark::Kind::Goes) << "the client has the first alone";
  (void)dialogue.from_server({1, 8, 9, 10, 11, 12, 13, 14});
  (void)dialogue.from_server({0x82, 15, 16});
  EXPECT_EQ(dialogue.from_client({0xA2, 2, 3}).kind, SdoRemark::Kind::Goes);
  const SdoRemark read = dialogue.from_server({0xD5});
  EXPECT_EQ(read.kind, SdoRemark::Kind::Read);
  Octets expected(16);
  for (std::size_t i = 0; i < 16; ++i) expected[i] = static_cast<std::uint8_t>(i + 1);
  EXPECT_EQ(read.bytes, expected);
  EXPECT_EQ(dialogue.from_client({0xA1}).kind, SdoRemark::Kind::Unheeded) << "it is over";
}

TEST(SdoDialogue, FollowsABlockThatIsWrittenOverItsLosses) {
  SdoDialogue dialogue;
  const SdoRemark writes = dialogue.from_client({0xC6, 1, 0x20, 3, 16});
  EXPECT_EQ(writes.kind, SdoRemark::Kind::Writes);
  EXPECT_TRUE(writes.bytes.empty());
  EXPECT_EQ(dialogue.from_server({0xA4, 1, 0x20, 3, 2}).kind, SdoRemark::Kind::Goes);
  (void)dialogue.from_client({1, 1, 2, 3, 4, 5, 6, 7});
  (void)dialogue.from_client({2, 9, 9, 9, 9, 9, 9, 9});
  EXPECT_EQ(dialogue.from_server({0xA2, 1, 2}).kind, SdoRemark::Kind::Goes);
  (void)dialogue.from_client({1, 8, 9, 10, 11, 12, 13, 14});
  (void)dialogue.from_client({0x82, 15, 16});
  EXPECT_EQ(dialogue.from_server({0xA2, 2, 2}).kind, SdoRemark::Kind::Goes);
  EXPECT_EQ(dialogue.from_client({0xD5}).kind, SdoRemark::Kind::Goes);
  const SdoRemark written = dialogue.from_server({0xA1});
  EXPECT_EQ(written.kind, SdoRemark::Kind::Written);
  Octets expected(16);
  for (std::size_t i = 0; i < 16; ++i) expected[i] = static_cast<std::uint8_t>(i + 1);
  EXPECT_EQ(written.bytes, expected);
}

TEST(SdoDialogue, HeedsNothingThatBelongsToNoTransfer) {
  for (const std::uint8_t command : Octets{0x00, 0x20, 0x60, 0xA2, 0xC1, 0xE0}) {
    SdoDialogue dialogue;
    const SdoRemark remark = dialogue.from_server({command, 1, 0x20, 3});
    EXPECT_EQ(remark.kind, SdoRemark::Kind::Unheeded) << int{command};
    EXPECT_FALSE(remark.object.has_value());
  }
  for (const std::uint8_t command : Octets{0x00, 0x60, 0xA1, 0xA2, 0xA3, 0xC1, 0xE0}) {
    SdoDialogue dialogue;
    EXPECT_EQ(dialogue.from_client({command, 1, 0x20, 3}).kind, SdoRemark::Kind::Unheeded) << int{command};
  }
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
