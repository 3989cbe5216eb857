#include "gateway/json/printable.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

namespace rmac::gateway {
namespace {

TEST(Printable, LeavesTextOfAnyLanguageAsItIs) {
  EXPECT_EQ(printable("Fräse 5 µm \u96fb\u6c17 \U0001f600"), "Fräse 5 µm \u96fb\u6c17 \U0001f600");
  EXPECT_EQ(printable(""), "");
}

TEST(Printable, KeepsWithinALineAndOffTheTerminalsControls) {
  EXPECT_EQ(printable("a\nb\tc\x1b[31md\x7f\xc2\x9b"), "a?b?c?[31md??");
}

TEST(Printable, GivesForBytesThatAreNoTextAQuestionMarkEach) {
  for (const char* bytes :
       {"\xff", "\xc3", "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xf8\x88"}) {
    EXPECT_EQ(printable(bytes), std::string(std::string_view(bytes).size(), '?'));
  }
}

TEST(Printable, CutsBetweenCharacters) {
  EXPECT_EQ(printable("aéé", 4), "aé");
  EXPECT_EQ(printable("aéé", 5), "aéé");
}

TEST(Printable, GivesWhatJsonTakesWhateverTheBytesAre) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> byte(0, 255), size(0, 40);
  for (int sample = 0; sample < 20000; ++sample) {
    std::string text(static_cast<std::size_t>(size(random)), '\0');
    for (char& c : text) c = static_cast<char>(byte(random));
    const std::string shown = printable(text, 20);
    EXPECT_LE(shown.size(), 20U);
    EXPECT_NO_THROW(static_cast<void>(nlohmann::json(shown).dump())) << "sample " << sample;
    EXPECT_EQ(shown, printable(shown)) << "sample " << sample;
  }
}

}  // namespace
}  // namespace rmac::gateway
