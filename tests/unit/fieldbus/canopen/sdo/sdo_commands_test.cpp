// Which answers a transfer takes: each of the 256 command bytes in each of its phases (CiA 301, 7.2.4.3).
#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "rmac/fieldbus/canopen/sdo_download.hpp"
#include "rmac/fieldbus/canopen/sdo_upload.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using Kind = SdoStep::Kind;

constexpr ObjectAddress kAsked{0x2001, 3};
constexpr std::size_t kNoBlocks = 100'000;

std::vector<std::uint8_t> counting(std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{1});
  return bytes;
}
SdoBytes answer_of(int command, const SdoBytes& rest = {}) {
  SdoBytes answer = rest;
  answer[0] = static_cast<std::uint8_t>(command);
  return answer;
}
/// The server's command specifier, and the subcommand of block transfers.
int specifier(int command) {
  return command >> 5;
}
int subcommand(int command) {
  return command & 3;
}
bool is_aborted(const SdoStep& step, std::uint32_t code) {
  return step.kind == Kind::Abort && step.abort_code == code;
}

TEST(SdoUploadCommands, OfTheFirstAnswerAreThoseOfAnUpload) {
  for (int command = 0; command < 256; ++command) {
    std::vector<std::uint8_t> into(8);
    SdoUpload upload(kNoBlocks, 127);
    (void)upload.begin(kAsked, into);
    const SdoStep step = upload.take(answer_of(command, {0, 1, 0x20, 3, 8}));
    if (specifier(command) != 2) {
      EXPECT_TRUE(is_aborted(step, sdo_abort::kCommand)) << command;
    } else if ((command & 2) != 0) {
      EXPECT_EQ(step.kind, Kind::Done) << command;
      EXPECT_EQ(upload.size(), (command & 1) != 0 ? 4U - static_cast<unsigned>(command >> 2 & 3) : 4U) << command;
    } else {
      EXPECT_EQ(step.kind, Kind::Send) << command;
      EXPECT_EQ(step.bytes, SdoBytes{0x60}) << command;
    }
  }
}

TEST(SdoUploadCommands, OfASegmentAreItsToggleBitItsLengthAndWhetherItIsTheLast) {
  for (int command = 0; command < 256; ++command) {
    std::vector<std::uint8_t> into(30);
    SdoUpload upload(kNoBlocks, 127);
    (void)upload.begin(kAsked, into);
    (void)upload.take({0x40, 1, 0x20, 3});  // without a size
    (void)upload.take({0x00, 1, 2, 3, 4, 5, 6, 7});
    const SdoStep step = upload.take(answer_of(command, {0, 8, 9, 10, 11, 12, 13, 14}));
    if (specifier(command) != 0) {
      EXPECT_TRUE(is_aborted(step, sdo_abort::kCommand)) << command;
    } else if ((command & 0x10) == 0) {
      EXPECT_TRUE(is_aborted(step, sdo_abort::kToggle)) << command;
    } else {
      EXPECT_EQ(step.kind, (command & 1) != 0 ? Kind::Done : Kind::Send) << command;
      EXPECT_EQ(upload.size(), 14U - static_cast<unsigned>(command >> 1 & 7)) << command;
    }
  }
}

TEST(SdoUploadCommands, OfABlockMayBeThoseOfAnOrdinaryUpload) {
  for (int command = 0; command < 256; ++command) {
    std::vector<std::uint8_t> into(30);
    SdoUpload upload(30, 127);
    EXPECT_EQ(upload.begin(kAsked, into).bytes[0], 0xA4);
    const SdoStep step = upload.take(answer_of(command, {0, 1, 0x20, 3, 8}));
    const bool ordinary = specifier(command) == 2, block = specifier(command) == 6 && (command & 1) == 0;
    EXPECT_EQ(is_aborted(step, sdo_abort::kCommand), !ordinary && !block) << command;
    if (block) {
      EXPECT_EQ(step.bytes, SdoBytes{0xA3}) << command;
    }
    if (ordinary && (command & 2) == 0) {
      EXPECT_EQ(step.bytes, SdoBytes{0x60}) << command;
    }
  }
}

