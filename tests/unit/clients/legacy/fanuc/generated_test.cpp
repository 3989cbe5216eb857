#include <fmt/format.h>
#include <gmock/gmock.h>

#include <random>

#include "clients/legacy/rs274/import.hpp"
#include "unit/clients/legacy/fanuc/imported.hpp"

namespace rmac::fanuc {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  int integer(int least, int most) { return std::uniform_int_distribution<int>(least, most)(engine_); }
  std::string length(int most = 50) {
    return fmt::format("{:.3f}", std::uniform_real_distribution<double>(-most, most)(engine_));
  }

 private:
  std::mt19937 engine_;
};

/// Requests without the lines that they come from.
std::string without_lines(const std::string& text) {
  std::string result;
  for (auto request : legacy::requests_in(text, -1)) {
    request.erase("id");
    request["params"].erase("MoveID");
    result += request.dump() + "\n";
  }
  return result;
}

/// A program of loops within each other with the ways that they go, and the same moves one by one.
struct Twins {
  std::string macro, unrolled;
};

Twins looping(Random& random) {
  const int rows = random.integer(1, 4), columns = random.integer(1, 4), skipped = random.integer(0, 3);
  const std::string pitch = random.length(), step = random.length();
  const std::string kinds[] = {"G0 X#3 Y#4", "G1 X#3 Y#4 F100.", "G2 X#3 Y#4 R-500.", "G99 G81 X#3 Y#4 Z-1. R2. F90."};
  const std::string move = kinds[random.integer(0, 3)];
  Twins twins;
  const bool by_goto = random.integer(0, 1) == 1, by_macro = random.integer(0, 1) == 1;
  const std::string leaf = by_macro ? "G65 P9 X#3 Y#4" : move;
  std::string body = fmt::format(
      "#1=0\n{}\n#2=0\nWHILE[#2LT{}]DO2\n#3=#1*[{}]+.5\n#4=#2*[{}]\nIF[#2EQ{}]GOTO 50\n{}\nN50 "
      "#2=#2+1\nEND2\n#1=#1+1\n{}",
      by_goto ? "N10" : fmt::format("WHILE[#1LT{}]DO1", rows), columns, pitch, step, skipped, leaf,
      by_goto ? fmt::format("IF[#1LT{}]GOTO 10", rows) : "END1");
  const auto in_macro = [&move] {
    std::string text = move;
    text.replace(text.find("#3"), 2, "#24");
    text.replace(text.find("#4"), 2, "#25");
    return text;
  };
  twins.macro = program_of(body, by_macro ? "O9\n" + in_macro() + "\nM99\n" : "");
  std::string lines;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (column == skipped) continue;
      std::string line = move;
      line.replace(line.find("#3"), 2, fmt::format("[{}*[{}]+.5]", row, pitch));
      line.replace(line.find("#4"), 2, fmt::format("[{}*[{}]]", column, step));
      lines += line + "\n";
    }
  }
  twins.unrolled = program_of(lines);
  return twins;
}

TEST(FanucGenerated, LoopsAreTheirMovesOneByOne) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const Twins twins = looping(random);
    ASSERT_EQ(without_lines(text_of(twins.macro)), without_lines(text_of(twins.unrolled))) << "seed " << seed << "\n"
                                                                                           << twins.macro << "\n"
                                                                                           << twins.unrolled;
  }
}

/// Blocks that RS274/NGC and a Fanuc mean the same by.
std::string common_block(Random& random) {
  const auto end = [&random] { return "X" + random.length() + " Y" + random.length(); };
  switch (random.integer(0, 13)) {
    case 0:
      return "G0 " + end() + " Z" + random.length();
    case 1:
      return "G1 " + end() + " F" + fmt::format("{}.", random.integer(10, 900));
    case 2:
      return "G1 Z" + random.length();
    case 3:
      return fmt::format("G{} {} R{}", random.integer(2, 3), end(), random.integer(0, 1) == 1 ? "200." : "-200.");
    case 4:
      return fmt::format("G17 G{} I{} J{}", random.integer(2, 3), random.length(), random.length());
    case 5:
      return fmt::format("G18 G{} I{} K{}\nG17", random.integer(2, 3), random.length(), random.length());
    case 6:
      return fmt::format("G19 G{} J{} K{} X{}\nG17", random.integer(2, 3), random.length(), random.length(),
                         random.length());
    case 7:
      return fmt::format("G91 G1 X{} Z{}\nG90", random.length(5), random.length(5));
    case 8:
      return fmt::format("G0 Z60.\nG99 G{} {} Z-60. R55. {}F100.\n{}\nG80\nG0 Z70.",
                         random.integer(0, 1) == 1 ? "81" : "85", end(), "", end());
    case 9:
      return fmt::format("G0 Z60.\nG98 G83 {} Z-60. R55. Q{}. F100.\nG80\nG0 Z70.", end(), random.integer(20, 40));
    case 10:
      return fmt::format("S{} M3 M8", random.integer(100, 5000));
    case 11:
      return "M5 M9";
    case 12:
      return "G20\nG1 X" + random.length(2) + " F9.\nG21\nG1 F200.";
    default:
      return "G92 X" + random.length() + "\nG1 X1.\n(COMMENT)";
  }
}

TEST(FanucGenerated, WhatBothLanguagesMeanAlikeBecomesTheSame) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    Random random(seed);
    std::string lines = "G21 G90 G17 G40 G80 F600.\nG0 X0 Y0 Z10.\nG1 X1.\n";
    for (int block = 0; block < 20; ++block) lines += common_block(random) + "\n";
    lines += "M30\n";
    std::string text;
    const auto sink = [&text](std::string_view part) { text += part; };
    const auto outcome = rs274::import_program(lines, {}, sink);
    ASSERT_TRUE(outcome) << seed << "\n" << outcome.error().message << outcome.error().line << "\n" << lines;
    ASSERT_EQ(text_of(lines), text) << "seed " << seed << "\n" << lines;
  }
}

}  // namespace
}  // namespace rmac::fanuc
