#include "gateway/rmac/program/open_ends.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace rmac::cli {
namespace {

using Place = OpenEnds::Point;

nlohmann::json pose(const Place& place) {
  return {{"p", place}, {"k", {0, 0, 1}}};
}

OpenEnds::Reach line(const Place& begin, const Place& end) {
  return OpenEnds::of({{"MoveID", 1}, {"StartPoint", pose(begin)}, {"EndPoint", pose(end)}});
}

TEST(OpenEnds, TellWhereAMoveBeginsAndEndsByItsParameters) {
  const Place a{1, 2, 3}, b{4, 5, 6};
  const auto of_line = line(a, b);
  EXPECT_EQ(of_line.begin, a);
  EXPECT_EQ(of_line.end, b);
  const auto of_curve = OpenEnds::of({{"Nurbs", {{"degree", 1}, {"knots", {0, 0, 1, 1}}, {"points", {a, b}}}}});
  EXPECT_EQ(of_curve.begin, a);
  EXPECT_EQ(of_curve.end, b);
  const auto six = std::vector<std::vector<double>>{{1, 2, 3, 0, 0, 1}, {4, 5, 6, 0, 0, 1}};
  EXPECT_EQ(OpenEnds::of({{"NurbsND", {{"space", "pose"}, {"points", six}}}}).end, b);
  EXPECT_EQ(OpenEnds::of({{"NurbsND", {{"space", "joints"}, {"points", six}}}}).begin, std::nullopt)
      << "joints are no place";
  EXPECT_EQ(OpenEnds::of({{"TargetFrame", pose(b)}}).begin, std::nullopt) << "from anywhere";
  EXPECT_EQ(OpenEnds::of({{"TargetFrame", pose(b)}}).end, b);
}

TEST(OpenEnds, TakeAnyParametersForAMoveThatBeginsAnywhere) {
  for (const char* text : {"null", "5", "[]", R"({"StartPoint": 3})", R"({"StartPoint": {"p": [1, 2]}})",
                           R"({"StartPoint": {"p": ["a", 2, 3]}})", R"({"Nurbs": []})", R"({"Nurbs": {"points": []}})",
                           R"({"Nurbs": {"points": [5]}})", R"({"NurbsND": {"points": [[1, 2, 3]]}})"}) {
    EXPECT_EQ(OpenEnds::of(nlohmann::json::parse(text)).begin, std::nullopt) << text;
  }
}

TEST(OpenEnds, LetAChainOfMovesGoOutWithoutWaiting) {
  OpenEnds ends;
  ASSERT_TRUE(ends.may_follow(line({0, 0, 0}, {1, 0, 0}))) << "nothing is under way";
  ends.sent(line({0, 0, 0}, {1, 0, 0}));
  EXPECT_FALSE(ends.may_follow(line({1, 0, 0}, {2, 0, 0}))) << "where the queue ends is not known yet";
  ends.answered();
  for (int x = 1; x < 33; ++x) {
    const auto next = line({1.0 * x, 0, 0}, {1.0 * x + 1, 0, 0});
    ASSERT_TRUE(ends.may_follow(next)) << x;
    ends.sent(next);
  }
  EXPECT_FALSE(ends.may_follow(line({1, 0, 0}, {0, 0, 0}))) << "the queue ends there, if the first is refused";
  ends.forget();
  EXPECT_FALSE(ends.may_follow(line({33, 0, 0}, {34, 0, 0}))) << "another request may have moved the tool";
}

/// What the appliance does with moves: it takes one that begins where its queue ends, and refuses those that are wrong.
class Queue {
 public:
  explicit Queue(const Place& at) : at_(at) {}

  bool take(const OpenEnds::Reach& move, bool wrong) {
    if (wrong || (move.begin && *move.begin != at_)) return false;
    at_ = *move.end;
    return true;
  }

 private:
  Place at_;
};

TEST(OpenEnds, LetNoMoveBehindARefusedOneBeTaken) {
  int waited = 0, went_ahead = 0;
  for (unsigned seed = 0; seed < 2000; ++seed) {
    std::mt19937 random(seed);
    const auto one_of = [&](int count) { return std::uniform_int_distribution<int>(0, count - 1)(random); };
    // Few places, so that paths come back to them.
    const auto place = [&] { return Place{1.0 * one_of(4), 1.0 * one_of(3), 0}; };
    std::vector<OpenEnds::Reach> program;
    Place at = place();
    const Place begin = at;
    for (int i = 0; i < 40; ++i) {
      const Place end = place();
      program.push_back(one_of(8) == 0 ? OpenEnds::Reach{std::nullopt, end} : OpenEnds::Reach{at, end});
      at = end;
    }
    const auto wrong = static_cast<std::size_t>(one_of(40));
    OpenEnds ends;
    Queue queue(begin);
    std::size_t sent = 0, answered = 0;
    bool refused = false;
    while (!refused && answered < program.size()) {
      if (sent < program.size() && sent - answered < 32 && one_of(4) != 0) {
        const bool free = ends.may_follow(program[sent]);
        (free ? went_ahead : waited) += sent > answered;
        if (free) ends.sent(program[sent++]);
      } else if (answered < sent) {
        refused = !queue.take(program[answered], answered == wrong);
        ++answered;
        ends.answered();
      }
    }
    ASSERT_TRUE(refused);
    for (; answered < sent; ++answered) ASSERT_FALSE(queue.take(program[answered], false)) << "seed " << seed;
  }
  EXPECT_GT(waited, 1000);
  EXPECT_GT(went_ahead, 1000) << "a program that never comes back must not wait";
}

}  // namespace
}  // namespace rmac::cli
