#include "unit/gateway/api/setters/setter_bench.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "places.hpp"

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;
constexpr double kPeriodS = 0.001;

/// The spindle of DMACXYZ as a motor without a speed loop of its own.
fieldbus::AxisPlantParameters torque_spindle() {
  fieldbus::AxisPlantParameters motor;
  motor.rated_torque_nm = motor.brake_nm = 5;
  motor.peak_torque_nm = 10;
  motor.rotor_inertia_kg_m2 = 0.01;
  motor.screw_inertia_kg_m2 = motor.table_mass_kg = 0;
  motor.coulomb_nm = motor.static_nm = 0.1;
  return motor;
}

/// The largest of what `of` makes of two neighbouring samples.
template <typename Function>
double largest_step(const Trace& trace, Function&& of) {
  double largest = 0;
  for (std::size_t i = 1; i < trace.size(); ++i) largest = std::max(largest, of(trace[i - 1], trace[i]));
  return largest;
}

}  // namespace

SetterBench::SetterBench() : folder_(fs::temp_directory_path() / ("rmac-setters-" + std::to_string(::getpid()))) {
  fs::create_directories(folder_);
  const fs::path built(RMAC_BINARY_DIR);
  auto manager = DeviceDriverManager::open({built / "drivers", (folder_ / "drivers.sqlite").string()});
  EXPECT_TRUE(manager) << manager.error().message;
  manager_ = std::move(*manager);

  ControllerOptions options;
  options.module_folders = {(built / "drivers" / "modules").string(), (built / "test_modules" / "good").string()};
  options.as_fast_as_computed = true;
  // The draft's check makes interfaces that nobody borrows: a test wants the one that is used, which is made last.
  const auto make_bus = [](std::shared_ptr<fieldbus::SimulatedInterface>& made, bool torque) {
    return [&made, torque](const std::string&, const sdk::ModuleChoice&,
                           const ModuleLoader&) -> Expected<std::shared_ptr<DigitalControlInterface>> {
      if (!made || made.use_count() == 1) {
        auto axes = fieldbus::default_simulated_axes();
        if (torque) axes[3] = torque_spindle();
        made = std::make_shared<fieldbus::SimulatedInterface>(axes, kPeriodS);
        made->set_contact({.surface_mm = SetterBench::kSurfaceMm});
      }
      return made;
    };
  };
  const auto make_io = [](std::shared_ptr<fieldbus::SimulatedIoInterface>& made) {
    return [&made](const sdk::ModuleChoice&, const ModuleLoader&) -> Expected<std::shared_ptr<DigitalIoInterface>> {
      if (!made) made = std::make_shared<fieldbus::SimulatedIoInterface>();
      return made;
    };
  };
  options.control_interfaces = {{"SimulatedInterface", make_bus(bus, false)},
                                {"TorqueInterface", make_bus(torque_bus, true)}};
  options.io_interfaces = {{"SimulatedIOInterface", make_io(io)}, {"OtherIo", make_io(other_io)}};
  controller_ = std::make_unique<Controller>(options);
  host_ = std::make_unique<DeviceHost>(*manager_, *controller_);
  machine_ = std::make_unique<Machine>(*controller_, *host_, *manager_);
  dispatcher_ = std::make_unique<Dispatcher>(*machine_);
  listen();
  const auto started = controller_->start();
  EXPECT_TRUE(started) << started.error().message;

  call("Device.Load", R"({"Name": "DMACXYZ"})");
  call("RMAC_CAM.Home");
  run_until([this] {
    const CycleSample sample = now();
    return !sample.moving && sample.state == CycleState::Idle && std::abs(sample.position_set[2]) < 1e-9;
  });
  call("RMAC_CAM.SetFeedrate", R"({"Feedrate": 1800})");
  call("RMAC_CAM.CycleStart", R"({"Mode": "AUTOMATIC"})");
}

