#pragma once

#include <gmock/gmock.h>

#include <filesystem>

#include "gateway/mechanism/assembler.hpp"
#include "gateway/rmac_cam/cam_tools.hpp"
#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {

/// What the parts of RMAC_CAM stand on: a mill in virtual mode that stands where the test puts it. No thread runs, so
/// what is queued stays queued.
class StandingMill : public testing::Test {
 protected:
  StandingMill() {
    supervisor_.on_queued([this](const Move& move, const auto&) { queued_.push_back(move); });
  }
  void SetUp() override { put_in(TestMachine::mill()); }
  /// Puts a mechanism in as another one, at its zero.
  void put_in(const sdk::DeviceObject& device) {
    BusRegistry registry;
    const ModuleLoader loader({std::filesystem::path(RMAC_BINARY_DIR) / "test_modules" / "good"});
    auto mechanism = assemble(device, {.virtual_mode = true}, loader, registry);
    ASSERT_TRUE(mechanism) << mechanism.error().message;
    mechanism_ = *mechanism;
    (void)supervisor_.install(mechanism_, 1, false);
    describe(mechanism_->device);
    stand_at(std::vector<double>(device.joints.size(), 0.0));
  }
  /// The parts look things up in this one from now on; it must outlive the test.
  void describe(const sdk::DeviceObject& device) {
    device_.change(&device);
    path_.mechanism_changed(true);
    joints_.mechanism_changed(true);
  }
  void stand_at(const std::vector<double>& joints) {
    status_.generation = 1;
    status_.state = ServoState::Engaged;
    status_.follows = true;
    status_.joint_count = status_.joint_count_with_held = static_cast<std::uint32_t>(joints.size());
    std::copy(joints.begin(), joints.end(), status_.position_set.begin());
    link_.status.write(status_);
  }
  /// The servo loop reports a fault.
  void fail() {
    status_.state = ServoState::Faulted;
    status_.follows = false;
    link_.status.write(status_);
    (void)supervisor_.advance(status_);
  }
  [[nodiscard]] Expected<> queue_line(std::int64_t id, const Vector& from, const Vector& to) {
    return supervisor_.prepare_move()
        .and_then([&] {
          return supervisor_.add_move(maker_.path_move(id, LineGeometry{{from, {0, 0, 1}}, {to, {0, 0, 1}}}));
        })
        .map([](bool) {});
  }

  ServoStatus status_;
  ServoLink link_{1};
  MotionSupervisor supervisor_{{}, link_};
  std::shared_ptr<Mechanism> mechanism_;
  DeviceInForce device_;
  CamPathSettings path_{device_, link_.history};
  CamJointSettings joints_{device_};
  MoveMaker maker_{device_, path_, joints_};
  ToolRack rack_{{}};
  CamTools tools_{device_, supervisor_, rack_, maker_};
  std::vector<Move> queued_;
};

}  // namespace rmac::gateway
