// Requests to a machine with drives, of which one fails in a move. The first byte says which fails and how; the drive
// is repaired half-way through the requests where that byte is odd, and at their end in any case.
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <thread>

#include "gateway/appliance/machine.hpp"
#include "gateway/device_driver/device_host.hpp"
#include "gateway/processes/temporary_folder.hpp"
#include "gateway/simulation/only_client.hpp"
#include "memory_file.hpp"
#include "places.hpp"
#include "requests.hpp"
#include "rmac/fieldbus/simulated_interface.hpp"

namespace {

using namespace rmac::gateway;
namespace fieldbus = rmac::fieldbus;
namespace fs = std::filesystem;

/// A cycle in which nothing moves takes its time, a ms.
constexpr int kMostCycles = 8, kBeforeTheFault = 50, kInputsOfAMachine = 200, kLongestStop = 4000;
constexpr double kPeriod_s = 0.001;
constexpr std::chrono::microseconds kLook{50};

/// DMACXYZ in virtual time on a bus whose drives can be broken.
class Mill {
 public:
  Mill()
      : manager_(managed()),
        controller_(options()),
        host_(*manager_, controller_),
        machine_(controller_, host_, *manager_),
        dispatcher_(machine_),
        client_(*manager_, nlohmann::json::object()) {
    controller_.on_sample([this](const CycleSample& sample) { now_ = sample; });
    if (!controller_.start()) std::abort();
  }

  void call(const std::string& method, const nlohmann::json& params = nullptr) {
    nlohmann::json message{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}};
    if (!params.is_null()) message["params"] = params;
    if (auto answer = dispatcher_.execute(read_request(std::move(message)), client_); !answer) {
      refused_ += "\n  " + method + ": " + answer.error().message;
    }
  }
  /// Machine time goes on by itself; this is over once so many cycles passed.
  void pass(int cycles) {
    const auto end = now_.cycle + cycles;
    for (controller_.dispatch(); now_.cycle < end; controller_.dispatch()) std::this_thread::sleep_for(kLook);
  }
  /// In a move, wherever the input before left it; false where it does not come to that.
  [[nodiscard]] bool begin() {
    refused_.clear();
    call("RMAC_CAM.StopNow");
    for (int i = 0; i < kLongestStop && now_.moving; i += kMostCycles) pass(kMostCycles);
    call("RMAC_CAM.Reset");
    if (moves()) return true;
    // To bring the drives up anew takes a hundred times as long.
    call("Device.Unload");
    call("Device.Load", {{"Name", "DMACXYZ"}});
    return moves();
  }
  /// As `begin`, of one that was just made: it moves, or something is wrong. On a busy computer a move may begin after
  /// the look, or be over before it.
  void begin_surely() {
    constexpr int kTries = 20;
    for (int i = 0; i < kTries; ++i) {
      if (begin()) return;
      for (int k = 0; k < kLongestStop && !now_.moving; k += kMostCycles) pass(kMostCycles);
      if (bus_ != nullptr && now_.moving) return;
    }
    std::cerr << "a machine that was just made does not move; refused were:" << refused_ << '\n';
    std::abort();
  }
  void break_drive(unsigned choice) {
    constexpr unsigned kWays = 6;
    const std::size_t axis = choice / kWays % 4;
    switch (choice % kWays) {
      case 0:
        return bus_->trip(axis, 0x8611);
      case 1:
        return bus_->set_online(axis, false);
      case 2:
        return bus_->set_bus_failed(true);
      case 3:
        return bus_->shift_encoder(axis, 5000);
      case 4:
        return bus_->freeze_encoder(axis, true);
      default:
        return bus_->is_spindle(axis) ? bus_->trip(axis, 0x2310) : bus_->run_away(axis, 0.3);
    }
  }
  void repair() {
    if (bus_ == nullptr) return;
    bus_->set_bus_failed(false);
    for (std::size_t axis = 0; axis < bus_->axis_count(); ++axis) {
      bus_->set_online(axis, true);
      bus_->freeze_encoder(axis, false);
      bus_->run_away(axis, 0);
    }
  }

 private:
  [[nodiscard]] bool moves() {
    const double x = now_.position_set[0] > 10 ? 0 : 20;
    call("RMAC_CAM.MoveToJointTarget", {{"MoveID", 1}, {"JointTargetFrame", {{"joints", {x, 0, 0}}}}});
    call("RMAC_CAM.CycleStart", {{"Mode", "AUTOMATIC"}});
    pass(kBeforeTheFault);
    return bus_ != nullptr && now_.moving;
  }
  std::unique_ptr<DeviceDriverManager> managed() {
    auto made = DeviceDriverManager::open(
        {.device_tree = RMAC_BINARY_DIR "/drivers", .database = (folder_.path() / "drivers.sqlite").string()});
    if (!made) {
      std::cerr << made.error().message << '\n';
      std::abort();
    }
    return std::move(*made);
  }
  ControllerOptions options() {
    ControllerOptions made;
    made.module_folders = {RMAC_BINARY_DIR "/drivers/modules"};
    made.as_fast_as_computed = true;
    made.control_interfaces["SimulatedInterface"] =
        [this](const std::string&, const rmac::sdk::ModuleChoice&,
               const ModuleLoader&) -> rmac::Expected<std::shared_ptr<rmac::DigitalControlInterface>> {
      bus_ = std::make_shared<fieldbus::SimulatedInterface>(fieldbus::default_simulated_axes(), kPeriod_s);
      return bus_;
    };
    return made;
  }

  TemporaryFolder folder_{"fuzz"};
  std::string refused_;                                ///< requests since it was to begin, a line each
  CycleSample now_{};                                  ///< the last cycle that was told of
  std::shared_ptr<fieldbus::SimulatedInterface> bus_;  ///< the one that was made last
  std::unique_ptr<DeviceDriverManager> manager_;
  Controller controller_;
  DeviceHost host_;
  Machine machine_;
  Dispatcher dispatcher_;
  OnlyClient client_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static std::unique_ptr<Mill> mill;
  static int inputs = 0;
  if (size == 0) return 0;
  if (inputs++ % kInputsOfAMachine == 0) mill.reset();
  if (!mill) mill = std::make_unique<Mill>();
  if (!mill->begin()) {
    // What came before may have left it where this move does not go: another machine has to move.
    mill = std::make_unique<Mill>();
    mill->begin_surely();
  }
  mill->break_drive(data[0] / 2U);
  const std::size_t half = data[0] % 2 == 0 ? size : 1 + (size - 1) / 2;
  const auto feed = [](const std::uint8_t* from, std::size_t bytes) {
    rmac::fuzz::Requests(rmac::fuzz::text_of(from, bytes), kMostCycles)
        .for_each([](const std::string& method, const nlohmann::json& params) { mill->call(method, params); },
                  [](int cycles) { mill->pass(cycles); });
  };
  feed(data + 1, half - 1);
  mill->repair();
  feed(data + half, size - half);
  return 0;
}
