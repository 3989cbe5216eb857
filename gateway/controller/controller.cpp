#include "gateway/controller/controller.hpp"

#include <fmt/format.h>

#include "gateway/buses/built_in_interfaces.hpp"
#include "gateway/controller/controller_impl.hpp"

namespace rmac::gateway {

namespace {

ServoThread::Options thread_options(const ControllerOptions& options) {
  return {.period_s = options.period_s,
          .virtual_time = options.as_fast_as_computed,
          .stepped = options.stepped,
          .real_time = options.real_time,
          .degraded_ok = options.degraded_ok,
          .wish = {options.priority, options.cpu, options.lock_memory},
          .clock = options.clock};
}

}  // namespace

Controller::Impl::Impl(ControllerOptions controller_options)
    : options(std::move(controller_options)),
      link(std::make_unique<ServoLink>(FlightRecorder::history_cycles(options.flight_recorder, options.period_s))),
      supervisor({.queue_capacity = options.queue_capacity}, *link),
      thread(thread_options(options), *link, supervisor),
      draft(
          {[this](const sdk::DeviceObject& device, ConfigDraft::Extent extent) { return apply(device, extent); },
           [this](const sdk::ModuleChoice& choice) { return registry.check_control_interface(choice, loader(folder)); },
           [this](const sdk::ModuleChoice& choice) { return registry.check_io_interface(choice, loader(folder)); }}),
      rack(options.tools_folder),
      cam(supervisor, *link, rack, [this] { return reset(); }),
      measuring(supervisor, *link, cam, options.stepped) {
  if (options.flight_recorder.wanted()) {
    recorder = std::make_unique<FlightRecorder>(options.flight_recorder, options.period_s, link->history);
  }
  add_built_in_interfaces(registry, options.period_s);
  for (const auto& [name, factory] : options.control_interfaces) registry.add_control_interface(name, factory);
  for (const auto& [name, factory] : options.io_interfaces) registry.add_io_interface(name, factory);
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
  impl_->come_to_rest();
  impl_->thread.stop();
  impl_->running = false;
  impl_->in_force.reset();
  (void)impl_->supervisor.install(nullptr, ++impl_->generation, false);
  impl_->registry.stop_unused();
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

ToolPort& Controller::tools() noexcept {
  return impl_->cam;
}

void Controller::set_mechanism_folder(std::string folder, bool virtual_mode) {
  impl_->folder = std::move(folder);
  impl_->virtual_mode = virtual_mode || impl_->options.stepped;
}

const std::string& Controller::mechanism_folder() const noexcept {
  return impl_->folder;
}
bool Controller::virtual_mode() const noexcept {
  return impl_->virtual_mode;
}

Expected<ModuleObject<sdk::DeviceDriver>> Controller::load_device_driver(const sdk::ModuleChoice& choice) const {
  return impl_->loader(impl_->folder).load<sdk::DeviceDriver>(choice);
}

void Controller::discard_draft() {
  impl_->draft.discard(mechanism());
}

Expected<> Controller::unload() {
  return impl_->take_out();
}
bool Controller::mechanism_loaded() const noexcept {
  return impl_->in_force != nullptr;
}

const sdk::DeviceObject* Controller::mechanism() const noexcept {
  return impl_->in_force ? &impl_->in_force->device : nullptr;
}

std::vector<ModuleInUse> Controller::modules() const {
  return impl_->in_force ? impl_->in_force->modules : std::vector<ModuleInUse>();
}

CycleSample Controller::sample() const noexcept {
  return impl_->link->history.latest();
}

const CycleTimes& Controller::cycle_times() const noexcept {
  return impl_->link->times;
}

CycleNow Controller::cycle_now() const {
  return impl_->supervisor.now();
}

const std::optional<Event>& Controller::last_stop() const noexcept {
  return impl_->last_stop;
}

Expected<std::string> Controller::record_flight() {
  const CycleSample now = sample();
  Event asked;
  asked.t_s = now.t_s;
  asked.cycle = now.cycle;
  asked.message = "asked for by a client";
  return impl_->record(FlightCause::Demand, asked);
}

const FlightFolder* Controller::flight_records() const noexcept {
  return impl_->recorder ? &impl_->recorder->folder() : nullptr;
}

void Controller::on_event(std::function<void(const Event&)> listener) {
  impl_->event_listeners.push_back(std::move(listener));
}

void Controller::on_sample(std::function<void(const CycleSample&)> listener) {
  impl_->sample_listeners.push_back(std::move(listener));
}

void Controller::on_queued(QueueListener listener) {
  impl_->supervisor.on_queued(std::move(listener));
}

void Controller::cycle() {
  impl_->thread.step();
  impl_->dispatch();
}

void Controller::dispatch() {
  impl_->dispatch();
}

}  // namespace rmac::gateway
