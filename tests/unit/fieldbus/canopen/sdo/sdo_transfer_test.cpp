// The steps of reading and of writing an object, frame by frame as CiA 301 draws them.
#include <gtest/gtest.h>

#include <numeric>

#include "rmac/fieldbus/canopen/sdo_download.hpp"
#include "rmac/fieldbus/canopen/sdo_upload.hpp"

namespace {

using namespace rmac::fieldbus;
using namespace rmac::fieldbus::canopen;
using Kind = SdoStep::Kind;

constexpr ObjectAddress kObject{0x2001, 3};
constexpr std::size_t kNoBlocks = 100'000;

std::vector<std::uint8_t> counting(std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{1});
  return bytes;
}

TEST(SdoUpload, ReadsUpToFourBytesAtOnce) {
  std::array<std::uint8_t, 4> into{};
  SdoUpload upload(kNoBlocks, 127);
  const SdoStep request = upload.begin(kObject, into);
  EXPECT_EQ(request.kind, Kind::Send);
  EXPECT_EQ(request.bytes, (SdoBytes{0x40, 0x01, 0x20, 3}));
  EXPECT_TRUE(upload.initiating());
  EXPECT_EQ(upload.take({0x4B, 0x01, 0x20, 3, 0xAA, 0xBB, 0xCC, 0xDD}).kind, Kind::Done);
  EXPECT_EQ(upload.size(), 2U) << "as many as the server says";
  EXPECT_EQ(into, (std::array<std::uint8_t, 4>{0xAA, 0xBB, 0, 0}));
}

TEST(SdoUpload, ReadsSegmentsByTurnsOfTheToggleBit) {
  std::array<std::uint8_t, 9> into{};
  SdoUpload upload(kNoBlocks, 127);
  EXPECT_EQ(upload.begin(kObject, into).kind, Kind::Send);
  EXPECT_EQ(upload.take({0x41, 0x01, 0x20, 3, 9}).bytes, SdoBytes{0x60});
  EXPECT_FALSE(upload.initiating());
  EXPECT_EQ(upload.take({0x00, 1, 2, 3, 4, 5, 6, 7}).bytes, SdoBytes{0x70});
  EXPECT_EQ(upload.take({0x1B, 8, 9}).kind, Kind::Done);
  EXPECT_EQ(upload.size(), 9U);
  EXPECT_EQ(into[8], 9);
}

TEST(SdoUpload, RefusesWhatIsAgainstTheProtocolOrDoesNotFit) {
  std::array<std::uint8_t, 9> into{};
  SdoUpload upload(kNoBlocks, 127);
  EXPECT_EQ(upload.begin(kObject, into).kind, Kind::Send);
  EXPECT_EQ(upload.take({0x60}).abort_code, sdo_abort::kCommand);
  EXPECT_EQ(upload.begin(kObject, into).kind, Kind::Send);
  EXPECT_EQ(upload.take({0x41, 0x01, 0x20, 3, 10}).abort_code, sdo_abort::kMemory) << "more than there is room for";
  EXPECT_EQ(upload.begin(kObject, into).kind, Kind::Send);
  EXPECT_EQ(upload.take({0x41, 0x01, 0x20, 3, 9}).kind, Kind::Send);
  EXPECT_EQ(upload.take({0x10}).abort_code, sdo_abort::kToggle);
  EXPECT_EQ(upload.begin(kObject, into).kind, Kind::Send);
  EXPECT_EQ(upload.take({0x41, 0x01, 0x20, 3, 9}).kind, Kind::Send);
  EXPECT_EQ(upload.take({0x01, 1, 2, 3, 4, 5, 6, 7}).abort_code, sdo_abort::kLength) << "it announced nine";
}

