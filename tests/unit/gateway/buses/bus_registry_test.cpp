#include "gateway/buses/bus_registry.hpp"

#include <gmock/gmock.h>

#include <vector>

#include "rmac/motion/ports/digital_io_interface.hpp"

namespace rmac::gateway {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Log = std::vector<std::string>;

/// Writes down that it is started and stopped.
class LoggedBus final : public DigitalControlInterface, public fieldbus::BusReports {
 public:
  LoggedBus(std::string name, Log& log) : name_(std::move(name)), log_(log) { log_.push_back("make " + name_); }
  std::size_t axis_count() const noexcept override { return 2; }
  Expected<> start() override {
    log_.push_back("start " + name_);
    return name_ == "broken" ? Expected<>(failure(MinorCode::ResponseTimeout, "no drive answers")) : Expected<>();
  }
  void stop() noexcept override { log_.push_back("stop " + name_); }
  [[nodiscard]] bool receive(std::span<DriveFeedback>) noexcept override { return true; }
  bool send(std::span<const DriveCommand>) noexcept override { return true; }
  fieldbus::BusReport report() const override {
    fieldbus::BusReport told;
    told.interface = name_;
    return told;
  }

 private:
  std::string name_;
  Log& log_;
};

class LoggedIo final : public DigitalIoInterface, public fieldbus::modbus::LineReports {
 public:
  LoggedIo(std::string name, Log& log) : name_(std::move(name)), log_(log) { log_.push_back("make " + name_); }
  Expected<> start() override {
    log_.push_back("start " + name_);
    return name_ == "broken" ? Expected<>(failure(MinorCode::ResponseTimeout, "no device answers")) : Expected<>();
  }
  void stop() noexcept override { log_.push_back("stop " + name_); }
  bool exchange(std::uint64_t, std::uint64_t&) noexcept override { return true; }
  fieldbus::modbus::LineReport line_report() const override {
    fieldbus::modbus::LineReport told;
    told.endpoint = name_;
    return told;
  }

 private:
  std::string name_;
  Log& log_;
};

class Buses : public testing::Test {
 protected:
  Buses() {
    const auto make = [this](const std::string& bus, const sdk::ModuleChoice&, const ModuleLoader&) {
      return Expected<std::shared_ptr<DigitalControlInterface>>(std::make_shared<LoggedBus>(bus, log_));
    };
    const auto make_io = [this](const sdk::ModuleChoice& choice, const ModuleLoader&) {
      return Expected<std::shared_ptr<DigitalIoInterface>>(std::make_shared<LoggedIo>(choice.name, log_));
    };
    registry_.add_control_interface("Kept", make);
    registry_.add_control_interface("MadeAnew", make, BusRegistry::Unused::IsMadeAnew);
    registry_.add_io_interface("Io", make_io);
    registry_.add_io_interface("broken", make_io);
  }
  auto acquire(const std::string& bus, const sdk::ModuleChoice& choice) {
    return registry_.acquire(bus, choice, modules_);
  }
  auto acquire_io(const sdk::ModuleChoice& choice) { return registry_.acquire_io(choice, modules_); }
  /// What happened since this was asked last.
  Log happened() { return std::exchange(log_, {}); }

  const sdk::ModuleChoice kept_{"Kept", {{"node", {1}}}, {}}, other_{"Kept", {{"node", {2}}}, {}};
  const sdk::ModuleChoice io_{"Io", {{"line", {1}}}, {}}, other_io_{"Io", {{"line", {2}}}, {}};
  const ModuleLoader modules_{{}};
  Log log_;
  BusRegistry registry_;
};

TEST_F(Buses, AreSharedAsLongAsTheSameIsWantedOfThem) {
  const auto first = acquire("can0", kept_), second = acquire("can0", kept_);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(*first, *second);
  EXPECT_THAT(happened(), ElementsAre("make can0", "start can0"));
  const auto refused = acquire("can0", other_);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("bus can0 is run by Kept for the mechanism in force"));
  EXPECT_THAT(happened(), IsEmpty());
}

TEST_F(Buses, StopWhenNothingUsesThemAndStartAgainAsTheyWere) {
  auto used = acquire("can0", kept_);
  ASSERT_TRUE(used);
  const DigitalControlInterface* const interface = (*used)->interface.get();
  happened();
  registry_.stop_unused();
  EXPECT_THAT(happened(), IsEmpty()) << "it is in use";
  used->reset();
  registry_.stop_unused();
  registry_.stop_unused();
  EXPECT_THAT(happened(), ElementsAre("stop can0")) << "once";
  used = acquire("can0", kept_);
  ASSERT_TRUE(used);
  EXPECT_EQ((*used)->interface.get(), interface);
  EXPECT_THAT(happened(), ElementsAre("start can0"));
}

TEST_F(Buses, AreMadeAnewForOtherParametersWhenNothingUsesThem) {
  ASSERT_TRUE(acquire("can0", kept_));
  ASSERT_TRUE(acquire("can0", other_));
  EXPECT_THAT(happened(), ElementsAre("make can0", "start can0", "stop can0", "make can0", "start can0"));
  registry_.stop_unused();
  ASSERT_TRUE(acquire("can0", kept_));
  EXPECT_THAT(happened(), ElementsAre("stop can0", "make can0", "start can0"));
}