TEST(SdoUploadCommands, OfTheEndOfABlockTellHowMuchOfTheLastSegmentCounts) {
  for (int command = 0; command < 256; ++command) {
    std::vector<std::uint8_t> into(30);
    SdoUpload upload(30, 127);
    (void)upload.begin(kAsked, into);
    (void)upload.take({0xC0, 1, 0x20, 3});  // neither size nor checksum
    (void)upload.take({0x81, 1, 2, 3, 4, 5, 6, 7});
    const SdoStep step = upload.take(answer_of(command, {0, 0xAA, 0xBB}));
    if (specifier(command) != 6 || subcommand(command) != 1) {
      EXPECT_TRUE(is_aborted(step, sdo_abort::kCommand)) << command;
    } else {
      EXPECT_EQ(step.kind, Kind::SendAndDone) << command << ": there is no checksum to be wrong";
      EXPECT_EQ(upload.size(), 7U - static_cast<unsigned>(command >> 2 & 7)) << command;
    }
  }
}

TEST(SdoUpload, TakesChecksumAndSizeOfABlockForWhatTheyAre) {
  const auto end_of = [](int initiate, std::uint32_t size, std::uint16_t checksum) {
    std::vector<std::uint8_t> into(30);
    SdoUpload upload(30, 127);
    (void)upload.begin(kAsked, into);
    SdoBytes first = answer_of(initiate, {0, 1, 0x20, 3});
    put_long(&first[4], size);
    if (const SdoStep begun = upload.take(first); begun.kind == Kind::Abort) return begun;
    (void)upload.take({0x81, '1', '2', '3', '4', '5', '6', '7'});
    SdoBytes end{0xC1};
    put_word(&end[1], checksum);
    return upload.take(end);
  };
  const std::vector<std::uint8_t> digits{'1', '2', '3', '4', '5', '6', '7'};
  const std::uint16_t right = sdo_crc(digits);
  EXPECT_EQ(end_of(0xC6, 7, right).kind, Kind::SendAndDone);
  EXPECT_TRUE(is_aborted(end_of(0xC6, 7, right ^ 0x0100U), sdo_abort::kCrc));
  EXPECT_EQ(end_of(0xC2, 7, right ^ 0x0100U).kind, Kind::SendAndDone) << "the server makes none";
  EXPECT_TRUE(is_aborted(end_of(0xC6, 8, right), sdo_abort::kLength));
  EXPECT_TRUE(is_aborted(end_of(0xC6, 6, right), sdo_abort::kLength));
  EXPECT_EQ(end_of(0xC4, 6, right).kind, Kind::SendAndDone) << "it told no size";
  EXPECT_TRUE(is_aborted(end_of(0xC6, 31, right), sdo_abort::kMemory)) << "more than there is room for";
  EXPECT_TRUE(is_aborted(end_of(0xC6, 30, right), sdo_abort::kLength)) << "as much as there is room for";
}

TEST(SdoUpload, TakesNoSegmentOfABlockBeyondWhatItAskedFor) {
  for (int sequence = 0; sequence < 128; ++sequence) {
    for (const int last : {0, 0x80}) {
      std::vector<std::uint8_t> into(30);
      SdoUpload upload(30, 5);
      (void)upload.begin(kAsked, into);
      (void)upload.take({0xC0, 1, 0x20, 3});
      const SdoStep step = upload.take(answer_of(sequence | last));
      EXPECT_EQ(is_aborted(step, sdo_abort::kSequence), sequence == 0 || sequence > 5) << sequence;
      if (sequence == 0 || sequence > 5) continue;
      const bool answers = last != 0 || sequence == 5;
      EXPECT_EQ(step.kind, answers ? Kind::Send : Kind::Wait) << sequence;
      if (answers) {
        const std::uint8_t in_order = sequence == 1 ? 1 : 0;
        EXPECT_EQ(step.bytes, (SdoBytes{0xA2, in_order, 5}));
      }
    }
  }
}

