#include "gateway/animation/machine_shape.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gateway/animation/drawing_json.hpp"
#include "rmac/modules/chain_kinematics.hpp"

namespace rmac::gateway {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Slides X and Z, which counts what is asked of it.
class CountingSlides final : public Kinematics {
 public:
  std::size_t joint_count() const noexcept override { return 2; }
  JointType joint_type(std::size_t) const noexcept override { return JointType::Linear; }
  void forward(std::span<const double> joints, const Frame& tool, ToolPose& pose) const noexcept override {
    ++asked;
    pose = {{joints[0] + tool.p[0], tool.p[1], joints[1] + tool.p[2]}, {0, 0, 1}};
  }
  KinematicsStatus inverse(const ToolPose&, const Frame&, std::span<const double>,
                           std::span<double>) const noexcept override {
    return KinematicsStatus::OutOfReach;
  }
  void jacobian(std::span<const double>, const Frame&, std::span<double>) const noexcept override {}
  mutable int asked = 0;
};

sdk::DeviceObject slides(const std::string& name = "Slides") {
  sdk::DeviceObject device;
  device.name = name;
  for (const char* joint : {"X", "Z"}) {
    device.joints.emplace_back().limits = {joint, JointType::Linear, JointLimitType::Limited, -50, 50, 1, 1, 1};
  }
  return device;
}

MachineBodies bodies() {
  return {{"X", "base", "Z"},
          {{"table top", "X", BoxShape{{1, 2, 3}}, {{0, 0, -5}, {1, 0, 0, 0}}, "#102030"},
           {"post", "base", ConeShape{2, 2, 9}, {}, ""},
           {"nose", "Z", ConeShape{2, 1, 9}, {}, ""},
           {"ball", "spindle", SphereShape{4}, {}, ""},
           {"head", "spindle", MeshShape{"/there/meshes/head.stl"}, {}, ""}}};
}

struct LoadedShape {
  MachineShape shape;
  std::shared_ptr<CountingSlides> kinematics = std::make_shared<CountingSlides>();

