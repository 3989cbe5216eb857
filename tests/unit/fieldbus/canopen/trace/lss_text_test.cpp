#include "canopen/trace/lss_text.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>

namespace rmac::fieldbus::canopen {
namespace {

/// A service of CiA 305, 3.8, with 44h 33h 22h 11h 05h 02h 03h behind its command: what is asked, and what is answered.
struct Service {
  std::uint8_t command;
  const char *request, *answer;
};
constexpr std::array kServices{
    Service{0x04, "switch all nodes to mode 68", "switch all nodes to"},
    Service{0x11, "configure node id 68", "configure node id: error 68, 51"},
    Service{0x13, "configure bit timing 51 of table 68", "configure bit timing: error 68, 51"},
    Service{0x15, "activate bit timing, delay ms 13124", "activate bit timing, delay ms"},
    Service{0x17, "store configuration", "store configuration: error 68, 51"},
    Service{0x40, "select vendor 11223344h", "select vendor"},
    Service{0x41, "select product 11223344h", "select product"},
    Service{0x42, "select revision 11223344h", "select revision"},
    Service{0x43, "select serial number 11223344h", "select serial number"},
    Service{0x44, "selected", "selected"},
    Service{0x46, "identify vendor 11223344h", "identify vendor"},
    Service{0x47, "identify product 11223344h", "identify product"},
    Service{0x48, "identify revision from 11223344h", "identify revision from"},
    Service{0x49, "identify revision to 11223344h", "identify revision to"},
    Service{0x4A, "identify serial number from 11223344h", "identify serial number from"},
    Service{0x4B, "identify serial number to 11223344h", "identify serial number to"},
    Service{0x4C, "identify nodes without id", "identify nodes without id"},
    Service{0x4F, "identified", "identified"},
    Service{0x50, "identified, without id", "identified, without id"},
    Service{0x51, "fast scan 11223344h down to bit 5 of part 2, next 3", "fast scan"},
    Service{0x5A, "inquire vendor", "inquire vendor 11223344h"},
    Service{0x5B, "inquire product", "inquire product 11223344h"},
    Service{0x5C, "inquire revision", "inquire revision 11223344h"},
    Service{0x5D, "inquire serial number", "inquire serial number 11223344h"},
    Service{0x5E, "inquire node id", "inquire node id 68"}};

constexpr std::uint16_t kRequest = 0x7E5, kAnswer = 0x7E4;

CanFrame frame_of(std::uint16_t id, std::uint8_t command, std::array<std::uint8_t, 7> rest) {
  CanFrame frame{.id = id, .size = 8, .data = {command}};
  std::copy(rest.begin(), rest.end(), frame.data.begin() + 1);
  return frame;
}
CanFrame frame_of(std::uint16_t id, std::uint8_t command) {
  return frame_of(id, command, {0x44, 0x33, 0x22, 0x11, 5, 2, 3});
}

TEST(LssText, TellsEachServiceWithWhatItCarriesEitherWay) {
  std::set<int> known;
  for (const Service& service : kServices) {
    EXPECT_EQ(lss_text(frame_of(kRequest, service.command)), std::string("LSS ") + service.request);
    EXPECT_EQ(lss_text(frame_of(kAnswer, service.command)), std::string("LSS answer: ") + service.answer);
    known.insert(service.command);
  }
  for (int command = 0; command < 256; ++command) {
    const std::string text = lss_text(frame_of(kRequest, static_cast<std::uint8_t>(command)));
    EXPECT_EQ(text.starts_with("LSS command "), !known.contains(command)) << text;
  }
}

TEST(LssText, TellsNumbersThatMeanSomethingByTheirMeaning) {
  EXPECT_EQ(lss_text(frame_of(kRequest, 0x04, {0})), "LSS switch all nodes to waiting");
  EXPECT_EQ(lss_text(frame_of(kRequest, 0x04, {1})), "LSS switch all nodes to configuration");
  EXPECT_EQ(lss_text(frame_of(kRequest, 0x04, {2})), "LSS switch all nodes to mode 2");
  EXPECT_EQ(lss_text(frame_of(kRequest, 0x11, {0xFF})), "LSS configure node id none");
  EXPECT_EQ(lss_text(frame_of(kRequest, 0x11, {0xFE})), "LSS configure node id 254");
  EXPECT_EQ(lss_text(frame_of(kAnswer, 0x5E, {0xFF})), "LSS answer: inquire node id none");
  EXPECT_EQ(lss_text(frame_of(kRequest, 0x51, {1, 2, 3, 4, 0x80})), "LSS fast scan, from the beginning");
  EXPECT_EQ(lss_text(frame_of(kRequest, 0x51, {1, 0, 0, 0, 31, 0, 0})),
            "LSS fast scan 1h down to bit 31 of part 0, next 0");
  EXPECT_EQ(lss_text(frame_of(kAnswer, 0x17, {0, 7})), "LSS answer: store configuration: done");
  EXPECT_EQ(lss_text(frame_of(kAnswer, 0x17, {1, 7})), "LSS answer: store configuration: error 1, 7");
  EXPECT_EQ(lss_text(frame_of(kAnswer, 0x17, {0xFF, 7})), "LSS answer: store configuration: error 255, 7");
}

TEST(LssText, OfAFrameThatIsTooShortIsItsCommandAlone) {
  CanFrame frame = frame_of(kAnswer, 0x44);
  frame.size = 7;
  EXPECT_EQ(lss_text(frame), "LSS answer: command 44h, 7 bytes");
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
