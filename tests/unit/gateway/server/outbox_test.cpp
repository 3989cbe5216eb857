#include "gateway/server/outbox.hpp"

#include <gtest/gtest.h>

namespace rmac::gateway {
namespace {

using std::chrono::seconds;

constexpr Outbox::Time kStart{};

std::vector<std::string> texts(const std::vector<asio::const_buffer>& buffers) {
  std::vector<std::string> result;
  for (const auto& buffer : buffers) result.emplace_back(static_cast<const char*>(buffer.data()), buffer.size());
  return result;
}

TEST(Outbox, WritesInOrderAndOneWriteAtATime) {
  Outbox outbox(kStart);
  outbox.add("one", kStart);
  EXPECT_EQ(texts(outbox.begin_write()), (std::vector<std::string>{"one\n"}));
  outbox.add("two", kStart);
  outbox.add("three", kStart);
  EXPECT_TRUE(outbox.begin_write().empty()) << "a write is under way";
  outbox.written(kStart);
  EXPECT_EQ(texts(outbox.begin_write()), (std::vector<std::string>{"two\n", "three\n"}));
  outbox.written(kStart);
  EXPECT_TRUE(outbox.empty());
  EXPECT_TRUE(outbox.begin_write().empty());
}

TEST(Outbox, CountsTheMemoryOfLinesUntilTheyAreWritten) {
  Outbox outbox(kStart);
  outbox.add("12345", kStart);
  const std::size_t one = outbox.bytes();
  EXPECT_GE(one, sizeof(std::string)) << "a million of short lines take more than their text";
  EXPECT_LT(one, 100U);
  EXPECT_EQ(outbox.begin_write().size(), 1U);
  outbox.add("1", kStart);
  EXPECT_EQ(outbox.bytes(), 2 * one) << "what is being written still waits for the client";
  outbox.written(kStart);
  EXPECT_EQ(outbox.bytes(), one);
  EXPECT_EQ(outbox.begin_write().size(), 1U);
  outbox.written(kStart);
  EXPECT_EQ(outbox.bytes(), 0U);
}

TEST(Outbox, ALongLineTakesNoMoreThanItsText) {
  Outbox outbox(kStart);
  std::string text(60'000, 'x');
  text.reserve(120'000);  // as writing JSON leaves it
  outbox.add(std::move(text), kStart);
  EXPECT_GE(outbox.bytes(), 60'001U);
  EXPECT_LT(outbox.bytes(), 60'100U);
}

TEST(Outbox, BoundsTheBuffersOfOneWrite) {
  Outbox outbox(kStart);
  for (int i = 0; i < 100; ++i) outbox.add(std::to_string(i), kStart);
  EXPECT_EQ(outbox.begin_write().size(), 64U);
  outbox.written(kStart);
  const auto rest = texts(outbox.begin_write());
  ASSERT_EQ(rest.size(), 36U);
  EXPECT_EQ(rest.front(), "64\n");
}

TEST(Outbox, StandsStillFromTheFirstLineThatWaitsOrTheLastThatWasRead) {
  Outbox outbox(kStart);
  outbox.add("one", kStart + seconds(10));
  EXPECT_EQ(outbox.standstill(kStart + seconds(13)), seconds(3)) << "an empty outbox stands for nothing";
  outbox.add("two", kStart + seconds(12));
  EXPECT_EQ(outbox.standstill(kStart + seconds(13)), seconds(3)) << "a line more is no progress";
  EXPECT_EQ(outbox.begin_write().size(), 2U);
  outbox.written(kStart + seconds(14));
  EXPECT_EQ(outbox.standstill(kStart + seconds(15)), seconds(1));
}

}  // namespace
}  // namespace rmac::gateway