TEST(SdoUpload, AcknowledgesABlockUpToTheSegmentThatIsMissing) {
  std::array<std::uint8_t, 40> into{};
  SdoUpload upload(29, 3);
  const SdoStep request = upload.begin(kObject, into);
  EXPECT_EQ(request.bytes, (SdoBytes{0xA4, 0x01, 0x20, 3, 3, 28}));
  EXPECT_TRUE(upload.tries_blocks());
  EXPECT_EQ(upload.take({0xC2, 0x01, 0x20, 3, 13}).bytes, SdoBytes{0xA3});
  EXPECT_EQ(upload.take({1, 1, 2, 3, 4, 5, 6, 7}).kind, Kind::Wait);
  EXPECT_EQ(upload.take({3, 0}).bytes, (SdoBytes{0xA2, 1, 3})) << "the second is lost";
  EXPECT_EQ(upload.take({0x81, 8, 9, 10, 11, 12, 13, 0}).bytes, (SdoBytes{0xA2, 1, 3}));
  const SdoStep end = upload.take({0xC5});
  EXPECT_EQ(end.kind, Kind::SendAndDone);
  EXPECT_EQ(end.bytes, SdoBytes{0xA1});
  EXPECT_EQ(upload.size(), 13U) << "one byte of the last segment does not count";
  EXPECT_EQ(into[12], 13);
}

TEST(SdoUpload, BeginsAgainWithoutBlocks) {
  std::array<std::uint8_t, 40> into{};
  SdoUpload upload(29, 3);
  EXPECT_TRUE(upload.begin(kObject, into).bytes[0] == 0xA4);
  EXPECT_EQ(upload.begin_without_blocks().bytes, (SdoBytes{0x40, 0x01, 0x20, 3}));
  EXPECT_FALSE(upload.tries_blocks());
}

TEST(SdoDownload, WritesUpToFourBytesAtOnce) {
  const auto data = counting(3);
  SdoDownload download(kNoBlocks);
  EXPECT_EQ(download.begin(kObject, data).bytes, (SdoBytes{0x27, 0x01, 0x20, 3, 1, 2, 3}));
  EXPECT_EQ(download.take({0x60, 0x01, 0x20, 3}).kind, Kind::Done);
}

TEST(SdoDownload, WritesSegmentsByTurnsOfTheToggleBitAndMarksTheLast) {
  const auto data = counting(9);
  SdoDownload download(kNoBlocks);
  EXPECT_EQ(download.begin(kObject, data).bytes, (SdoBytes{0x21, 0x01, 0x20, 3, 9}));
  EXPECT_EQ(download.take({0x60, 0x01, 0x20, 3}).bytes, (SdoBytes{0x00, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(download.take({0x20}).bytes, (SdoBytes{0x1B, 8, 9}));
  EXPECT_EQ(download.take({0x20}).abort_code, sdo_abort::kToggle);
}

TEST(SdoDownload, SendsABlockAgainFromWhatTheServerTook) {
  const auto data = counting(30);
  SdoDownload download(29);
  EXPECT_EQ(download.begin(kObject, data).bytes, (SdoBytes{0xC6, 0x01, 0x20, 3, 30}));
  EXPECT_EQ(download.take({0xA0, 0x01, 0x20, 3, 3}).kind, Kind::Wait);
  for (const int sequence : {1, 2, 3}) {
    EXPECT_TRUE(download.streams());
    const SdoBytes segment = download.next_segment();
    EXPECT_EQ(segment[0], sequence);
    EXPECT_EQ(segment[1], (sequence - 1) * 7 + 1);
  }
  EXPECT_FALSE(download.streams()) << "the server answers each block";
  EXPECT_EQ(download.take({0xA2, 2, 127}).kind, Kind::Wait);
  EXPECT_EQ(download.next_segment()[1], 15) << "the third comes again, as the first";
  EXPECT_EQ(download.next_segment()[1], 22);
  EXPECT_EQ(download.next_segment()[0], 0x83) << "the last";
  const SdoStep end = download.take({0xA2, 3, 127});
  EXPECT_EQ(end.kind, Kind::Send);
  EXPECT_EQ(end.bytes[0], 0xD5) << "five of its bytes do not count";
  EXPECT_EQ(download.take({0xA1}).kind, Kind::Done);
}

TEST(SdoDownload, GivesUpOnAServerThatTakesNothing) {
  const auto data = counting(30);
  SdoDownload download(29);
  EXPECT_EQ(download.begin(kObject, data).kind, Kind::Send);
  EXPECT_EQ(download.take({0xA0, 0x01, 0x20, 3, 1}).kind, Kind::Wait);
  for (int block = 1; block <= 3; ++block) {
    ASSERT_TRUE(download.streams());
    static_cast<void>(download.next_segment());
    const SdoStep step = download.take({0xA2, 0, 1});
    EXPECT_EQ(step.kind, block < 3 ? Kind::Wait : Kind::Abort);
  }
}

}  // namespace
