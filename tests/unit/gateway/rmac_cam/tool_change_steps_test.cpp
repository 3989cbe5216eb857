#include "gateway/rmac_cam/tool_change_steps.hpp"

#include "unit/gateway/rmac_cam/standing_mill.hpp"

namespace rmac::gateway {
namespace {

using testing::ElementsAre;
using Step = sdk::ToolChangeStep;

const Tool kOld{.number = 2}, kNew{.number = 5, .length_mm = 60, .max_torque_nm = 4};
const Tool kNone{.number = kNoTool};

class ToolChange : public StandingMill {
 protected:
  void SetUp() override {
    StandingMill::SetUp();
    changing_ = mechanism_->device;
    changing_.inputs = {{"Clamped", 7}};
    changing_.outputs = {{"Coolant", 5}, {"One", 0}, {"Two", 1}, {"Four", 2}, {"Clamp", 9}};
    describe(changing_);
    mechanism_->builder.restart(std::vector<double>{1, 2, 3}, {});
  }
  [[nodiscard]] std::vector<QueueStep> by_changer(const Tool& tool, int old = 2) {
    auto steps = steps_.by_changer(old, tool, mechanism_->builder);
    EXPECT_TRUE(steps) << steps.error().message;
    return steps ? *steps : std::vector<QueueStep>();
  }
  sdk::DeviceObject changing_;
  ToolChangeSteps steps_{device_, maker_};
};

TEST_F(ToolChange, ByHandStopsAsksAndMounts) {
  const auto steps = steps_.by_hand(kNew);
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_EQ(std::get<BeginToolChange>(steps[0]).outputs_off, std::uint64_t{1} << 5);
  EXPECT_EQ(std::get<AskPerson>(steps[1]).text, "insert tool 5, then confirm: rmac confirm 5");
  const auto& mount = std::get<MountTool>(steps[2]);
  EXPECT_EQ(mount.number, 5);
  EXPECT_EQ(mount.tip.p, (Vector{0, 0, -60}));
  EXPECT_EQ(mount.max_torque_nm, 4);
  EXPECT_EQ(std::get<AskPerson>(steps_.by_hand(kNone)[1]).text, "take the tool out, then confirm: rmac confirm 0");
}

TEST_F(ToolChange, ByChangerMovesTheJointsAndLeavesTheBuilderThere) {
  changing_.tool_change = {{.kind = Step::Kind::MoveTo, .joints = {10, 20, 30}}};
  const auto steps = by_changer(kNew);
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_FALSE(std::get<QueuedPath>(steps[1]).segments.empty());
  EXPECT_THAT(mechanism_->builder.end_joints(), ElementsAre(10, 20, 30));
  EXPECT_EQ(std::get<MountTool>(steps[2]).number, 5);
}

TEST_F(ToolChange, ByChangerSwitchesSelectsAndWaits) {
  changing_.tool_change = {{.kind = Step::Kind::Switch, .outputs = {"Clamp"}, .on = false},
                           {.kind = Step::Kind::Select, .whose = Step::Whose::Old, .outputs = {"One", "Two", "Four"}},
                           {.kind = Step::Kind::Select, .whose = Step::Whose::New, .outputs = {"One", "Two", "Four"}},
                           {.kind = Step::Kind::Await, .input = "Clamped", .on = true, .timeout_s = 3}};
  const auto steps = by_changer(kNew);
  ASSERT_EQ(steps.size(), 6U);
  const auto& off = std::get<SwitchOutputs>(steps[1]);
  EXPECT_EQ(off.mask, std::uint64_t{1} << 9);
  EXPECT_EQ(off.values, 0U);
  EXPECT_EQ(std::get<SwitchOutputs>(steps[2]).mask, 0b111U);
  EXPECT_EQ(std::get<SwitchOutputs>(steps[2]).values, 2U);
  EXPECT_EQ(std::get<SwitchOutputs>(steps[3]).values, 5U);
  const auto& await = std::get<AwaitInput>(steps[4]);
  EXPECT_EQ(await.bit, std::uint64_t{1} << 7);
  EXPECT_TRUE(await.on);
  EXPECT_EQ(await.timeout_s, 3);
}

TEST_F(ToolChange, ByChangerLeavesOutWhatIsAboutAToolThatIsNone) {
  changing_.tool_change = {{.kind = Step::Kind::Switch, .whose = Step::Whose::Old, .outputs = {"One"}},
                           {.kind = Step::Kind::Switch, .whose = Step::Whose::New, .outputs = {"Two"}},
                           {.kind = Step::Kind::Switch, .outputs = {"Four"}}};
  const auto only_out = by_changer(kNone);
  ASSERT_EQ(only_out.size(), 4U);
  EXPECT_EQ(std::get<SwitchOutputs>(only_out[1]).mask, 1U);
  EXPECT_EQ(std::get<SwitchOutputs>(only_out[2]).mask, 4U);
  const auto only_in = by_changer(kNew, kNoTool);
  ASSERT_EQ(only_in.size(), 4U);
  EXPECT_EQ(std::get<SwitchOutputs>(only_in[1]).mask, 2U);
}

TEST_F(ToolChange, ByChangerRefusesANumberThatItsOutputsCannotTell) {
  changing_.tool_change = {{.kind = Step::Kind::Select, .outputs = {"One", "Two"}}};
  EXPECT_EQ(steps_.by_changer(2, kNew, mechanism_->builder).error().message,
            "DoToolChange: tool 5 has no place in the changer, which knows tools up to 3");
}

}  // namespace
}  // namespace rmac::gateway