  void load(const sdk::DeviceObject& device, MachineBodies with, std::int64_t cycle = 0) {
    shape.mechanism_changed(&device, kinematics, cycle);
    shape.set_bodies(std::move(with));
  }
};

TEST(MachineShape, ComputesNothingBeforeSomebodyAsksAndThenOnce) {
  LoadedShape loaded;
  MachineShape& shape = loaded.shape;
  loaded.load(slides(), bodies());
  EXPECT_EQ(loaded.kinematics->asked, 0);
  EXPECT_TRUE(shape.drawing()->links);
  const int asked = loaded.kinematics->asked;
  EXPECT_GT(asked, 0);
  EXPECT_EQ(shape.drawing(), shape.drawing());
  EXPECT_EQ(loaded.kinematics->asked, asked);
}

TEST(MachineShape, HasAnotherNumberForAnotherMachineAndKeepsItWhereNothingChanged) {
  LoadedShape loaded;
  MachineShape& shape = loaded.shape;
  loaded.load(slides(), bodies(), 40);
  const auto first = shape.drawing();
  EXPECT_EQ(first->machine, "Slides");
  EXPECT_EQ(first->after_cycle, 40);
  const sdk::DeviceObject same = slides(), other = slides("Others");
  shape.mechanism_changed(&same, loaded.kinematics, 50);
  EXPECT_EQ(shape.drawing(), first) << "as after a reset";
  shape.mechanism_changed(&other, loaded.kinematics, 60);
  EXPECT_NE(shape.drawing()->number, first->number);
  EXPECT_EQ(shape.drawing()->after_cycle, 60);
  const auto second = shape.drawing();
  shape.mechanism_changed(&other, std::make_shared<CountingSlides>(), 70);
  EXPECT_NE(shape.drawing()->number, second->number) << "its parameters may be others";
  EXPECT_EQ(first->machine, "Slides") << "who draws it still has it";
}

TEST(MachineShape, LetsAMachineGoThatIsUnloaded) {
  LoadedShape loaded;
  MachineShape& shape = loaded.shape;
  loaded.load(slides(), bodies());
  (void)shape.drawing();
  const std::weak_ptr<CountingSlides> module = loaded.kinematics;
  loaded.kinematics.reset();
  shape.mechanism_changed(nullptr, nullptr, 0);
  EXPECT_TRUE(module.expired()) << "its module could not be closed";
  EXPECT_EQ(shape.drawing()->missing, "no machine is loaded; load one with Device.Load");
  EXPECT_FALSE(shape.drawing()->links);
}

TEST(MachineShape, SaysWhatIsMissing) {
  LoadedShape loaded;
  MachineShape& shape = loaded.shape;
  loaded.load(slides(), {});
  EXPECT_EQ(shape.drawing()->missing,
            "nothing is known of the links of Slides: the device.json of its machine has no Chain and no Geometry");
  EXPECT_FALSE(shape.drawing()->links);
  MachineBodies chain_alone = bodies(), wrong_names = bodies();
  chain_alone.bodies.clear();
  loaded.load(slides(), chain_alone);
  EXPECT_TRUE(shape.drawing()->links);
  EXPECT_THAT(shape.drawing()->missing, HasSubstr("where the links of Slides stand is known"));
  wrong_names.chain = {"X", "base", "Y"};
  loaded.load(slides(), wrong_names);
  EXPECT_FALSE(shape.drawing()->links);
  EXPECT_THAT(shape.drawing()->missing, HasSubstr("the joints of Slides are not those of the Chain"));
}

TEST(MachineShape, SaysWhyALinkStandsNobodyKnowsWhere) {
  // A turn that carries a slide, told the other way round.
  sdk::DeviceObject device = slides();
  device.joints[1].limits.type = JointType::Rotary;
  const std::vector<modules::ScrewAxis> axes{{JointType::Linear, {1, 0, 0}, {}}, {JointType::Rotary, {0, 1, 0}, {}}};
  MachineShape shape;
  shape.mechanism_changed(
      &device, std::make_shared<modules::ChainKinematics>(axes, std::vector<std::size_t>{1, 0}, Frame{{9, 0, 0}}), 0);
  shape.set_bodies({{"base", "X", "Z"}, {}});
  EXPECT_FALSE(shape.drawing()->links);
  EXPECT_THAT(shape.drawing()->missing, HasSubstr("where the links of Slides stand is not known: /Chain is base X Z"));
}

TEST(DrawingJson, HasBodiesAsADeviceJsonHasThemAndNoFolder) {
  LoadedShape loaded;
  MachineShape& shape = loaded.shape;
  loaded.load(slides(), bodies());
  const json told = to_json(*shape.drawing());
  EXPECT_EQ(told["machine"], "Slides");
  EXPECT_EQ(told["geometry"], shape.drawing()->number);
  EXPECT_EQ(told["missing"], "");
  EXPECT_EQ(told["joints"], json::parse(R"(["X", "Z"])"));
  EXPECT_EQ(told["links"], json::parse(R"(["base", "X", "Z", "spindle", "table"])"));
  EXPECT_EQ(told["interface"]["p"], json::parse("[0.0, 0.0, 0.0]"));
  EXPECT_EQ(told["bodies"][0],
            json::parse(R"({"Name": "table top", "Link": "X", "Shape": {"Box": {"Size": [1.0, 2.0, 3.0]}},
    "Pose": {"p": [0.0, 0.0, -5.0], "q": [1.0, 0.0, 0.0, 0.0]}, "Colour": "#102030"})"));
  EXPECT_EQ(told["bodies"][1]["Shape"], json::parse(R"({"Cylinder": {"Radius": 2.0, "Height": 9.0}})"));
  EXPECT_EQ(told["bodies"][2]["Shape"], json::parse(R"({"Cone": {"Radius": 2.0, "TopRadius": 1.0, "Height": 9.0}})"));
  EXPECT_EQ(told["bodies"][3]["Shape"], json::parse(R"({"Sphere": {"Radius": 4.0}})"));
  EXPECT_EQ(told["bodies"][4]["Shape"], json::parse(R"({"Mesh": {"File": "head.stl"}})"));
  EXPECT_FALSE(told["bodies"][1].contains("Colour"));
  shape.mechanism_changed(nullptr, nullptr, 0);
  const json none = to_json(*shape.drawing());
  EXPECT_TRUE(none["machine"].is_null());
  EXPECT_TRUE(none["interface"].is_null());
  EXPECT_TRUE(none["bodies"].empty());
  EXPECT_EQ(none["missing"], "no machine is loaded; load one with Device.Load");
}

}  // namespace
}  // namespace rmac::gateway
