#include <gmock/gmock.h>

#include "gateway/buses/built_in_interfaces.hpp"

namespace rmac::gateway {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class SimulatedValves : public testing::Test {
 protected:
  SimulatedValves() { add_built_in_interfaces(registry_, 0.001); }
  std::string refusal(const std::vector<double>& valve, std::map<std::string, std::string> texts = {}) {
    const auto made =
        registry_.check_io_interface({"SimulatedValves", {{"door", valve}}, std::move(texts)}, ModuleLoader{{}});
    return made ? "taken" : made.error().message;
  }
  BusRegistry registry_;
};

TEST_F(SimulatedValves, FollowTheirOutputsAfterTheirTime) {
  const auto made = registry_.acquire_io({"SimulatedValves", {{"door", {3, 5, 0, 0.003}}, {"lock", {4, 6, 1, 0}}}, {}},
                                         ModuleLoader{{}});
  ASSERT_TRUE(made) << made.error().message;
  std::vector<int> door, lock;
  for (int cycle = 0; cycle < 8; ++cycle) {
    std::uint64_t inputs = 0;
    ASSERT_TRUE((*made)->exchange(cycle >= 2 ? 1U << 3 | 1U << 4 : 0, inputs));
    door.push_back((inputs & 1U << 5) != 0 ? 1 : 0);
    lock.push_back((inputs & 1U << 6) != 0 ? 1 : 0);
  }
  EXPECT_THAT(door, ElementsAre(0, 0, 0, 0, 0, 1, 1, 1));
  EXPECT_THAT(lock, ElementsAre(1, 1, 0, 0, 0, 0, 0, 0)) << "its switch is on while the output is off";
}

TEST_F(SimulatedValves, RefuseWhatIsNone) {
  for (const std::vector<double>& sound :
       {std::vector<double>{0, 0, 0, 0}, {63, 63, 1, 60}, {0, 63, 0, 0.5}, {63, 0, 1, 0}}) {
    EXPECT_EQ(refusal(sound), "taken");
  }
  for (const std::vector<double>& wrong : {std::vector<double>{},
                                           {1, 2, 0},
                                           {1, 2, 0, 1, 1},
                                           {-1, 2, 0, 1},
                                           {64, 2, 0, 1},
                                           {1.5, 2, 0, 1},
                                           {1, -1, 0, 1},
                                           {1, 64, 0, 1},
                                           {1, 2.5, 0, 1},
                                           {1, 2, 2, 1},
                                           {1, 2, -1, 1},
                                           {1, 2, 0.5, 1},
                                           {1, 2, 0, -0.001},
                                           {1, 2, 0, 60.001}}) {
    EXPECT_THAT(refusal(wrong),
                HasSubstr("SimulatedValves: parameter door must be four numbers: an output from 0 to 63"));
  }
  EXPECT_THAT(refusal({1, 2, 0, 1}, {{"door", "open"}}), HasSubstr("takes no parameter that is a text"));
}

}  // namespace
}  // namespace rmac::gateway