TEST_F(Buses, WhoseFilesMayHaveChangedAreMadeAnewForEachUse) {
  const sdk::ModuleChoice anew{"MadeAnew", {}, {}};
  auto used = acquire("can0", anew);
  ASSERT_TRUE(used);
  ASSERT_TRUE(acquire("can0", anew));
  EXPECT_THAT(happened(), ElementsAre("make can0", "start can0")) << "it is in use";
  used->reset();
  ASSERT_TRUE(acquire("can0", anew));
  EXPECT_THAT(happened(), IsEmpty()) << "it runs";
  registry_.stop_unused();
  ASSERT_TRUE(acquire("can0", anew));
  EXPECT_THAT(happened(), ElementsAre("stop can0", "make can0", "start can0"));
}

TEST_F(Buses, SayWhyTheyDoNotComeUp) {
  const auto broken = acquire("broken", kept_);
  ASSERT_FALSE(broken);
  EXPECT_EQ(broken.error().message, "bus broken did not come up: no drive answers");
  EXPECT_EQ(broken.error().code, MinorCode::ResponseTimeout);
  EXPECT_FALSE(acquire("broken", kept_)) << "and are tried again";
  EXPECT_THAT(happened(), ElementsAre("make broken", "start broken", "start broken"));
  EXPECT_THAT(registry_.reports().can, IsEmpty());
  ASSERT_FALSE(acquire_io({"broken", {}, {}}));
}

TEST_F(Buses, OfAnUnknownInterfaceAreRefusedWithTheKnownOnes) {
  const auto bus = acquire("can0", {"Unheard", {}, {}});
  ASSERT_FALSE(bus);
  EXPECT_THAT(bus.error().message, HasSubstr("no digital control interface \"Unheard\": built in are Kept, MadeAnew"));
  const auto io = acquire_io({"Unheard", {}, {}});
  ASSERT_FALSE(io);
  EXPECT_THAT(io.error().message, HasSubstr("no digital I/O interface \"Unheard\": built in are Io, broken"));
  EXPECT_TRUE(registry_.check_control_interface(kept_, modules_));
  EXPECT_FALSE(registry_.check_control_interface({"Unheard", {}, {}}, modules_));
  EXPECT_FALSE(registry_.check_io_interface({"Unheard", {}, {}}, modules_));
  EXPECT_THAT(happened(), IsEmpty());
}

TEST_F(Buses, TellWhatTheyWentThroughWhileTheyRun) {
  const auto can = acquire("can0", kept_), more = acquire("can1", kept_);
  const auto io = acquire_io(io_);
  ASSERT_TRUE(can && more && io);
  ASSERT_TRUE(acquire("can2", kept_));
  registry_.stop_unused();
  const fieldbus::FieldbusReport told = registry_.reports();
  ASSERT_EQ(told.can.size(), 2U);
  EXPECT_EQ(told.can[0].interface, "can0");
  EXPECT_EQ(told.can[1].interface, "can1");
  ASSERT_EQ(told.modbus.size(), 1U);
  EXPECT_EQ(told.modbus[0].endpoint, "Io");
}

TEST_F(Buses, KnowWhetherADeviceWantsThemOtherwise) {
  sdk::DeviceObject device;
  device.digital_control_interface = kept_;
  device.digital_io_interface = io_;
  device.actuators.resize(1);
  device.actuators[0].bus = "can0";
  EXPECT_FALSE(registry_.runs_otherwise(device)) << "nothing runs";
  {
    const auto can = acquire("can0", kept_);
    const auto io = acquire_io(io_);
    ASSERT_TRUE(can && io);
    EXPECT_FALSE(registry_.runs_otherwise(device));
    device.digital_control_interface = other_;
    EXPECT_TRUE(registry_.runs_otherwise(device));
    device.digital_control_interface = kept_;
    device.digital_io_interface = other_io_;
    EXPECT_TRUE(registry_.runs_otherwise(device));
  }
  EXPECT_FALSE(registry_.runs_otherwise(device)) << "nothing uses them any more";
}

TEST_F(Buses, OfVirtualModeAreTheSameEachTime) {
  const auto bus = registry_.virtual_bus("can0");
  ASSERT_TRUE(bus);
  EXPECT_EQ(registry_.virtual_bus("can0"), bus);
  EXPECT_NE(registry_.virtual_bus("can1"), bus);
  EXPECT_EQ(bus->interface->axis_count(), 256U);
  EXPECT_TRUE(bus->interface->start());
  EXPECT_TRUE(bus->interface->exchange({}, {}));
  EXPECT_THAT(happened(), IsEmpty()) << "nothing is behind it";
}

TEST_F(Buses, OfInputsAndOutputsLiveAsTheOthersDo) {
  auto used = acquire_io(io_);
  ASSERT_TRUE(used);
  EXPECT_EQ(*acquire_io(io_), *used);
  EXPECT_THAT(happened(), ElementsAre("make Io", "start Io"));
  const auto refused = acquire_io(other_io_);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("Io is in use by the mechanism in force"));
  registry_.stop_unused();
  EXPECT_THAT(happened(), IsEmpty()) << "it is in use";
  used->reset();
  registry_.stop_unused();
  registry_.stop_unused();
  EXPECT_THAT(happened(), ElementsAre("stop Io")) << "once";
  ASSERT_TRUE(acquire_io(io_));
  ASSERT_TRUE(acquire_io(other_io_));
  EXPECT_THAT(happened(), ElementsAre("start Io", "stop Io", "make Io", "start Io"));
}

}  // namespace
}  // namespace rmac::gateway
