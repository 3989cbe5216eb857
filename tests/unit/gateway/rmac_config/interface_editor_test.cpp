#include "gateway/rmac_config/interface_editor.hpp"

#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

using testing::ElementsAre;

class Interfaces : public testing::Test {
 protected:
  Draft draft_;
  std::vector<std::string> checked_;
  InterfaceEditor editor_{draft_, check("control "), check("io ")};

 private:
  InterfaceEditor::Check check(const std::string& what) {
    return [this, what](const sdk::ModuleChoice& choice) {
      checked_.push_back(what + choice.name);
      return Expected<>();
    };
  }
};

TEST_F(Interfaces, AreCheckedAsTheyWereChosen) {
  ASSERT_TRUE(editor_.set_control({"Bus", {}, {}}));
  ASSERT_TRUE(editor_.set_io({"Lamps", {}, {}}));
  EXPECT_TRUE(checked_.empty()) << "until they are initialized";
  ASSERT_TRUE(editor_.initialize_control());
  ASSERT_TRUE(editor_.initialize_io());
  EXPECT_THAT(checked_, ElementsAre("control Bus", "io Lamps"));
  EXPECT_EQ(draft_.device.digital_control_interface.name, "Bus");
  EXPECT_EQ(draft_.device.digital_io_interface.name, "Lamps");
  EXPECT_EQ(draft_.extent, Draft::Extent::Configuration);
}

TEST_F(Interfaces, ToDrivesAreNeededAndToInputsAndOutputsAreNot) {
  EXPECT_FALSE(editor_.set_control({}));
  EXPECT_EQ(editor_.initialize_control().error().code, MinorCode::InvalidParameter);
  EXPECT_TRUE(editor_.set_io({}));
  EXPECT_TRUE(editor_.initialize_io());
  EXPECT_TRUE(checked_.empty());
}

}  // namespace
}  // namespace rmac::gateway