// Red when the last segment of a block, lost and sent again, ends the transfer or is stored twice.
TEST(SdoUpload, GoesOnUntilTheLastSegmentCameInOrder) {
  std::vector<std::uint8_t> into(30);
  SdoUpload upload(30, 2);
  (void)upload.begin(kAsked, into);
  (void)upload.take({0xC0, 1, 0x20, 3});
  EXPECT_EQ(upload.take({0x82, 8, 9}).bytes, (SdoBytes{0xA2, 0, 2})) << "the first is lost";
  EXPECT_EQ(upload.take({0x01, 1, 2, 3, 4, 5, 6, 7}).kind, Kind::Wait);
  EXPECT_EQ(upload.take({0x82, 8, 9}).bytes, (SdoBytes{0xA2, 2, 2}));
  EXPECT_EQ(upload.take({0xD5}).kind, Kind::SendAndDone);
  EXPECT_EQ(upload.size(), 9U);
  into.resize(9);
  EXPECT_EQ(into, counting(9));
}

TEST(SdoUpload, TriesBlocksFromSoManyBytesOfRoomOn) {
  for (const std::size_t room : {1U, 28U, 29U, 300U}) {
    for (const std::size_t from : {29U, 256U, 257U, 300U}) {
      std::vector<std::uint8_t> into(room);
      SdoUpload upload(from, 7);
      const SdoStep step = upload.begin(kAsked, into);
      const bool blocks = room >= from;
      EXPECT_EQ(upload.tries_blocks(), blocks) << room << " from " << from;
      EXPECT_TRUE(upload.initiating());
      const auto ordinary_up_to = static_cast<std::uint8_t>(std::min<std::size_t>(from - 1, 255));
      EXPECT_EQ(step.bytes, blocks ? (SdoBytes{0xA4, 1, 0x20, 3, 7, ordinary_up_to}) : (SdoBytes{0x40, 1, 0x20, 3}));
    }
  }
}

TEST(SdoUpload, TakesOfAnAnswerWithoutSizeAsMuchAsThereIsRoomFor) {
  for (const std::size_t room : {1U, 2U, 3U, 4U, 5U}) {
    std::vector<std::uint8_t> into(room);
    SdoUpload upload(kNoBlocks, 7);
    (void)upload.begin(kAsked, into);
    EXPECT_EQ(upload.take({0x42, 1, 0x20, 3, 1, 2, 3, 4}).kind, Kind::Done);
    EXPECT_EQ(upload.size(), std::min<std::size_t>(room, 4));
    into.resize(upload.size());
    EXPECT_EQ(into, counting(upload.size()));
  }
}

TEST(SdoUpload, BeginsEachTransferAsIfItWereTheFirst) {
  std::vector<std::uint8_t> into(30);
  SdoUpload upload(29, 2);
  (void)upload.begin(kAsked, into);
  (void)upload.take({0x41, 1, 0x20, 3, 20});
  (void)upload.take({0x00, 1, 2, 3, 4, 5, 6, 7});
  EXPECT_EQ(upload.begin(kAsked, into).bytes, (SdoBytes{0xA4, 1, 0x20, 3, 2, 28}));
  EXPECT_EQ(upload.size(), 0U);
  EXPECT_EQ(upload.take({0x40, 1, 0x20, 3}).bytes, SdoBytes{0x60}) << "its toggle bit, too";
  EXPECT_EQ(upload.take({0x01, 1, 2, 3, 4, 5, 6, 7}).kind, Kind::Done);
}

