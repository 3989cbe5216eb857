#include "gateway/server/line_reader.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace rmac::gateway {
namespace {

using Found = std::vector<std::pair<std::string, std::uint64_t>>;

Found take(LineReader& reader, std::string_view chunk) {
  Found found;
  reader.take(chunk);
  while (const auto line = reader.next()) found.emplace_back(line->text, line->position);
  return found;
}

TEST(LineReader, GivesEachLineWithItsPlaceInTheInput) {
  LineReader reader(100);
  EXPECT_EQ(take(reader, "one\ntwo\n"), (Found{{"one", 0}, {"two", 4}}));
  EXPECT_EQ(take(reader, "three\n"), (Found{{"three", 8}})) << "positions go on over chunks";
}

TEST(LineReader, PutsALineTogetherThatComesInPieces) {
  LineReader reader(100);
  EXPECT_TRUE(take(reader, "on").empty());
  EXPECT_TRUE(take(reader, "e").empty());
  EXPECT_EQ(take(reader, " more\nnext\n"), (Found{{"one more", 0}, {"next", 9}}));
}

TEST(LineReader, LeavesOutBlankLinesAndCarriageReturnsButCountsTheirBytes) {
  LineReader reader(100);
  EXPECT_EQ(take(reader, "\r\n \t\nword\r\nlast\n"), (Found{{"word", 5}, {"last", 11}}));
}

TEST(LineReader, GivesWhatComesBeforeALineThatIsTooLongAndNothingAfterIt) {
  LineReader reader(4);
  EXPECT_EQ(take(reader, "four\nfive5\nsix\n"), (Found{{"four", 0}}));
  EXPECT_TRUE(reader.too_long());
  EXPECT_TRUE(take(reader, "more\n").empty());
}

TEST(LineReader, FindsALineTooLongBeforeItsEndHasCome) {
  LineReader reader(4);
  EXPECT_TRUE(take(reader, "fou").empty());
  EXPECT_FALSE(reader.too_long());
  EXPECT_TRUE(take(reader, "rs").empty());
  EXPECT_TRUE(reader.too_long());
}

TEST(LineReader, GivesTheLineWithoutANewlineAtTheEnd) {
  LineReader reader(100);
  EXPECT_EQ(take(reader, "one\ntwo\r"), (Found{{"one", 0}}));
  const auto last = reader.last();
  ASSERT_TRUE(last);
  EXPECT_EQ(last->text, "two");
  EXPECT_EQ(last->position, 4U);
  EXPECT_FALSE(reader.last()) << "once";
}

TEST(LineReader, ForgetsALineThatHasBegun) {
  LineReader reader(100);
  EXPECT_TRUE(take(reader, "begun").empty());
  reader.clear();
  EXPECT_FALSE(reader.last());
}

}  // namespace
}  // namespace rmac::gateway
