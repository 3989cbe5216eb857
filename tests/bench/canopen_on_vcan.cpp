#include <gmock/gmock.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "conformance/control_interface_conformance.hpp"
#include "rmac/fieldbus/can/socket_can_port.hpp"
#include "rmac/fieldbus/canopen/canopen_interface.hpp"
#include "rmac/motion/drive_power.hpp"
#include "unit/fieldbus/virtual_drive.hpp"

// The CANopen master on a real CAN interface of the kernel, against virtual drives on another socket. Interfaces go
// down and up, so it wants a virtual one, and the right to do that. Cycles keep real time.
namespace {

using namespace rmac;
using namespace rmac::fieldbus;
using rmac::fieldbus::test::PowerStates;
using rmac::fieldbus::test::VirtualDrive;
using std::chrono::milliseconds;

std::string interface_name() {
  const char* name = std::getenv("RMAC_CAN_INTERFACE");
  return name != nullptr ? name : "vcan0";
}

void set_link(const char* state) {
  const std::string command = "ip link set " + interface_name() + " " + state;
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

std::unique_ptr<SocketCanPort> open_port(std::span<const std::uint16_t> wanted = {}) {
  auto port = SocketCanPort::open(interface_name(), wanted, 1);
  EXPECT_TRUE(port.has_value()) << port.error().message;
  return port ? std::move(*port) : nullptr;
}

/// Drives on a thread and a socket of their own.
class Drives {
 public:
  explicit Drives(const std::vector<std::uint8_t>& nodes) : port_(open_port()) {
    for (const std::uint8_t node : nodes) drives_.push_back(std::make_unique<VirtualDrive>(node));
    for (auto& drive : drives_) drive->power_on(port_->now());
    thread_ = std::thread([this] { run(); });
  }
  ~Drives() {
    ends_ = true;
    thread_.join();
  }
  template <typename Look>
  auto look(std::size_t drive, Look&& at) {
    const std::lock_guard lock(mutex_);
    return at(*drives_.at(drive));
  }
  [[nodiscard]] PowerStates::State state(std::size_t drive) {
    return look(drive, [](VirtualDrive& d) { return d.state(); });
  }

 private:
  void run() {
    while (!ends_) {
      port_->wait(milliseconds(1));
      const std::lock_guard lock(mutex_);
      CanFrame frame;
      while (port_->receive(frame)) {
        for (auto& drive : drives_) drive->receive(frame, port_->now());
        send();
      }
      for (auto& drive : drives_) drive->poll(port_->now());
      send();
    }
  }
  void send() {
    for (auto& drive : drives_) {
      for (const CanFrame& frame : drive->take_output()) port_->send(frame);
    }
  }

  std::unique_ptr<SocketCanPort> port_;
  std::vector<std::unique_ptr<VirtualDrive>> drives_;
  std::mutex mutex_;
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

/// A master whose cycles keep real time.
class Master final : public DigitalControlInterface {
 public:
  explicit Master(std::map<std::string, std::vector<double>> numbers) {
    auto config = canopen::read_canopen_config(interface_name(), numbers, {}, 0.001);
    EXPECT_TRUE(config.has_value()) << config.error().message;
    bus_ = canopen::make_socketcan_interface(std::move(*config));
    commands.resize(bus_->axis_count());
    feedback.resize(bus_->axis_count());
  }
  std::size_t axis_count() const noexcept override { return bus_->axis_count(); }
  Expected<> start() override {
    return bus_->start().map([this] {
      clock_gettime(CLOCK_MONOTONIC, &due_);
      EXPECT_TRUE(exchange(commands, feedback));
    });
  }
  void stop() noexcept override { bus_->stop(); }
  bool exchange(std::span<const DriveCommand> out, std::span<DriveFeedback> in) noexcept override {
    const bool sound = bus_->exchange(out, in);
    constexpr long kPeriodNs = 1'000'000;
    constexpr long kSecondNs = 1'000'000'000;
    due_.tv_nsec += kPeriodNs;
    if (due_.tv_nsec >= kSecondNs) {
      due_.tv_nsec -= kSecondNs;
      ++due_.tv_sec;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due_, nullptr);
    return sound;
  }
  bool cycle(DriveWish wish) {
    for (std::size_t i = 0; i < commands.size(); ++i) {
      commands[i].controlword = next_controlword(feedback[i].statusword, wish, false, commands[i].controlword);
    }
    return exchange(commands, feedback);
  }
  void enable_all() {
    for (int i = 0; i < 50; ++i) cycle(DriveWish::Operational);
    for (const DriveFeedback& words : feedback) {
      ASSERT_EQ(drive_state(words.statusword), DriveState::OperationEnabled);
    }
  }
  [[nodiscard]] bool all_online() const {
    return std::all_of(feedback.begin(), feedback.end(), [](const DriveFeedback& words) { return words.online; });
  }
  [[nodiscard]] const canopen::CanopenCounters& counters() const { return bus_->counters(); }

  std::vector<DriveCommand> commands;
  std::vector<DriveFeedback> feedback;

 private:
  std::shared_ptr<canopen::CanopenInterface> bus_;
  timespec due_{};
};

/// Processor time that this thread took so far.
double used_s() {
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  constexpr double kNanoseconds = 1e-9;
  return static_cast<double>(used.tv_sec) + static_cast<double>(used.tv_nsec) * kNanoseconds;
}

void inject_error(std::uint32_t error_class) {
  const int socket = ::socket(PF_CAN, SOCK_RAW, CAN_RAW);
  ifreq request{};
  interface_name().copy(request.ifr_name, sizeof(request.ifr_name) - 1);
  ASSERT_EQ(ioctl(socket, SIOCGIFINDEX, &request), 0);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = request.ifr_ifindex;
  ASSERT_EQ(bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  can_frame frame{};
  frame.can_id = CAN_ERR_FLAG | error_class;
  frame.can_dlc = CAN_ERR_DLC;
  ASSERT_EQ(write(socket, &frame, sizeof(frame)), static_cast<ssize_t>(sizeof(frame)));
  close(socket);
}

TEST(SocketCan, CarriesWhatItsFiltersAskForWithTheKernelsTime) {
  const auto from = open_port();
  constexpr std::uint16_t kWanted[] = {0x181, 0x701};
  const auto to = open_port(kWanted);
  for (std::uint16_t id = 0; id < 0x800; ++id) ASSERT_TRUE(from->send({.id = id, .size = 2, .data = {7, 9}}));
  CanFrame frame;
  for (const std::uint16_t id : kWanted) {
    ASSERT_TRUE(to->receive(frame));
    EXPECT_EQ(frame, (CanFrame{.id = id, .size = 2, .data = {7, 9}}));
    EXPECT_GT(frame.stamp.count(), 0);
  }
  EXPECT_FALSE(to->receive(frame));
  EXPECT_EQ(to->health().received, 2U);
}

TEST(SocketCan, CountsWhatWasLostBecauseNobodyFetchedIt) {
  const auto from = open_port();
  const auto to = open_port();
  constexpr std::uint64_t kFrames = 20000;
  for (std::uint64_t i = 0; i < kFrames; ++i) from->send({.id = 0x100, .size = 8});
  CanFrame frame;
  while (to->receive(frame)) {
  }
  from->send({.id = 0x100, .size = 8});  // the kernel tells the number with the next frame that it keeps
  ASSERT_TRUE(to->receive(frame));
  EXPECT_EQ(to->health().received + to->health().overflowed, kFrames + 1);
  EXPECT_GT(to->health().overflowed, 0U);
}

TEST(SocketCan, SaysWhatIsWrongWithAnInterface) {
  const auto absent = SocketCanPort::open("no-such-can", {}, 1);
  ASSERT_FALSE(absent.has_value());
  EXPECT_EQ(absent.error().message,
            "CAN interface no-such-can: there is none of this name; bring it up with systemctl enable --now "
            "rmac-can@no-such-can");
  set_link("down");
  const auto down = SocketCanPort::open(interface_name(), {}, 1);
  set_link("up");
  ASSERT_FALSE(down.has_value());
  EXPECT_THAT(down.error().message, testing::HasSubstr("it is down; bring it up with"));
  const auto narrow = SocketCanPort::open(interface_name(), {}, 1'000'000);
  ASSERT_FALSE(narrow.has_value());
  EXPECT_THAT(narrow.error().message, testing::HasSubstr("one cycle can need 1000000; set TXQUEUELEN in"));
}

TEST(CanopenOnVcan, ConformsToThePort) {
  Drives drives({1, 2});
  Master master({{"node", {1, 2}}});
  conformance::ControlInterfaceConformance(master, 1).check();
}

TEST(CanopenOnVcan, MissesNoAnswerOfThreeDrivesAtOneKilohertz) {
  Drives drives({1, 2, 3});
  Master master({{"node", {1, 2, 3}}, {"mode", {8}}, {"load_share", {100}}});
  ASSERT_TRUE(master.start().has_value());
  master.enable_all();
  const auto missed_before = master.counters().missed_answers;
  constexpr int kCycles = 5000;
  int failed = 0;
  for (int i = 0; i < kCycles; ++i) {
    for (auto& command : master.commands) command.target_position_counts = i;
    failed += master.cycle(DriveWish::Operational) ? 0 : 1;
  }
  std::printf("cycles %d, failed %d, missed answers %lu\n", kCycles, failed,
              static_cast<unsigned long>(master.counters().missed_answers - missed_before));
  EXPECT_EQ(failed, 0);
  EXPECT_EQ(master.counters().missed_answers, missed_before);
  EXPECT_NEAR(master.feedback[2].position_counts, kCycles, 5);
  master.stop();
}

TEST(CanopenOnVcan, StopsEveryDriveWhenItsCycleEnds) {
  Drives drives({1, 2});
  Master master({{"node", {1, 2}}});
  ASSERT_TRUE(master.start().has_value());
  master.enable_all();
  const auto port = open_port();
  const auto until = port->now() + milliseconds(150);  // two heartbeats, and half of one for the emulation
  CanFrame frame;
  for (; port->now() < until; port->wait(until - port->now())) {
    while (port->receive(frame)) {
    }
  }
  for (const std::size_t drive : {0U, 1U}) EXPECT_EQ(drives.state(drive), PowerStates::QuickStop);
}

TEST(CanopenOnVcan, ComesBackAfterItsInterfaceWentDown) {
  Drives drives({1, 2});
  Master master({{"node", {1, 2}}});
  ASSERT_TRUE(master.start().has_value());
  master.enable_all();
  constexpr int kCycles = 300;
  const double begun_s = used_s();
  for (int i = 0; i < kCycles; ++i) master.cycle(DriveWish::Operational);
  const double normal_s = used_s() - begun_s;
  set_link("down");
  int failed = 0;
  const double went_down_s = used_s();
  for (int i = 0; i < kCycles; ++i) failed += master.cycle(DriveWish::Operational) ? 0 : 1;
  const double down_s = used_s() - went_down_s;
  std::printf("processor time of a cycle: %.1f us, while the interface is down %.1f us\n", normal_s / kCycles * 1e6,
              down_s / kCycles * 1e6);
  EXPECT_LE(down_s, 1.2 * normal_s);
  EXPECT_GE(failed, kCycles - 1);
  EXPECT_FALSE(master.all_online());
  EXPECT_EQ(drives.state(0), PowerStates::QuickStop);
  set_link("up");
  int cycles = 0;
  while (!master.all_online() && cycles < 2000) {
    master.cycle(DriveWish::Off);
    ++cycles;
  }
  std::printf("operational again after %d ms\n", cycles);
  EXPECT_LT(cycles, 2000);
  EXPECT_NE(drives.state(0), PowerStates::OperationEnabled);
  master.stop();
}

TEST(CanopenOnVcan, FailsItsCyclesWhileTheControllerIsBusOff) {
  Drives drives({1});
  Master master({{"node", {1}}});
  ASSERT_TRUE(master.start().has_value());
  master.enable_all();
  // A controller that is off the bus hears nobody.
  drives.look(0, [](VirtualDrive& drive) { drive.answers_sync = drive.sends_heartbeats = false; });
  for (int i = 0; i < 5; ++i) master.cycle(DriveWish::Operational);
  inject_error(CAN_ERR_BUSOFF);
  EXPECT_FALSE(master.cycle(DriveWish::Operational));
  EXPECT_FALSE(master.cycle(DriveWish::Operational));
  inject_error(CAN_ERR_RESTARTED);
  drives.look(0, [](VirtualDrive& drive) { drive.answers_sync = drive.sends_heartbeats = true; });
  EXPECT_TRUE(master.cycle(DriveWish::Off));
  for (int i = 0; i < 2000 && !master.all_online(); ++i) master.cycle(DriveWish::Off);
  EXPECT_TRUE(master.all_online());
  master.stop();
}

}  // namespace
