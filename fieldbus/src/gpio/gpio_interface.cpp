#include "rmac/fieldbus/gpio/gpio_interface.hpp"

#include <fmt/format.h>

namespace rmac::fieldbus::gpio {
namespace {

std::uint64_t mask(std::size_t bit) noexcept {
  return std::uint64_t{1} << bit;
}

std::string text(const LineSpec& line) {
  return fmt::format("{} of {}", line.name, line.chip);
}

}  // namespace

GpioInterface::GpioInterface(GpioConfig config, std::unique_ptr<LinePort> port)
    : config_(std::move(config)), port_(std::move(port)) {
  for (std::size_t i = 0; i < config_.inputs.size(); ++i) {
    const InputConfig& input = config_.inputs[i];
    input_bits_ |= mask(input.bit);
    for (std::size_t c = 0; c < input.contacts.size(); ++c) contacts_.push_back({i, c, input.contacts[c].inverted});
  }
  for (const OutputConfig& output : config_.outputs) output_bits_ |= mask(output.bit);
}

GpioInterface::~GpioInterface() {
  stop();
}

Expected<> GpioInterface::start() {
  stop();
  std::vector<LineSpec> inputs, outputs;
  for (const InputConfig& input : config_.inputs) {
    inputs.insert(inputs.end(), input.contacts.begin(), input.contacts.end());
  }
  for (const OutputConfig& output : config_.outputs) outputs.push_back(output.line);
  if (auto claimed = port_->open(inputs, outputs); !claimed) return claimed;
  open_ = true;
  written_ = 0;

  signals_.clear();
  for (const InputConfig& input : config_.inputs) {
    signals_.emplace_back(input.contacts.size(), input.debounce, config_.disagreement);
  }
  std::vector<std::uint8_t> high(inputs.size());
  if (!port_->read_levels(high)) {
    stop();
    return failure(MinorCode::Other, "GPIOInterface: the levels of its lines cannot be read");
  }
  const Time now = port_->now();
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    signals_[contacts_[i].signal].begin(contacts_[i].contact, (high[i] != 0) != contacts_[i].inverted, now);
  }
  return {};
}

void GpioInterface::stop() noexcept {
  if (!open_) return;
  (void)write(0);
  port_->close();
  open_ = false;
}

bool GpioInterface::write(std::uint64_t outputs) noexcept {
  const std::uint64_t changed = written_ ^ outputs;
  for (std::size_t i = 0; i < config_.outputs.size(); ++i) {
    const OutputConfig& output = config_.outputs[i];
    if ((changed & mask(output.bit)) == 0) continue;
    const bool active = (outputs & mask(output.bit)) != 0;
    if (!port_->write(i, active != output.line.inverted)) return false;
    written_ ^= mask(output.bit);
  }
  return true;
}

bool GpioInterface::exchange(std::uint64_t outputs, std::uint64_t& inputs) noexcept {
  std::span<const Edge> edges;
  int trouble = open_ && port_->read_edges(edges) ? kSound : kChip;
  for (const Edge& edge : edges) {
    const Contact& contact = contacts_[edge.line];
    signals_[contact.signal].edge(contact.contact, edge.high != contact.inverted, edge.at);
  }
  const Time now = looked_ = port_->now();
  std::uint64_t active = 0;
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    if (signals_[i].active(now)) active |= mask(config_.inputs[i].bit);
    if (trouble == kSound && signals_[i].broken(now)) trouble = static_cast<int>(i);
  }
  inputs = active;
  if (open_ && !write(trouble == kSound ? outputs : 0) && trouble == kSound) trouble = kChip;
  if (trouble != kSound) trouble_.store(trouble, std::memory_order_relaxed);
  return trouble == kSound;
}

double GpioInterface::on_for_s(std::size_t bit) const noexcept {
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    if (config_.inputs[i].bit == bit)
      return std::chrono::duration<double>(looked_ - signals_[i].active_since()).count();
  }
  return 0;
}

std::string GpioInterface::fault_text() const {
  const int trouble = trouble_.load(std::memory_order_relaxed);
  if (trouble < 0) return "the GPIO chip does not answer; check that it is still there";
  const InputConfig& input = config_.inputs[static_cast<std::size_t>(trouble)];
  return fmt::format(
      "the two contacts of input {} disagree (line {} and line {}); look for a broken wire, or a contact that sticks",
      input.bit, text(input.contacts[0]), text(input.contacts[1]));
}

}  // namespace rmac::fieldbus::gpio
