#include "rmac/fieldbus/can/candump_log.hpp"

#include <gmock/gmock.h>

#include <random>

namespace {

using namespace rmac::fieldbus;
using Kind = LoggedFrame::Kind;
using testing::HasSubstr;

LoggedFrame read(std::string_view line) {
  const auto logged = read_log_line(line);
  EXPECT_TRUE(logged.has_value()) << line;
  return logged.value_or(LoggedFrame());
}

TEST(CandumpLog, ReadsBackWhatItWrites) {
  std::mt19937 random(11);
  for (int i = 0; i < 2000; ++i) {
    LoggedFrame written;
    written.interface = i % 2 == 0 ? "can0" : "vcan12";
    written.frame.id = static_cast<std::uint16_t>(random() & 0x7FF);
    written.frame.size = static_cast<std::uint8_t>(random() % 9);
    for (std::size_t b = 0; b < written.frame.size; ++b) written.frame.data[b] = static_cast<std::uint8_t>(random());
    written.frame.stamp = std::chrono::microseconds(std::uint64_t{random()} << 18U | random() % 1000);
    const std::string line = to_log_line(written);
    const LoggedFrame logged = read(line);
    EXPECT_EQ(logged.kind, Kind::Data) << line;
    EXPECT_EQ(logged.frame, written.frame) << line;
    EXPECT_EQ(logged.frame.stamp, written.frame.stamp) << line;
    EXPECT_EQ(logged.interface, written.interface) << line;
  }
}

TEST(CandumpLog, WritesAsCandumpDoes) {
  LoggedFrame logged;
  logged.interface = "can0";
  logged.frame = {.id = 0x81, .size = 2, .data = {0xAA, 0x0B}, .stamp = std::chrono::microseconds(1436509052249713)};
  EXPECT_EQ(to_log_line(logged), "(1436509052.249713) can0 081#AA0B");
}

TEST(CandumpLog, ReadsWhatCandumpShowsOnATerminal) {
  const CanFrame wanted{.id = 0x181, .size = 2, .data = {0xAA, 0xBB}};
  for (const char* line :
       {"  can0  181   [2]  AA BB", " (1436509052.249713)  can0  181   [2]  AA BB", "can0  181   [2]  AA BB   '..'",
        "  can0  181   [2]  AA BB\r", " (2026-11-24 10:00:00.000001)  can0  181   [2]  AA BB"}) {
    const LoggedFrame logged = read(line);
    EXPECT_EQ(logged.frame, wanted) << line;
    EXPECT_EQ(logged.interface, "can0") << line;
  }
  EXPECT_EQ(read(" (1436509052.249713)  can0  181   [0]").frame.stamp, std::chrono::microseconds(1436509052249713));
  EXPECT_EQ(read("(2026-11-24 10:00:00.000001) can0 181 [0]").frame.stamp.count(), 0) << "of which zone?";
}

TEST(CandumpLog, TakesTheEndsOfOtherProgramsAndSystems) {
  const CanFrame wanted{.id = 0x181, .size = 2, .data = {0xAA, 0xBB}};
  for (const char* line :
       {"(1.0) can0 181#AABB\r", "(1.0) can0 181#AABB R", "(1.0) can0 181#aabb", "(1.0) can0 181#AA.BB",
        "(1.0)\tcan0\t181#AABB", "can0 181#AABB", "(1.0) can0 181#AABB  TPDO1 node 1: words"}) {
    EXPECT_EQ(read(line).frame, wanted) << line;
  }
  EXPECT_EQ(read("(1.0) can0 181#1122334455667788_E").frame.size, 8);
}

TEST(CandumpLog, TellsFramesThatCanopenDoesNotUse) {
  EXPECT_EQ(read("(1.0) can0 701#R").kind, Kind::Remote);
  EXPECT_EQ(read("(1.0) can0 701#R1").kind, Kind::Remote);
  EXPECT_EQ(read("can0 701 [1] remote request").kind, Kind::Remote);
  EXPECT_EQ(read("(1.0) can0 18FF1234#AABB").kind, Kind::Extended);
  EXPECT_EQ(read("(1.0) can0 18FF1234#R").kind, Kind::Extended);
  EXPECT_EQ(read("(1.0) can0 00000181#AABB").kind, Kind::Extended) << "by its digits, not by its number";
  EXPECT_EQ(read("(1.0) can0 123##1AABBCCDDEEFF00112233").kind, Kind::Fd);
  EXPECT_EQ(read("can0  123  [12]  AA BB CC DD EE FF 00 11 22 33 44 55").kind, Kind::Fd);
  EXPECT_EQ(foreign_frame_text(read("(1.0) can0 20000040#0000000000000000")), "error frame: bus-off");
  EXPECT_THAT(foreign_frame_text(read("can0  20000024   [8]  00 04 00 00 00 00 00 00   ERRORFRAME")),
              HasSubstr("controller, no acknowledgement"));
}

TEST(CandumpLog, NamesFramesThatCanopenDoesNotUse) {
  EXPECT_EQ(foreign_frame_text(read("(1.0) can0 181#AABB")), "") << "it uses these";
  EXPECT_EQ(read("(1.0) can0 20000040#0000000000000000").id, 0x40U) << "the classes alone";
  EXPECT_EQ(read("(1.0) can0 98FF1234#AA").id, 0x18FF1234U) << "with the flag of the kernel's frames";
  EXPECT_EQ(foreign_frame_text(read("(1.0) can0 701#R")), "remote frame 701h");
  EXPECT_EQ(foreign_frame_text(read("(1.0) can0 00000181#AABB")),
            "29-bit identifier 00000181h, which CANopen does not use");
  EXPECT_EQ(foreign_frame_text(read("(1.0) can0 123##1AABB")), "CAN FD frame 123h, which CANopen does not use");
  // The classes of linux/can/error.h, bit by bit.
  const std::vector<const char*> classes{
      "sending timed out",  "lost arbitration", "controller", "protocol violation",  "transceiver",
      "no acknowledgement", "bus-off",          "bus error",  "controller restarted"};
  for (std::size_t bit = 0; bit < classes.size(); ++bit) {
    LoggedFrame error;
    error.kind = Kind::Error;
    error.id = 1U << bit;
    EXPECT_EQ(foreign_frame_text(error), std::string("error frame: ") + classes[bit]);
  }
  LoggedFrame error;
  error.kind = Kind::Error;
  EXPECT_EQ(foreign_frame_text(error), "error frame") << "of none of them";
}

TEST(CandumpLog, TakesNoHalfLineForAFrame) {
  for (const char* line : {"",
                           " ",
                           "(",
                           "(1.0)",
                           "(1.0) can0",
                           "(1.0) can0 ",
                           "(1.0) can0 18",
                           "(1.0) can0 181",
                           "(1.0) can0 181#A",
                           "(1.0) can0 181#AAB",
                           "(1.0) can0 181#AABBCCDDEEFF001122",
                           "(1.0) can0 801#AA",
                           "(1.0) can0 1811#AA",
                           "(1.0) can0 18G#AA",
                           "(1.0) can0 #AA",
                           "(1.0) can0 181#AG",
                           "(1.0) can0 181#AA.",
                           "(1.0) can0 181#.AA",
                           "can0 181 [2] AA",
                           "can0 181 [2",
                           "can0 181 [22 AA BB",
                           "can0 181 22] AA BB",
                           "can0 181G [2] AA BB",
                           "can0 181 [] AA",
                           "can0 181 [-1] AA",
                           "can0 181 [9] 1 2 3 4 5 6 7 8 9",
                           "some words of a person",
                           "(1436509052.249713 can0 181#AABB"}) {
    EXPECT_FALSE(read_log_line(line).has_value()) << line;
  }
  const std::string whole = "(1436509052.249713) can0 181#AABB";
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const auto logged = read_log_line(whole.substr(0, length));
    const bool ends_behind_a_byte = length == whole.size() - 2 || length == whole.size() - 4;
    EXPECT_EQ(logged.has_value(), ends_behind_a_byte) << whole.substr(0, length);
  }
}

