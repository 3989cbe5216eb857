#include "canopen/objects/standard_objects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>

#include "places.hpp"
#include "rmac/fieldbus/eds/device_description.hpp"

namespace rmac::fieldbus::canopen {
namespace {

/// Objects that the file of the virtual drive lacks, or has under a name of its own.
struct Named {
  ObjectAddress object;
  const char* name;
};
constexpr std::array kBesideTheFile{Named{{0x1002, 0}, "Manufacturer status register"},
                                    Named{{0x1006, 0}, "Communication cycle period"},
                                    Named{{0x1007, 0}, "Synchronous window length"},
                                    Named{{0x100C, 0}, "Guard time"},
                                    Named{{0x100D, 0}, "Life time factor"},
                                    Named{{0x1012, 0}, "COB-ID TIME"},
                                    Named{{0x1015, 0}, "Inhibit time EMCY"},
                                    Named{{0x1016, 1}, "Consumer heartbeat time"},
                                    Named{{0x1019, 0}, "Synchronous counter overflow value"},
                                    Named{{0x1029, 1}, "Communication error behavior"},
                                    Named{{0x6063, 0}, "Position actual internal value"},
                                    Named{{0x6073, 0}, "Max current"},
                                    Named{{0x6075, 0}, "Motor rated current"},
                                    Named{{0x6078, 0}, "Current actual value"},
                                    Named{{0x6079, 0}, "DC link circuit voltage"},
                                    Named{{0x6080, 0}, "Max motor speed"},
                                    Named{{0x6091, 1}, "Gear: motor revolutions"},
                                    Named{{0x6091, 2}, "Gear: shaft revolutions"},
                                    Named{{0x6092, 2}, "Feed: shaft revolutions"},
                                    Named{{0x60B0, 0}, "Position offset"},
                                    Named{{0x60C1, 1}, "Interpolation data record 1"},
                                    Named{{0x60FE, 1}, "Physical outputs"}};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// All addresses but those of further axes.
std::set<ObjectAddress> known() {
  std::set<ObjectAddress> objects;
  for (unsigned index = 0; index <= 0xFFFF; ++index) {
    const bool further_axis = index >= 0x6800 && index < 0x8000;
    for (unsigned sub = 0; sub <= 0xFF && !further_axis; ++sub) {
      const ObjectAddress object{static_cast<std::uint16_t>(index), static_cast<std::uint8_t>(sub)};
      if (find_standard_object(object) != nullptr) objects.insert(object);
    }
  }
  return objects;
}

// Red when an object stands under the address of another, or is taken for a number of another length or sign.
TEST(StandardObjects, AreThoseOfADrivesOwnFile) {
  const auto file = eds::read_device_description(RMAC_SOURCE_DIR "/gateway/simulators/vdrive/rmac-vdrive.eds");
  ASSERT_TRUE(file) << file.error().message;
  std::set<ObjectAddress> left = known();
  EXPECT_EQ(left.size(), 94U) << "one stands under the address of another, and is found no more";
  for (const Named& named : kBesideTheFile) {
    const StandardObject* object = find_standard_object(named.object);
    ASSERT_NE(object, nullptr) << to_string(named.object);
    EXPECT_STREQ(object->name, named.name);
    left.erase(named.object);
  }
  for (const ObjectAddress& address : left) {
    const eds::ObjectEntry* entry = file->find(address);
    ASSERT_NE(entry, nullptr) << to_string(address);
    const StandardObject& object = *find_standard_object(address);
    EXPECT_EQ(lower(object.name), lower(entry->name)) << to_string(address);
    EXPECT_EQ(object.type, entry->type) << to_string(address);
  }
}

/// CiA 402-1: 800h objects an axis, and four axes are known here.
TEST(StandardObjects, OfFurtherAxesAreThoseOfTheFirst) {
  for (unsigned index = 0; index <= 0xFFFF; ++index) {
    const ObjectAddress object{static_cast<std::uint16_t>(index), 3};
    const bool profile = index >= 0x6000 && index < 0x8000;
    const ObjectAddress first{static_cast<std::uint16_t>(profile ? 0x6000 + index % 0x800 : index), 3};
    ASSERT_EQ(of_first_axis(object), first) << to_string(object);
  }
}

TEST(StandardObjects, NameTheModesOfTheStandardAlone) {
  constexpr std::array kModes{"",
                              "profile position",
                              "velocity",
                              "profile velocity",
                              "profile torque",
                              "",
                              "homing",
                              "interpolated position",
                              "cyclic synchronous position",
                              "cyclic synchronous velocity",
                              "cyclic synchronous torque"};
  for (int mode = -128; mode < 128; ++mode) {
    const bool named = mode >= 0 && mode <= 10;
    EXPECT_STREQ(mode_name(mode), named ? kModes.at(static_cast<std::size_t>(mode)) : "") << mode;
  }
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
