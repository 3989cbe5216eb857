#include "gateway/simulators/vdrive/error_log.hpp"

#include "unit/gateway/simulators/vdrive/node_bench.hpp"

namespace rmac::vdrive::test {
namespace {

struct Log {
  Dictionary dictionary{sheet(), 5};
  ErrorLog errors{dictionary};
};

constexpr std::int64_t kGeneric = 0x01, kTemperature = 0x08, kCommunication = 0x10;

TEST(ErrorLog, CollectsTheKindsOfErrorsInTheRegisterUntilAllAreGone) {
  Log log;
  log.errors.note(0x7305);
  EXPECT_EQ(log.dictionary.number(0x1001), kGeneric);
  log.errors.note(0x4310);
  EXPECT_EQ(log.dictionary.number(0x1001), kGeneric | kTemperature);
  log.errors.note(0x8130);
  EXPECT_EQ(log.dictionary.number(0x1001), kGeneric | kTemperature | kCommunication);
  log.errors.note(0);
  EXPECT_EQ(log.dictionary.number(0x1001), 0);
}

TEST(ErrorLog, AFollowingErrorIsNoneOfTheCommunication) {
  Log log;
  log.errors.note(0x8611);
  EXPECT_EQ(log.dictionary.number(0x1001), kGeneric);
}

TEST(ErrorLog, ListsTheLatestFirstAndEightAtMost) {
  Log log;
  for (int i = 1; i <= 9; ++i) log.errors.note(static_cast<std::uint16_t>(0x7300 + i));
  EXPECT_EQ(log.dictionary.number(0x1003), 8);
  EXPECT_EQ(log.dictionary.number(0x1003, 1), 0x7309);
  EXPECT_EQ(log.dictionary.number(0x1003, 8), 0x7302);
  log.errors.note(0);
  EXPECT_EQ(log.dictionary.number(0x1003, 1), 0x7309) << "a reset is no error";
  log.errors.clear_list();
  EXPECT_EQ(log.dictionary.number(0x1003, 1), 0);
}

TEST(ErrorLog, KeepsWhatIsWrongWithTheDriveOverAResetOfTheCommunication) {
  Log log;
  log.errors.note(0x8130);
  log.errors.reset_communication(true);
  EXPECT_EQ(log.dictionary.number(0x1001), kGeneric);
  log.errors.reset_communication(false);
  EXPECT_EQ(log.dictionary.number(0x1001), 0);
}

TEST(ErrorLog, PutsCodeAndRegisterIntoAnEmergency) {
  Log log;
  log.errors.note(0x4310);
  EXPECT_EQ(log.errors.emergency(0x4310), (Bytes{0x10, 0x43, 0x09, 0, 0, 0, 0, 0}));
}

}  // namespace
}  // namespace rmac::vdrive::test