TEST(CandumpLog, TakesATimeThatNoClockHasForNone) {
  for (const char* time :
       {"(99999999999999999999.0)", "(-5.0)", "(-1.0)", "(x)", "()", "(1.x)", "(9223372036854775807.5)"}) {
    EXPECT_EQ(read(std::string(time) + " can0 181#AA").frame.stamp.count(), 0) << time;
  }
  EXPECT_EQ(read("(5) can0 181#AA").frame.stamp, std::chrono::seconds(5));
  EXPECT_EQ(read("(1.) can0 181#AA").frame.stamp, std::chrono::seconds(1));
  EXPECT_EQ(read("(0.5) can0 181#AA").frame.stamp, std::chrono::milliseconds(500));
  EXPECT_EQ(read("(9000000000.5) can0 181#AA").frame.stamp, std::chrono::milliseconds(9000000000500));
  EXPECT_EQ(read("(9000000001.0) can0 181#AA").frame.stamp.count(), 0) << "nanoseconds do not count so far";
}

/// Bytes of any kind, and frames with a letter exchanged.
TEST(CandumpLog, ReadsWhateverComes) {
  std::mt19937 random(5);
  const std::string frame = "(1436509052.249713) can0 181#AABBCCDD";
  for (int i = 0; i < 20000; ++i) {
    std::string line = frame;
    if (i % 2 == 0) {
      line.resize(random() % 60);
      for (char& c : line) c = static_cast<char>(random());
    } else {
      line[random() % line.size()] = "#.R_()[] g\r"[random() % 11];
    }
    const auto logged = read_log_line(line);
    if (logged && logged->kind == Kind::Data) {
      EXPECT_LE(logged->frame.size, 8) << line;
      EXPECT_LE(logged->frame.id, 0x7FF) << line;
    }
  }
}

}  // namespace
