#include "gateway/controller/controller.hpp"

#include <fmt/format.h>

#include <chrono>
#include <thread>
#include <utility>

#include "gateway/buses/built_in_interfaces.hpp"
#include "gateway/buses/report/bus_report_json.hpp"
#include "gateway/buses/report/bus_watch.hpp"
#include "gateway/cycle/motion_supervisor.hpp"
#include "gateway/events/announcer.hpp"
#include "gateway/mechanism/assembler.hpp"
#include "gateway/reconfiguration/reconfiguration.hpp"
#include "gateway/record/flight_reporter.hpp"
#include "gateway/rmac_cam/cam.hpp"
#include "gateway/rmac_cam/measuring/measuring_machine.hpp"
#include "gateway/rmac_config/config_draft.hpp"
#include "gateway/servo/servo_thread.hpp"

namespace rmac::gateway {

namespace {

constexpr std::chrono::microseconds kLookAgain{100};

ServoThread::Options thread_options(const ControllerOptions& options) {
  return {.period_s = options.period_s,
          .virtual_time = options.as_fast_as_computed,
          .stepped = options.stepped,
          .real_time = options.real_time,
          .degraded_ok = options.degraded_ok,
          .wish = {options.priority, options.cpu, options.lock_memory},
          .clock = options.clock};
}

AssemblyOptions assembly_options(const ControllerOptions& options) {
  return {.virtual_mode = false,
          .period_s = options.period_s,
          .stop_categories = options.stop_categories,
          .max_cycles_lost = options.max_cycles_lost};
}

/// Tells the client's interfaces, and who watches the buses, which mechanism is in force.
class ClientInterfaces final : public MechanismUsers {
 public:
  ClientInterfaces(ConfigDraft& draft, Cam& cam, MeasuringMachine& measuring, BusWatch& buses)
      : draft_(draft), cam_(cam), measuring_(measuring), buses_(buses) {}
  void mechanism_changed(const sdk::DeviceObject* device, bool fresh) override {
    cam_.mechanism_changed(device, fresh);
    measuring_.mechanism_changed(device, fresh);
    // Configured anew, and at a Reset, the same buses go on, and what they went through is still to be told.
    if (fresh) buses_.forget();
  }
  void draft_from(const sdk::DeviceObject* device) override { draft_.discard(device); }
  void keep_mounted() override { (void)cam_.tools().keep_mounted(); }

 private:
  ConfigDraft& draft_;
  Cam& cam_;
  MeasuringMachine& measuring_;
  BusWatch& buses_;
};

}  // namespace

/// In the order in which they need each other.
struct Controller::Impl {
  explicit Impl(ControllerOptions controller_options);

  [[nodiscard]] Expected<> apply(const sdk::DeviceObject& device, ConfigDraft::Extent extent);
  /// While the servo thread is waited for.
  void let_time_pass();
  void look_at_buses();
  void add_to(Event& event);
  [[nodiscard]] ModuleLoader loader() const { return assembler.loader(source.folder); }

