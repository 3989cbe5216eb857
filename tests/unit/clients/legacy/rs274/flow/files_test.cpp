// Subs that stand in files of their own, as LinuxCNC finds them.
#include <gmock/gmock.h>

#include <map>
#include <optional>

#include "unit/clients/legacy/rs274/flow/carried_out.hpp"
#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

using Files = std::map<std::string, std::string>;

FindFile among(Files files) {
  return [files = std::move(files)](const std::string& name) -> tl::expected<std::optional<SubFile>, std::string> {
    const auto found = files.find(name);
    if (found == files.end()) return std::nullopt;
    return SubFile{name, found->second};
  };
}

std::vector<std::string> carried_out_with(const Files& files, const std::string& program) {
  return carried_out(program, {.idle_lines = 1000}, false, among(files));
}

TEST(Rs274SubOfAnotherFile, IsFoundByItsNameInSmallLetters) {
  EXPECT_THAT(
      carried_out_with({{"bolt_circle-2.ngc", "(a sub)\no<bolt_circle-2> sub\nX#1\no<bolt_circle-2> endsub\nM2"}},
                       "Y1\no<Bolt_Circle-2> call [4]\nY2"),
      ElementsAre("Y1", "X4", "Y2"));
  EXPECT_THAT(
      carried_out_with({{"100.ngc", "%\no100 sub\nX#1\no100 endsub\n%"}}, "#2=100\no100 call [4]\no#2 call [5]"),
      ElementsAre("X4", "X5"));
  EXPECT_THAT(carried_out_with({{"100.ngc", "O100\nX1\nM99\n"}}, "M98 P100 L2\nY1"), ElementsAre("X1", "X1", "Y1"));
}

TEST(Rs274SubOfAnotherFile, GivesBackAndHasLoopsOfItsOwn) {
  const Files files{
      {"twice.ngc",
       "o<twice> sub\no1 repeat [2]\nX#1\no<once> call [#1 + 1]\no1 endrepeat\no<twice> endsub [#1 * 2]\n"},
      {"once.ngc", "o<once> sub\no1 if [#1 gt 0]\nY#1\no<once> return\no1 endif\nX99\no<once> endsub\n"}};
  EXPECT_THAT(carried_out_with(files, "o1 repeat [2]\no<twice> call [4]\nZ#<_value>\no1 endrepeat"),
              ElementsAre("X4", "Y5", "X4", "Y5", "Z8", "X4", "Y5", "X4", "Y5", "Z8"))
      << "labels are each file's own";
}

TEST(Rs274SubOfAnotherFile, CallsSubsOfTheProgram) {
  EXPECT_THAT(
      carried_out_with({{"a.ngc", "o<a> sub\no<b> call\nX1\no<a> endsub\n"}}, "o<b> sub\nY1\no<b> endsub\no<a> call"),
      ElementsAre("Y1", "X1"));
}

TEST(Rs274SubOfAnotherFile, IsLeftAloneWhereTheProgramCameByOneOfThatName) {
  const Files files{{"a.ngc", "o<a> sub\nX99\no<a> endsub\n"}};
  EXPECT_THAT(carried_out_with(files, "o<a> sub\nX1\no<a> endsub\no<a> call"), ElementsAre("X1"));
  EXPECT_THAT(carried_out_with(files, "Y1\no<a> call\nM2\no<a> sub\nX1\no<a> endsub"),
              ElementsAre("Y1", "2:1: o<a> stands in line 4 and in a.ngc, too; give one of them another name"))
      << "LinuxCNC takes the file's, which the program hardly means";
}

TEST(Rs274SubOfAnotherFile, IsRefusedWhereNoFileHasIt) {
  EXPECT_THAT(
      carried_out_with({}, "Y1\no<Far> call").back(),
      StartsWith("2:1: o<far> is not in this file, and there is no far.ngc beside the program or in --subroutines"));
  EXPECT_THAT(carried_out_with({}, "M98 P7").back(), HasSubstr("there is no 7.ngc"));
  EXPECT_EQ(carried_out_with({{"far.ngc", "o<near> sub\no<near> endsub"}}, "o<far> call").back(),
            "1:1: far.ngc has no o<far> sub, which is what is called");
  EXPECT_THAT(carried_out_with({{"../far.ngc", "o<../far> sub\no<../far> endsub"}}, "o<../far> call").back(),
              HasSubstr("no other is read"))
      << "a program does not lead out of the folders that it was given";
  const FindFile unreadable = [](const std::string& name) -> tl::expected<std::optional<SubFile>, std::string> {
    return tl::unexpected(name + ": is a folder");
  };
  EXPECT_EQ(carried_out("o<far> call", {}, false, unreadable).back(), "1:1: far.ngc: is a folder");
}

TEST(Rs274SubOfAnotherFile, IsRefusedAtItsOwnLine) {
  EXPECT_THAT(carried_out_with({{"a.ngc", "o<a> sub\nX#5000\no<a> endsub\n"}}, "Y1\no<a> call").back(),
              StartsWith("a.ngc:2:2:"));
  EXPECT_THAT(carried_out_with({{"a.ngc", "\no<a> sub\nX1\n"}}, "Y1\no<a> call").back(),
              StartsWith("a.ngc:2:1: o<a> sub is not closed"));
  EXPECT_THAT(carried_out_with({{"a.ngc", "o1 endif\no<a> sub\no<a> endsub\n"}}, "o<a> call").back(),
              StartsWith("a.ngc:1:1:"));
  EXPECT_THAT(carried_out_with({{"a.ngc", "o<a> sub\no<a> call\no<a> endsub\n"}}, "o<a> call").back(),
              StartsWith("a.ngc:2:1: a call within 9 others"));
}

TEST(Rs274SubOfAnotherFile, HasItsMovesNamedByTheLineOfTheProgramThatCalls) {
  const std::string program = program_of("o<a> call\nG1 X9\no<own> sub\no<a> call\no<own> endsub\no<own> call");
  std::string text;
  const auto outcome = import_program(
      program, {}, [&text](std::string_view part) { text += part; },
      among({{"a.ngc", "\n\n\n\n\n\n\n\n\n\n\n\no<a> sub\nG1 X1\nX2\no<a> endsub\n"}}));
  const auto imported = legacy::read_back(outcome, text, program, 3000);
  std::vector<int> lines;
  for (const auto& move : legacy::moves_in(imported)) lines.push_back(move["params"]["MoveID"].get<int>());
  EXPECT_THAT(lines, ElementsAre(3, 3, 4, 6, 6));
}

TEST(Rs274SubOfAnotherFile, EndsTheProgramWhereItHasM2) {
  const std::string program = program_of("o<a> call\nG1 X9");
  std::string text;
  const auto outcome = import_program(
      program, {}, [&text](std::string_view part) { text += part; },
      among({{"a.ngc", "o<a> sub\nG1 X1\nM2\no<a> endsub\n"}}));
  EXPECT_EQ(legacy::ends_in(legacy::read_back(outcome, text, program, 3000)),
            (std::vector<std::vector<double>>{{1, 0, 10}}));
}

}  // namespace
}  // namespace rmac::rs274