TEST(SdoDownloadCommands, OfEachPhaseAreTakenAndNoOthers) {
  for (int command = 0; command < 256; ++command) {
    const auto data = counting(30);
    SdoDownload expedited(kNoBlocks);
    (void)expedited.begin(kAsked, {data.data(), 4});
    EXPECT_EQ(expedited.take(answer_of(command)).kind, specifier(command) == 3 ? Kind::Done : Kind::Abort) << command;

    SdoDownload segmented(kNoBlocks);
    (void)segmented.begin(kAsked, data);
    EXPECT_EQ(segmented.take(answer_of(command)).kind, specifier(command) == 3 ? Kind::Send : Kind::Abort) << command;
    (void)segmented.begin(kAsked, data);
    (void)segmented.take({0x60});
    const SdoStep step = segmented.take(answer_of(command));
    if (specifier(command) != 1) {
      EXPECT_TRUE(is_aborted(step, sdo_abort::kCommand)) << command;
    } else if ((command & 0x10) != 0) {
      EXPECT_TRUE(is_aborted(step, sdo_abort::kToggle)) << command;
    } else {
      EXPECT_EQ(step.bytes, (SdoBytes{0x10, 8, 9, 10, 11, 12, 13, 14})) << command;
    }

    SdoDownload block(30);
    (void)block.begin(kAsked, data);
    const bool begins = specifier(command) == 5 && subcommand(command) == 0;
    EXPECT_EQ(block.take(answer_of(command, {0, 1, 0x20, 3, 5})).kind, begins ? Kind::Wait : Kind::Abort) << command;
    EXPECT_EQ(block.streams(), begins);
    (void)block.begin(kAsked, data);
    (void)block.take({0xA0, 1, 0x20, 3, 5});
    for (int segment = 0; segment < 5; ++segment) (void)block.next_segment();
    const bool acknowledges = specifier(command) == 5 && subcommand(command) == 2;
    EXPECT_EQ(block.take(answer_of(command, {0, 5, 5})).kind, acknowledges ? Kind::Send : Kind::Abort) << command;
    if (!acknowledges) (void)block.take({0xA2, 5, 5});
    const bool ends = specifier(command) == 5 && subcommand(command) == 1;
    EXPECT_EQ(block.take(answer_of(command)).kind, ends ? Kind::Done : Kind::Abort) << command;
  }
}

TEST(SdoDownload, TriesBlocksFromSoManyBytesOnThatDoNotFitTheFirstFrame) {
  for (std::size_t size = 0; size <= 40; ++size) {
    for (const std::size_t from : {1U, 4U, 5U, 29U}) {
      const auto data = counting(size);
      SdoDownload download(from);
      const SdoStep step = download.begin(kAsked, data);
      const bool blocks = size > 4 && size >= from;
      EXPECT_EQ(download.tries_blocks(), blocks) << size << " from " << from;
      EXPECT_TRUE(download.initiating());
      const auto all = static_cast<std::uint8_t>(size);
      if (blocks) {
        EXPECT_EQ(step.bytes, (SdoBytes{0xC6, 1, 0x20, 3, all}));
      } else if (size == 0 || size > 4) {
        EXPECT_EQ(step.bytes, (SdoBytes{0x21, 1, 0x20, 3, all}));
      } else {
        SdoBytes expected{static_cast<std::uint8_t>(0x23 + 4 * (4 - size)), 1, 0x20, 3};
        std::copy(data.begin(), data.end(), expected.begin() + 4);
        EXPECT_EQ(step.bytes, expected);
      }
    }
  }
}

TEST(SdoDownload, MarksTheLastSegmentAndWhatOfItCounts) {
  for (std::size_t size = 5; size <= 40; ++size) {
    const auto data = counting(size);
    SdoDownload download(kNoBlocks);
    (void)download.begin(kAsked, data);
    SdoStep step = download.take({0x60});
    for (std::size_t at = 0; at < size; at += 7) {
      const std::size_t here = std::min<std::size_t>(7, size - at);
      const std::size_t toggle = at / 7 % 2;
      SdoBytes expected{static_cast<std::uint8_t>(0x10 * toggle + 2 * (7 - here) + (at + here == size ? 1 : 0))};
      std::copy_n(data.begin() + static_cast<std::ptrdiff_t>(at), here, expected.begin() + 1);
      ASSERT_EQ(step.bytes, expected) << size << " bytes, from " << at;
      step = download.take(answer_of(static_cast<int>(0x20 + 0x10 * toggle)));
    }
    EXPECT_EQ(step.kind, Kind::Done);
  }
}

