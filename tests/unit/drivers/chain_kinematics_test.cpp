#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "conformance/holds.hpp"
#include "conformance/loaded_module.hpp"
#include "gateway/verification/checks/kinematics_check.hpp"
#include "rmac/motion/frame.hpp"

namespace {

using namespace rmac;
using testing::HasSubstr;
using verifier::JointRange;

/// The module as a mechanism's device.json would have it.
class Chain {
 public:
  using Numbers = std::map<std::string, std::vector<double>>;
  using Texts = std::map<std::string, std::string>;

  Chain(const Texts& texts, const Numbers& numbers) {
    std::vector<sdk::Parameter> parameters;
    for (const auto& [name, text] : texts) parameters.push_back({name.c_str(), {}, text.c_str()});
    for (const auto& [name, values] : numbers) parameters.push_back({name.c_str(), values, nullptr});
    kinematics = module_.create<Kinematics>(parameters);
  }
  [[nodiscard]] const std::string& error() const { return module_.error(); }

 private:
  conformance::LoadedModule module_{"modules", "ChainKinematics"};

 public:
  std::shared_ptr<Kinematics> kinematics;  ///< dies before its module
};

struct Machine {
  const char* name;
  Chain::Texts texts;
  Chain::Numbers numbers;
  std::vector<JointRange> ranges;
};
void PrintTo(const Machine& machine, std::ostream* out) {
  *out << machine.name;
}

const JointRange kSlide{-300, 300}, kTilt{-110, 110}, kRound{-540, 540};

const std::vector<Machine> kMachines{
    {"SlidesAlone", {{"joints", "X Y Z"}}, {}, {kSlide, kSlide, kSlide}},
    {"SkewSlides", {{"joints", "X Y Z"}}, {{"Y", {0.3, 1, 0}}, {"Z", {-0.2, 0.5, 1}}}, {kSlide, kSlide, kSlide}},
    {"TwoSlides", {{"joints", "X Z"}}, {{"interface", {0, 20, 0}}}, {kSlide, kSlide}},
    {"RotaryTable",
     {{"joints", "X Y Z A"}, {"chain", "A X Y Z"}},
     {{"A", {1, 0, 0, 0, 10, -40}}},
     {kSlide, kSlide, kSlide, kRound}},
    {"TableAC",
     {{"joints", "X Y Z A C"}, {"chain", "C A X Y Z"}},
     {{"A", {1, 0, 0, 0, 0, -60}}, {"C", {0, 0, 1, 5, 3, 0}}},
     {kSlide, kSlide, kSlide, kTilt, kRound}},
    {"TableBC",
     {{"joints", "X Y Z B C"}, {"chain", "C B X Y Z"}},
     {{"B", {0, 1, 0, 7, 0, -60}}},
     {kSlide, kSlide, kSlide, kTilt, kRound}},
    {"HeadCA", {{"joints", "X Y Z C A"}}, {{"A", {1, 0, 0, 0, 0, 150}}}, {kSlide, kSlide, kSlide, kRound, kTilt}},
    {"HeadBTableC",
     {{"joints", "X Y Z B C"}, {"chain", "C X Y Z B"}},
     {{"B", {0, 1, 0, 0, 0, 120}}, {"C", {0, 0, -1, 30, -20, 0}}},
     {kSlide, kSlide, kSlide, kTilt, kRound}},
    {"SlidesBetweenAndOut",
     {{"joints", "X Y Z A C"}, {"chain", "Y C X A Z"}},
     {{"A", {1, 0, 0, 0, 0, 90}}},
     {kSlide, kSlide, kSlide, {-80, 80}, kRound}},
    {"NutatingHead",
     {{"joints", "X Y Z C B"}},
     {{"B", {0, 0.7071067811865476, 0.7071067811865476, 0, 15, 110}}},
     {kSlide, kSlide, kSlide, kRound, {-175, 175}}},
};

class ChainKinematics : public testing::TestWithParam<Machine> {};
INSTANTIATE_TEST_SUITE_P(Machines, ChainKinematics, testing::ValuesIn(kMachines),
                         [](const auto& made) { return made.param.name; });

TEST_P(ChainKinematics, Conforms) {
  const Chain chain(GetParam().texts, GetParam().numbers);
  ASSERT_TRUE(chain.kinematics) << chain.error();
  const std::vector<Frame> tools{{}, {{1, -2, 80}, {1, 0, 0, 0}}, {{3, 0, 60}, {0.98, 0.1, -0.05, 0.1642}}};
  std::vector<Frame> unit;
  for (const Frame& tool : tools) unit.push_back(normalized(tool));
  EXPECT_TRUE(conformance::holds(verifier::check_kinematics(*chain.kinematics, {GetParam().ranges, unit, 20'000})));
}

TEST_P(ChainKinematics, FindsNoJointsForAPoseThatIsNoNumber) {
  const Chain chain(GetParam().texts, GetParam().numbers);
  ASSERT_TRUE(chain.kinematics) << chain.error();
  std::vector<double> joints(chain.kinematics->joint_count()), all(16 * joints.size());
  for (const ToolPose& pose : {ToolPose{{0, 0, std::nan("")}, {0, 0, 1}}, ToolPose{{0, 0, 0}, {std::nan(""), 0, 1}}}) {
    EXPECT_EQ(chain.kinematics->inverse(pose, {}, joints, joints), KinematicsStatus::OutOfReach);
    EXPECT_EQ(chain.kinematics->solutions(pose, {}, joints, all), 0U);
  }
}

const Machine& machine(const std::string& name) {
  return *std::find_if(kMachines.begin(), kMachines.end(), [&](const Machine& m) { return m.name == name; });
}

TEST(ChainAtThePole, LeavesTheFreeTurnWhereItIs) {
  for (const char* name : {"TableAC", "TableBC", "HeadCA", "HeadBTableC"}) {
    const Chain chain(machine(name).texts, machine(name).numbers);
    ASSERT_TRUE(chain.kinematics) << chain.error();
    const std::size_t c = std::string(name) == "HeadCA" ? 3 : 4, tilt = 7 - c;
    for (const double turned : {0.0, 37.0, -250.0, 400.0}) {
      std::vector<double> seed{1, 2, 3, 0, 0}, joints(5);
      seed[c] = turned;
      seed[tilt] = 0.5;
      const ToolPose pose{{10, 20, 30}, {0, 0, 1}};
      ASSERT_EQ(chain.kinematics->inverse(pose, {}, seed, joints), KinematicsStatus::Ok);
      EXPECT_EQ(joints[c], turned) << name;
      EXPECT_NEAR(joints[tilt], 0, 1e-9) << name;
      ToolPose again;
      chain.kinematics->forward(joints, {}, again);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(again.tip[k], pose.tip[k], 1e-9);
    }
  }
}

TEST(ChainCloseToThePole, KeepsItsDigits) {
  for (const char* name : {"TableAC", "HeadCA", "NutatingHead"}) {
    const Chain chain(machine(name).texts, machine(name).numbers);
    ASSERT_TRUE(chain.kinematics) << chain.error();
    std::mt19937 random(3);
    std::uniform_real_distribution<> turn(-180, 180), power(-11, -3);
    for (int i = 0; i < 2000; ++i) {
      const double lean = std::pow(10, power(random)), around = turn(random) * std::numbers::pi / 180;
      const ToolPose pose{{10, 20, 30}, {lean * std::cos(around), lean * std::sin(around), std::sqrt(1 - lean * lean)}};
      const std::vector<double> seed{0, 0, 0, turn(random), turn(random)};
      std::vector<double> joints(5);
      ASSERT_EQ(chain.kinematics->inverse(pose, {}, seed, joints), KinematicsStatus::Ok);
      ToolPose again;
      chain.kinematics->forward(joints, {}, again);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(again.tip[k], pose.tip[k], 1e-9) << name << " leaning " << lean;
        EXPECT_NEAR(again.axis[k], pose.axis[k], 1e-14) << name << " leaning " << lean;
      }
    }
  }
}

TEST(ChainOutOfReach, IsTold) {
  struct Case {
    const char* machine;
    ToolPose pose;
  };
  for (const Case& it :
       {Case{"SlidesAlone", {{0, 0, 0}, {0.01, 0, 1}}}, Case{"TwoSlides", {{0, 21, 0}, {0, 0, 1}}},
        Case{"RotaryTable", {{0, 0, 0}, {0.6, 0, 0.8}}}, Case{"NutatingHead", {{0, 0, 0}, {0, 0.6, -0.8}}}}) {
    const Chain chain(machine(it.machine).texts, machine(it.machine).numbers);
    ASSERT_TRUE(chain.kinematics) << chain.error();
    std::vector<double> joints(chain.kinematics->joint_count());
    EXPECT_EQ(chain.kinematics->inverse(it.pose, {}, joints, joints), KinematicsStatus::OutOfReach) << it.machine;
  }
}

TEST(ChainParameters, AreRefusedWhereTheyMakeNoChain) {
  struct Case {
    Chain::Texts texts;
    Chain::Numbers numbers;
    const char* message;
  };
  const std::vector<Case> cases{
      {{}, {}, "parameter joints must name the joints"},
      {{{"joints", "X Y tilt"}}, {}, "parameter tilt must be the joint's axis"},
      {{{"joints", "X Y Z"}}, {{"Z", {0, 0, 0}}}, "parameter Z must be the joint's axis"},
      {{{"joints", "X Y Z"}}, {{"Z", {0, 1}}}, "parameter Z must be the joint's axis"},
      {{{"joints", "X Y Z"}}, {{"Z", {1, 1, 0}}}, "independent directions"},
      {{{"joints", "X Y Z A"}}, {{"A", {1, 0, 0, std::nan(""), 0, 0}}}, "parameter A must be the joint's axis"},
      {{{"joints", "X Y Z A"}, {"chain", "A X Y"}}, {}, "parameter chain must name each joint"},
      {{{"joints", "X Y Z A"}, {"chain", "A X Y B"}}, {}, "parameter chain must name each joint"},
      {{{"joints", "X Y Z X"}}, {}, "parameter chain must name each joint"},
      {{{"joints", "X Y Z A B C"}}, {}, "at most 2 turns"},
      {{{"joints", "X Y Z W"}}, {{"W", {0, 0, 1}}}, "at most 3 slides"},
      {{{"joints", "X Y Z A C"}}, {{"C", {2, 0, 0, 0, 0, 5}}}, "must not be parallel"},
      {{{"joints", "X Y Z"}}, {{"interface", {0, 0, 1, 2, 0, 0, 0}}}, "parameter interface"},
      {{{"joints", "X Y Z"}}, {{"pivot", {100}}}, "\"pivot\" is not understood"},
  };
  for (const Case& it : cases) {
    const Chain chain(it.texts, it.numbers);
    EXPECT_FALSE(chain.kinematics) << it.message;
    EXPECT_THAT(chain.error(), HasSubstr(it.message));
  }
}

}  // namespace