  ControllerOptions options;
  std::unique_ptr<ServoLink> link;
  MotionSupervisor supervisor;
  ServoThread thread;
  FlightReporter flights;
  Announcer announcer;
  BusRegistry registry;
  BusWatch bus_watch;
  Assembler assembler;
  ConfigDraft draft;
  ToolRack rack;
  Cam cam;
  MeasuringMachine measuring;
  ClientInterfaces interfaces;
  Reconfiguration reconfiguration;
  MechanismSource source;  ///< where the mechanism about to be configured comes from
  std::function<Expected<>(const sdk::DeviceObject&)> admit;
  bool running = false;
};

Controller::Impl::Impl(ControllerOptions controller_options)
    : options(std::move(controller_options)),
      link(std::make_unique<ServoLink>(FlightRecorder::history_cycles(options.flight_recorder, options.period_s))),
      supervisor({.queue_capacity = options.queue_capacity,
                  .jog_while_waiting = options.jog_while_waiting,
                  .guard_in_thread = !options.stepped},
                 *link),
      thread(thread_options(options), *link, supervisor),
      flights(options.flight_recorder, options.period_s, link->history, [this] { return to_json(registry.reports()); }),
      announcer(*link, [this](std::uint64_t generation) { return reconfiguration.of_generation(generation); }),
      assembler(assembly_options(options), options.module_folders, registry),
      draft({[this](const sdk::DeviceObject& device, ConfigDraft::Extent extent) { return apply(device, extent); },
             [this](const sdk::ModuleChoice& choice) { return registry.check_control_interface(choice, loader()); },
             [this](const sdk::ModuleChoice& choice) { return registry.check_io_interface(choice, loader()); }}),
      rack(options.tools_folder),
      cam(supervisor, *link, rack, [this] { return reconfiguration.reset(); }),
      measuring(supervisor, *link, cam, options.stepped),
      interfaces(draft, cam, measuring, bus_watch),
      reconfiguration(
          {*link, supervisor, assembler, registry, rack, interfaces}, [this] { let_time_pass(); }, options.stepped) {
  add_built_in_interfaces(registry, options.period_s, options.drives_folder);
  for (const auto& [name, factory] : options.control_interfaces) registry.add_control_interface(name, factory);
  for (const auto& [name, factory] : options.io_interfaces) registry.add_io_interface(name, factory);
  announcer.before_event([this](Event& event) { add_to(event); });
  announcer.after_sample(
      [this](const CycleSample& sample, const Announcer::Tell& tell) { measuring.read(sample, tell); });
}

Expected<> Controller::Impl::apply(const sdk::DeviceObject& device, ConfigDraft::Extent extent) {
  if (!running) {
    return failure(MinorCode::Other, "putting in a configuration: the controller is not running; start it");
  }
  if (admit) {
    if (auto admitted = admit(device); !admitted) return admitted;
  }
  if (extent == ConfigDraft::Extent::Loops) return reconfiguration.change_loops(device, source);
  return reconfiguration.put_in(device, source, extent == ConfigDraft::Extent::Mechanism);
}

void Controller::Impl::let_time_pass() {
  announcer.take_over_samples();
  if (options.stepped) {
    thread.step();
  } else {
    std::this_thread::sleep_for(kLookAgain);
  }
}

void Controller::Impl::look_at_buses() {
  const CycleSample now = link->history.latest();
  if (!bus_watch.due(now.t_s)) return;
  for (std::string& message : bus_watch.look(registry.reports(), now.t_s)) {
    Event event;
    event.kind = Event::Kind::Bus;
    event.t_s = now.t_s;
    event.cycle = now.cycle;
    event.message = std::move(message);
    announcer.tell(std::move(event));
  }
}

void Controller::Impl::add_to(Event& event) {
  flights.annotate(event, reconfiguration.device());
  if (event.kind != Event::Kind::ToolChanged && event.kind != Event::Kind::ToolChangeDropped) return;
  if (auto kept = cam.tools().keep_mounted(); !kept) event.message += "; that is not kept: " + kept.error().message;
}

Controller::Controller(ControllerOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}

Controller::~Controller() {
  stop();
}

Expected<> Controller::start() {
  if (impl_->running) return {};
  if (!(impl_->options.period_s > 0)) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("the servo period {} s must be above 0", impl_->options.period_s));
  }
  return impl_->thread.start().map([&] { impl_->running = true; });
}

void Controller::stop() noexcept {
  if (!impl_->running) return;
  // Ending cannot fail: whatever does not work, the threads end and the buses stop.
  try {
    (void)impl_->cam.cycle().stop_now();
    impl_->reconfiguration.come_to_rest();
  } catch (...) {
  }
  impl_->thread.stop();
  impl_->running = false;
  impl_->reconfiguration.abandon();
}

const std::vector<std::string>& Controller::real_time_shortcomings() const noexcept {
  return impl_->thread.shortcomings();
}

sdk::RmacConfig& Controller::config() noexcept {
  return impl_->draft;
}
sdk::RmacCam& Controller::cam() noexcept {
  return impl_->cam;
}
sdk::Measuring& Controller::measuring() noexcept {
  return impl_->measuring;
}

