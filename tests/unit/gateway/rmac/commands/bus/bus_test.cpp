// The words of `rmac bus`; what it does to nodes is tried on the virtual bench (tests/system).
#include <gmock/gmock.h>

#include "unit/gateway/rmac/command_bench.hpp"

namespace rmac::cli {
namespace {

using testing::HasSubstr;

/// An interface that no computer has.
constexpr const char* kNone = "nocan0";

class BusCommand : public CommandBench {
 protected:
  /// The words are right: the command gets as far as the interface.
  void takes(const std::vector<std::string>& words) {
    const auto failed = run(words);
    EXPECT_EQ(failed.exit_code, 1) << testing::PrintToString(words) << failed.err;
    EXPECT_THAT(failed.err, HasSubstr(kNone)) << testing::PrintToString(words);
  }
  void refuses(const std::vector<std::string>& words) {
    EXPECT_EQ(run(words).exit_code, 2) << testing::PrintToString(words);
  }
};

TEST_F(BusCommand, NeedsNoAppliance) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"bus", "scan", kNone}, {"bus", "lss", "scan", kNone}}) {
    EXPECT_THAT(run_at("/nonexistent/socket", words).err, HasSubstr(kNone));
  }
}

TEST_F(BusCommand, StoresParametersOfANodeThatMayBe) {
  takes({"bus", "store", kNone, "1"});
  takes({"bus", "restore", kNone, "127"});
  refuses({"bus", "store", kNone, "0"});
  refuses({"bus", "restore", kNone, "128"});
  refuses({"bus", "store", kNone});
}

TEST_F(BusCommand, ReadsObjectsOfANodeThatMayBe) {
  for (const char* object : {"6041", "6041:00", "0x6041:0", "6041h"}) {
    takes({"bus", "sdo", "read", kNone, "1", object});
    takes({"bus", "sdo", "read", kNone, "127", object, "u16"});
  }
  for (const char* node : {"0", "128", "x"}) refuses({"bus", "sdo", "read", kNone, node, "6041"});
  refuses({"bus", "sdo", "read", kNone, "1"});
  refuses({"bus", "sdo"});
}

/// Before anything is sent.
TEST_F(BusCommand, SaysWhichWordOfAnObjectIsWrong) {
  const auto error = [this](std::vector<std::string> words) {
    words.insert(words.begin(), {"bus", "sdo"});
    const auto failed = run(words);
    EXPECT_EQ(failed.exit_code, 1) << testing::PrintToString(words);
    return failed.err;
  };
  EXPECT_THAT(error({"read", kNone, "1", "60410"}), HasSubstr("\"60410\" is no object"));
  EXPECT_THAT(error({"read", kNone, "1", "6041", "uint16"}), HasSubstr("\"uint16\" is no data type; there are b, i8"));
  EXPECT_THAT(error({"read", kNone, "1", "6041", "--eds", "/no/such.eds"}), HasSubstr("/no/such.eds"));
  EXPECT_THAT(error({"write", kNone, "1", "6040", "70000"}), HasSubstr("\"70000\" is no UNSIGNED16"));
  EXPECT_THAT(error({"write", kNone, "1", "6040", "-1"}), HasSubstr("\"-1\" is no UNSIGNED16"));
  EXPECT_THAT(error({"write", kNone, "1", "6040", "i8", "1.5"}), HasSubstr("\"1.5\" is no INTEGER8"));
  EXPECT_THAT(error({"write", kNone, "1", "2000", "5"}), HasSubstr("the type of 2000h:00 is unknown here"));
}

TEST_F(BusCommand, WritesAValueWithOrWithoutItsType) {
  takes({"bus", "sdo", "write", kNone, "1", "6071", "-5"});
  takes({"bus", "sdo", "write", kNone, "1", "2000:1", "i32", "-5"});
  takes({"bus", "sdo", "write", kNone, "1", "2000:1", "vs", ""});
  refuses({"bus", "sdo", "write", kNone, "1", "6071"});
}

TEST_F(BusCommand, GivesIdsThatADriveMayHave) {
  takes({"bus", "lss", "assign", kNone, "126"});
  takes({"bus", "lss", "assign", kNone, "5", "--identity", "1", "2", "0x3", "4"});
  refuses({"bus", "lss", "assign", kNone, "127"});
  refuses({"bus", "lss", "assign", kNone, "5", "--identity", "1", "2", "3"});
}

TEST_F(BusCommand, ChangesTheBitRateWithinTheDelayOfTheStandard) {
  takes({"bus", "lss", "bit-rate", kNone, "500000"});
  takes({"bus", "lss", "bit-rate", kNone, "500000", "--delay", "65"});
  refuses({"bus", "lss", "bit-rate", kNone, "500000", "--delay", "65.1"});
  refuses({"bus", "lss", "bit-rate", kNone, "fast"});
}

TEST_F(BusCommand, MovesADriveWithinBoundsAlone) {
  const std::vector<std::string> right{"bus", "move",     kNone,  "5",        "--mode",
                                       "pp",  "--amount", "-100", "--within", "200"};
  takes(right);
  for (const char* mode : {"pp", "pv", "pt", "ip", "csp", "csv", "cst"}) {
    auto words = right;
    words[5] = mode;
    takes(words);
  }
  for (const auto& [place, word] : {std::pair<std::size_t, const char*>{3, "127"},
                                    {5, "homing"},
                                    {7, "99999999999"},
                                    {9, "0"},
                                    {9, "2147483648"}}) {
    auto words = right;
    words[place] = word;
    refuses(words);
  }
  for (const std::size_t left_out : {std::size_t{4}, std::size_t{6}, std::size_t{8}}) {
    auto words = right;
    words.erase(words.begin() + static_cast<std::ptrdiff_t>(left_out),
                words.begin() + static_cast<std::ptrdiff_t>(left_out) + 2);
    refuses(words);
  }
}

TEST_F(BusCommand, RefusesAFolderOfDataSheetsThatIsNotThere) {
  refuses({"bus", "scan", kNone, "--eds", "/nonexistent"});
  takes({"bus", "scan", kNone, "--eds", testing::TempDir()});
}

TEST_F(BusCommand, RefusesAFolderOfDrivesThatIsNotThere) {
  refuses({"bus", "scan", kNone, "--drives", "/nonexistent"});
  takes({"bus", "scan", kNone, "--drives", testing::TempDir()});
  const std::vector<std::string> move{"bus", "move", kNone, "5", "--mode", "pp", "--amount", "1", "--within", "2"};
  for (const auto& [folder, right] :
       {std::pair<std::string, bool>{testing::TempDir(), true}, {"/nonexistent", false}}) {
    auto words = move;
    words.insert(words.end(), {"--drives", folder});
    right ? takes(words) : refuses(words);
  }
}

TEST_F(BusCommand, SaysWhichFileItCannotReadTheLoadOf) {
  EXPECT_THAT(run({"bus", "load", "/nonexistent.json"}).err, HasSubstr("/nonexistent.json"));
  refuses({"bus", "load", "f.json", "--period", "0.00009"});
  refuses({"bus", "load", "f.json", "--period", "0.11"});
}

}  // namespace
}  // namespace rmac::cli
