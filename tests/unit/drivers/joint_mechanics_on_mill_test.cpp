#include "mill_on_simulated_bus.hpp"

namespace rmac::mill_test {
namespace {

/// The circle of the figures with feedforward, on a mill whose table is not where its screws are.
class MechanicsOnMill : public testing::Test, protected MillRun {
 protected:
  Ballbar measure(const JointMechanics& declared) {
    return measure_circle([](nlohmann::json& device) { choose_feedforward(device); },
                          [&](Mill&, ServoLoopParts& parts) {
                            for (std::size_t j = 0; j < 2; ++j) parts.joints[j].mechanics = declared;
                          });
  }
};

class PitchErrorsOnMill : public MechanicsOnMill {
 protected:
  // 20 µm over a wave of 40 mm: no straight line, which would be a scale.
  static double error(double mm) { return 0.020 * std::sin(mm * 2 * std::numbers::pi / 40); }
  void SetUp() override {
    truth_ = [](std::size_t, double mm) { return mm + error(mm); };
  }
};

TEST_F(PitchErrorsOnMill, AreSeenInTheCircleWhereNobodyDeclaresThem) {
  EXPECT_GT(measure({}).contour_error(), 0.015);
}

TEST_F(PitchErrorsOnMill, AreMadeGoodWhereTheyAreDeclared) {
  JointMechanics declared;
  declared.pitch = {-60, 2, {}};
  for (int i = 0; i <= 60; ++i) declared.pitch.errors.push_back(error(-60 + 2 * i));
  EXPECT_LT(measure(declared).contour_error(), 0.005);
}

class BacklashOnMill : public MechanicsOnMill {
 protected:
  static constexpr double kBacklash = 0.020;
  void SetUp() override {
    // The table's friction holds it until the other flank takes it along.
    truth_ = [this](std::size_t axis, double mm) {
      table_[axis] = std::clamp(table_[axis], mm - kBacklash / 2, mm + kBacklash / 2);
      return table_[axis];
    };
  }
  std::array<double, 2> table_{};
};

TEST_F(BacklashOnMill, IsSeenInTheCircleWhereNobodyDeclaresIt) {
  EXPECT_GT(measure({}).reversal_spike(), 0.015);
}

TEST_F(BacklashOnMill, IsMadeGoodWhereItIsDeclared) {
  JointMechanics declared;
  declared.backlash = kBacklash;
  const Ballbar ballbar = measure(declared);
  EXPECT_LT(ballbar.reversal_spike(), 0.010);
  EXPECT_LT(ballbar.contour_error(), 0.010);
  RecordProperty("contour_error_um", std::to_string(ballbar.contour_error() * 1e3));
}

}  // namespace
}  // namespace rmac::mill_test
