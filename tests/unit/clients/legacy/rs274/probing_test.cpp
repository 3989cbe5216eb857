#include <gmock/gmock.h>

#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kWhatToDo = "rmac measure PLAN.json --apply";

TEST(Probing, IsRefusedWithItsPlaceAndWhatToDo) {
  for (const std::string code : {"G38.2", "G38.3", "G38.4", "G38.5"})
    EXPECT_THAT(refusal_of(program_of("G91 " + code + " Z-20 F50\nG10 L20 P0 Z0")),
                AllOf(HasSubstr(":5: " + code + ": where a probe touches"), HasSubstr(kWhatToDo)));
}

TEST(Probing, HasFoundNothingWhenTheProgramIsImported) {
  for (const std::string number : {"5061", "5063", "5069", "5070"})
    EXPECT_THAT(refusal_of(program_of("G0 Z[#" + number + " + 5]")),
                AllOf(HasSubstr(":6: #" + number + " is what the last G38 found"), HasSubstr(kWhatToDo)));
  EXPECT_THAT(refusal_of(program_of("G0 Z#5071")), HasSubstr("the control's own, and not known here"));
}

TEST(Probing, IsNothingInAPartThatIsNotCarriedOut) {
  EXPECT_EQ(refusal_of(program_of("#1=0\no1 if [#1 EQ 1]\nG38.2 Z-5 F50\n#2=#5063\no1 endif")), "taken");
}

}  // namespace
}  // namespace rmac::rs274