TEST(SdoDownload, EndsABlockWithWhatOfItsLastSegmentCountsAndItsChecksumWhereItIsWanted) {
  for (std::size_t size = 5; size <= 40; ++size) {
    for (const bool checked : {true, false}) {
      const auto data = counting(size);
      SdoDownload download(5);
      (void)download.begin(kAsked, data);
      (void)download.take({static_cast<std::uint8_t>(checked ? 0xA4 : 0xA0), 1, 0x20, 3, 127});
      std::uint8_t segments = 0;
      for (bool last = false; !last; ++segments) {
        ASSERT_TRUE(download.streams());
        const SdoBytes segment = download.next_segment();
        EXPECT_EQ(segment[0] & 0x7F, segments + 1);
        last = (segment[0] & 0x80) != 0;
      }
      EXPECT_FALSE(download.streams());
      EXPECT_EQ(segments, (size + 6) / 7);
      const SdoStep end = download.take({0xA2, segments, 127});
      SdoBytes expected{static_cast<std::uint8_t>(0xC1 + 4 * (segments * 7U - size))};
      if (checked) put_word(&expected[1], sdo_crc(data));
      EXPECT_EQ(end.bytes, expected) << size;
    }
  }
}

TEST(SdoDownload, RefusesBlocksOfASizeThatThereIsNot) {
  for (int size = 0; size < 256; ++size) {
    const auto data = counting(30);
    const auto told = static_cast<std::uint8_t>(size);
    const bool sound = size >= 1 && size <= 127;
    SdoDownload download(5);
    (void)download.begin(kAsked, data);
    EXPECT_EQ(is_aborted(download.take({0xA0, 1, 0x20, 3, told}), sdo_abort::kBlockSize), !sound) << size;
    (void)download.begin(kAsked, data);
    (void)download.take({0xA0, 1, 0x20, 3, 1});
    (void)download.next_segment();
    EXPECT_EQ(is_aborted(download.take({0xA2, 1, told}), sdo_abort::kBlockSize), !sound) << size;
    // The new size counts from the next block on.
    for (int segment = 1; sound && download.streams(); ++segment) {
      const bool last = (download.next_segment()[0] & 0x80) != 0;
      EXPECT_EQ(download.streams(), !last && segment < size) << size;
    }
  }
}

TEST(SdoDownload, RefusesAnAcknowledgementOfMoreThanWasSent) {
  for (std::uint8_t taken = 0; taken < 5; ++taken) {
    const auto data = counting(30);
    SdoDownload download(5);
    (void)download.begin(kAsked, data);
    (void)download.take({0xA0, 1, 0x20, 3, 3});
    for (int segment = 0; segment < 3; ++segment) (void)download.next_segment();
    EXPECT_EQ(is_aborted(download.take({0xA2, taken, 3}), sdo_abort::kSequence), taken > 3) << int{taken};
    if (taken <= 3) {
      EXPECT_EQ(download.next_segment()[1], 7 * taken + 1) << "it goes on from there";
    }
  }
}

// Red when a server that takes a little now and then is given up.
TEST(SdoDownload, CountsOnlyBlocksInARowOfWhichNothingWasTaken) {
  const auto data = counting(100);
  SdoDownload download(5);
  (void)download.begin(kAsked, data);
  (void)download.take({0xA0, 1, 0x20, 3, 1});
  for (int round = 0; round < 5; ++round) {
    for (const std::uint8_t taken : {std::uint8_t{0}, std::uint8_t{0}, std::uint8_t{1}}) {
      (void)download.next_segment();
      ASSERT_EQ(download.take({0xA2, taken, 1}).kind, Kind::Wait) << round;
    }
  }
}

TEST(SdoDownload, BeginsAgainWithoutBlocksFromItsFirstByte) {
  const auto data = counting(30);
  SdoDownload download(5);
  (void)download.begin(kAsked, data);
  EXPECT_TRUE(download.tries_blocks());
  EXPECT_EQ(download.begin_without_blocks().bytes, (SdoBytes{0x21, 1, 0x20, 3, 30}));
  EXPECT_FALSE(download.tries_blocks());
  EXPECT_EQ(download.take({0x60}).bytes, (SdoBytes{0, 1, 2, 3, 4, 5, 6, 7}));
  // And another one from its own.
  EXPECT_EQ(download.begin(kAsked, data).bytes, (SdoBytes{0xC6, 1, 0x20, 3, 30}));
  (void)download.begin_without_blocks();
  EXPECT_EQ(download.take({0x60}).bytes, (SdoBytes{0, 1, 2, 3, 4, 5, 6, 7}));
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
