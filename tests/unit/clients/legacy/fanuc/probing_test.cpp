#include <gmock/gmock.h>

#include "unit/clients/legacy/fanuc/imported.hpp"

namespace rmac::fanuc {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST(FanucProbing, IsRefusedWithWhatToDo) {
  constexpr const char* kWhatToDo = "rmac measure PLAN.json --apply";
  EXPECT_THAT(refusal_of(program_of("G31 Z-5. F50.")),
              AllOf(StartsWith("5:1: G31: where a probe"), HasSubstr(kWhatToDo)));
  EXPECT_THAT(refusal_of(program_of("#100=#5063")),
              AllOf(StartsWith("5:6: #5063 is what the last G31 found"), HasSubstr(kWhatToDo)));
  EXPECT_THAT(refusal_of(program_of("G65 P9811 Z-5. S1.")),
              AllOf(StartsWith("5:1: O9811 is not in this file"), HasSubstr(kWhatToDo)));
  EXPECT_EQ(refusal_of(program_of("G65 P9811 Z-5.", "O9811\nM99\n")), "taken") << "it is there";
  EXPECT_THAT(refusal_of(program_of("#100=#5101")), HasSubstr("places of the tool"));
}

}  // namespace
}  // namespace rmac::fanuc