SetterBench::~SetterBench() {
  host_.reset();
  controller_.reset();
  manager_.reset();
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void SetterBench::listen() {
  controller_->on_sample([this](const CycleSample& sample) { samples_.push_back(sample); });
  controller_->on_event([this](const Event& event) { events_.push_back(event); });
}

void SetterBench::apply_interface() {
  apply();
  call("RMAC_CAM.CycleStart", R"({"Mode": "AUTOMATIC"})");
}

nlohmann::json SetterBench::ask(const std::string& method, const std::string& params) {
  const Request request =
      read_request({{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", nlohmann::json::parse(params)}});
  return to_response(request.id, dispatcher_->execute(request, session));
}

nlohmann::json SetterBench::call(const std::string& method, const std::string& params) {
  const nlohmann::json answer = ask(method, params);
  EXPECT_TRUE(answer.contains("result")) << method << " " << params << ": " << answer.dump();
  return answer.value("result", nlohmann::json());
}

std::string SetterBench::refusal(const std::string& method, const std::string& params) {
  const nlohmann::json answer = ask(method, params);
  EXPECT_TRUE(answer.contains("error")) << method << " " << params << " was accepted: " << answer.dump();
  return answer.contains("error") ? answer["error"]["message"].get<std::string>() : std::string();
}

void SetterBench::run_until(const std::function<bool()>& reached) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!reached()) {
    if (std::chrono::steady_clock::now() > give_up) {
      ADD_FAILURE() << "what was waited for did not come" << (events_.empty() ? "" : ": " + events_.back().message);
      return;
    }
    controller_->dispatch();
    std::this_thread::yield();
  }
}

Trace SetterBench::run() {
  events_.clear();
  run_until([this] { return call("RMAC_CAM.NumMovesInBuffer") == 0 && !now().moving; });
  controller_->dispatch();
  Trace trace;
  for (const CycleSample& sample : samples_) {
    if (sample.moving) trace.push_back(sample);
  }
  samples_.clear();
  if (trace.empty()) trace.push_back(now());  // nothing moved
  return trace;
}

Trace SetterBench::tip_to(double x, double y, double z) {
  controller_->dispatch();
  samples_.clear();
  call("RMAC_CAM.MoveToPathTarget",
       fmt::format(R"({{"MoveID": 1, "TargetFrame": {{"p": [{}, {}, {}], "axis": [0, 0, 1]}}}})", x, y, z));
  return run();
}

Trace SetterBench::joints_to(const std::vector<double>& joints) {
  controller_->dispatch();
  samples_.clear();
  call("RMAC_CAM.MoveToJointTarget", nlohmann::json{{"MoveID", 1}, {"JointTargetFrame", {{"joints", joints}}}}.dump());
  return run();
}

std::string SetterBench::tip_refusal(double x, double y, double z) {
  return refusal("RMAC_CAM.MoveToPathTarget",
                 fmt::format(R"({{"MoveID": 1, "TargetFrame": {{"p": [{}, {}, {}], "axis": [0, 0, 1]}}}})", x, y, z));
}

double peak(const Trace& trace, PerJoint quantity, std::size_t joint) {
  double largest = 0;
  for (const CycleSample& sample : trace) largest = std::max(largest, std::abs((sample.*quantity)[joint]));
  return largest;
}

double peak_jerk(const Trace& trace, std::size_t joint) {
  return largest_step(trace, [joint](const CycleSample& before, const CycleSample& after) {
    return std::abs(after.acceleration_set[joint] - before.acceleration_set[joint]) / kPeriodS;
  });
}

double peak_following_error(const Trace& trace, std::size_t joint) {
  double largest = 0;
  for (const CycleSample& sample : trace) {
    largest = std::max(largest, std::abs(sample.position_set[joint] - sample.position[joint]));
  }
  return largest;
}

double peak_feed(const Trace& trace) {
  double largest = 0;
  for (const CycleSample& sample : trace) largest = std::max(largest, sample.feed_set_mm_s);
  return largest;
}

double peak_feed_rise(const Trace& trace) {
  return largest_step(trace, [](const CycleSample& before, const CycleSample& after) {
    return (after.feed_set_mm_s - before.feed_set_mm_s) / kPeriodS;
  });
}

double peak_feed_fall(const Trace& trace) {
  return largest_step(trace, [](const CycleSample& before, const CycleSample& after) {
    return (before.feed_set_mm_s - after.feed_set_mm_s) / kPeriodS;
  });
}

}  // namespace rmac::gateway