OperatorPort& Controller::operating() noexcept {
  return impl_->cam.cycle();
}

ToolPort& Controller::tools() noexcept {
  return impl_->cam.tools();
}

void Controller::set_mechanism_folder(std::string folder, bool virtual_mode,
                                      std::function<Expected<>(const sdk::DeviceObject&)> admit) {
  impl_->admit = std::move(admit);
  impl_->source = {std::move(folder), virtual_mode || impl_->options.stepped};
}

const std::string& Controller::mechanism_folder() const noexcept {
  return impl_->source.folder;
}
bool Controller::virtual_mode() const noexcept {
  return impl_->source.virtual_mode;
}

Expected<ModuleObject<sdk::DeviceDriver>> Controller::load_device_driver(const sdk::ModuleChoice& choice) const {
  return impl_->loader().load<sdk::DeviceDriver>(choice);
}

void Controller::discard_draft() {
  impl_->draft.discard(mechanism());
}

Expected<> Controller::unload() {
  return impl_->reconfiguration.unload();
}

const sdk::DeviceObject* Controller::mechanism() const noexcept {
  return impl_->reconfiguration.device();
}

std::vector<ModuleInUse> Controller::modules() const {
  const Mechanism* const in_force = impl_->reconfiguration.mechanism();
  return in_force == nullptr ? std::vector<ModuleInUse>() : in_force->modules;
}

CycleSample Controller::sample() const noexcept {
  return impl_->link->history.latest();
}

LastResort Controller::last_resort() const noexcept {
  return {impl_->supervisor, impl_->link->stops};
}

bool LastResort::planner_hangs() const {
  return supervisor_.planner_hangs();
}

void LastResort::keep_at_rest() const noexcept {
  stops_.kept.store(true, std::memory_order_release);
}

void LastResort::cut_power() const noexcept {
  stops_.power_off.store(true, std::memory_order_release);
}

const CycleTimes& Controller::cycle_times() const noexcept {
  return impl_->link->times;
}

fieldbus::FieldbusReport bus_reports(const Controller& controller) {
  return controller.impl_->registry.reports();
}

GuardPort& collision_guard(Controller& controller) {
  return controller.impl_->cam.guard();
}

LearningPort& learning_of(Controller& controller) {
  return controller.impl_->reconfiguration.learning();
}

ShapePort& machine_shape(Controller& controller) {
  return controller.impl_->cam.shape();
}

const nlohmann::json& bus_summary(const Controller& controller) {
  return controller.impl_->bus_watch.summary();
}

CycleNow Controller::cycle_now() const {
  return impl_->supervisor.now();
}

const std::optional<Event>& Controller::last_stop() const noexcept {
  return impl_->announcer.last_stop();
}

Expected<std::string> Controller::record_flight() {
  const CycleSample now = sample();
  Event asked;
  asked.t_s = now.t_s;
  asked.cycle = now.cycle;
  asked.message = "asked for by a client";
  return impl_->flights.record(FlightCause::Demand, asked, mechanism());
}

const FlightFolder* Controller::flight_records() const noexcept {
  return impl_->flights.folder();
}

void Controller::on_event(std::function<void(const Event&)> listener) {
  impl_->announcer.on_event(std::move(listener));
}

void Controller::on_sample(std::function<void(const CycleSample&)> listener) {
  impl_->announcer.on_sample(std::move(listener));
}

void Controller::on_queued(QueueListener listener) {
  impl_->supervisor.on_queued(std::move(listener));
}

void Controller::cycle() {
  impl_->thread.step();
  dispatch();
}

void Controller::dispatch() {
  auto news = impl_->supervisor.take_news();
  if (!news) return;  // without the news of moves that were queued, samples would tell of others
  impl_->announcer.announce(std::move(*news));
  for (Event& event : impl_->flights.take_events()) impl_->announcer.tell(std::move(event));
  impl_->look_at_buses();
  impl_->measuring.advance();
}

}  // namespace rmac::gateway
