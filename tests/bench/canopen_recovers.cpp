#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "on_vcan.hpp"
#include "rmac/fieldbus/canopen/nmt.hpp"

// The bus goes away in each of the ways that it can, and comes back.
namespace rmac::bench {
namespace {

using canopen::NmtCommand;

constexpr int kCycles = 300;
constexpr int kRecoveryCycles = 2000;
constexpr double kMostOverNormal = 1.2;

/// Processor time that this thread took so far.
double used_s() {
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  constexpr double kNanoseconds = 1e-9;
  return static_cast<double>(used.tv_sec) + static_cast<double>(used.tv_nsec) * kNanoseconds;
}

/// What a controller's driver would report, seen by every socket on the interface.
void report_error(std::uint32_t error_class) {
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

/// A master at work with two drives.
class CanopenRecovers : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(master_.start().has_value());
    master_.enable_all();
    const double begun_s = used_s();
    for (int i = 0; i < kCycles; ++i) master_.cycle(DriveWish::Operational);
    normal_s_ = (used_s() - begun_s) / kCycles;
  }
  void TearDown() override { master_.stop(); }

  /// Cycles that want the drives at work, as the servo loop's first ones after a loss do. Returns how many failed.
  template <typename Each>
  int outage(const char* what, Each&& each) {
    int failed = 0;
    double used = 0;
    for (int i = 0; i < kCycles; ++i) {
      each(i);
      const double begun_s = used_s();
      failed += master_.cycle(DriveWish::Operational) ? 0 : 1;
      used += used_s() - begun_s;
    }
    report(what, used / kCycles);
    return failed;
  }
  void report(const char* what, double cycle_s) const {
    std::printf("processor time of a cycle: %.1f us, %s %.1f us\n", normal_s_ * 1e6, what, cycle_s * 1e6);
    EXPECT_LE(cycle_s, kMostOverNormal * normal_s_) << what;
  }
  /// The drives are back in time, and none is enabled by that.
  void expect_back(const char* what) {
    int cycles = 0;
    double used = -used_s();
    for (; !master_.all_online() && cycles < kRecoveryCycles; ++cycles) master_.cycle(DriveWish::Off);
    used += used_s();
    std::printf("operational again after %d ms, %s\n", cycles, what);
    ASSERT_LT(cycles, kRecoveryCycles) << what;
    if (cycles > 0) report("bringing it back", used / cycles);
    for (int i = 0; i < kCycles; ++i) master_.cycle(DriveWish::Off);
    for (const std::size_t drive : {0U, 1U}) EXPECT_NE(drives_.state(drive), PowerStates::OperationEnabled) << what;
    master_.enable_all();
  }

  Drives drives_{{1, 2}};
  Master master_{{{"node", {1, 2}}}};
  double normal_s_ = 0;
};

TEST_F(CanopenRecovers, FromAnInterfaceThatWentDown) {
  const int failed = outage("interface down", [](int i) {
    if (i == 0) set_link("down");
  });
  EXPECT_GE(failed, kCycles - 1);
  EXPECT_FALSE(master_.all_online());
  EXPECT_EQ(drives_.state(0), PowerStates::QuickStop);
  set_link("up");
  expect_back("interface up");
}

TEST_F(CanopenRecovers, FromBusOffAgainAndAgain) {
  constexpr int kRestartCycles = 100;  // as restart-ms of an interface whose cable is short-circuited
  drives_.set_off_bus(true);
  const int failed = outage("bus-off", [](int i) {
    if (i % kRestartCycles != 0) return;
    if (i > 0) report_error(CAN_ERR_RESTARTED);
    report_error(CAN_ERR_BUSOFF);
  });
  EXPECT_EQ(failed, kCycles);
  EXPECT_FALSE(master_.all_online());
  EXPECT_EQ(drives_.state(0), PowerStates::QuickStop);
  report_error(CAN_ERR_RESTARTED);
  drives_.set_off_bus(false);
  expect_back("bus-off left");
}

TEST_F(CanopenRecovers, FromANodeThatSomeoneReset) {
  const auto other = open_port();
  for (const NmtCommand command :
       {NmtCommand::ResetNode, NmtCommand::ResetCommunication, NmtCommand::EnterPreOperational, NmtCommand::Stop}) {
    ASSERT_TRUE(other->send(canopen::nmt_frame(command, 2)));
    for (int i = 0; i < kCycles && master_.all_online(); ++i) EXPECT_TRUE(master_.cycle(DriveWish::Operational));
    EXPECT_FALSE(master_.all_online());
    expect_back(("node command " + std::to_string(static_cast<int>(command))).c_str());
  }
}

TEST_F(CanopenRecovers, FromANodeThatWasSwitchedOff) {
  const int failed = outage("a node off", [this](int i) {
    if (i == 0) drives_.look(1, [](VirtualDrive& drive) { drive.power_off(); });
  });
  EXPECT_EQ(failed, 0) << "the bus is sound";
  EXPECT_TRUE(master_.feedback[0].online);
  EXPECT_FALSE(master_.feedback[1].online);
  drives_.look(1, [](VirtualDrive& drive) {
    drive.power_on(std::chrono::steady_clock::now().time_since_epoch());  // the clock of its port
  });
  expect_back("node on");
}

}  // namespace
}  // namespace rmac::bench
