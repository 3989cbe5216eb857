#include "rmac/fieldbus/modbus/io_interface.hpp"

#include <atomic>
#include <optional>

#include "modbus/image.hpp"

namespace rmac::fieldbus::modbus {
namespace {

/// A device without inputs shows its outputs, so that it is known to be there.
std::vector<Image::Wanted> io_registers(const IoMap& map) {
  std::vector<Image::Wanted> wanted;
  for (const BitRange& range : map.inputs.empty() ? map.outputs : map.inputs) {
    wanted.push_back({range.place.table, range.place.address, range.addresses()});
  }
  return wanted;
}

class IoStation final : public Station {
 public:
  IoStation(int slave, IoMap map)
      : slave_(slave), map_(std::move(map)), image_(io_registers(map_), map_.most_per_read) {}

  [[nodiscard]] int slave() const noexcept override { return slave_; }
  void forget() noexcept override { applied_.reset(); }

  Answer<> serve(Client& client) override {
    if (auto sure = image_.resynchronise(client, slave_); !sure) return sure;
    const auto asked = image_.read(client, slave_);
    if (!asked) return tl::unexpected(asked.error());
    std::uint64_t bits = 0;
    for (const BitRange& range : map_.inputs) bits |= read(range);
    inputs.store(bits, std::memory_order_release);
    asked_at.store(asked->time_since_epoch().count(), std::memory_order_release);
    return apply(client, outputs.load(std::memory_order_acquire));
  }

  Answer<> make_safe(Client& client) override {
    if (auto sure = image_.resynchronise(client, slave_); !sure) return sure;
    applied_.reset();
    return apply(client, 0);
  }

  std::atomic<std::uint64_t> outputs{0};
  std::atomic<std::uint64_t> inputs{0};
  std::atomic<Clock::rep> asked_at{Clock::time_point::min().time_since_epoch().count()};

 private:
  [[nodiscard]] std::uint64_t read(const BitRange& range) const noexcept {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < range.count; ++i) {
      const std::size_t address = range.place.address + (of_bits(range.place.table) ? i : i / 16);
      const std::uint32_t value = image_.at(range.place.table, address);
      const std::size_t shift = of_bits(range.place.table) ? 0 : i % 16;
      const bool on = (value >> shift & 1U) != 0;
      if (on != range.inverted) bits |= std::uint64_t{1} << (range.first + i);
    }
    return bits;
  }

  Answer<> apply(Client& client, std::uint64_t bits) {
    if (applied_ == bits) return {};
    for (const BitRange& range : map_.outputs) {
      std::vector<std::uint16_t> values(range.addresses());
      for (std::size_t i = 0; i < range.count; ++i) {
        const bool on = (bits >> (range.first + i) & 1U) != 0;
        if (on == range.inverted) continue;
        std::uint16_t& value = values[of_bits(range.place.table) ? i : i / 16];
        value = static_cast<std::uint16_t>(value | 1U << (of_bits(range.place.table) ? 0 : i % 16));
      }
      if (auto written = client.write(slave_, range.place.table, range.place.address, values); !written) return written;
    }
    applied_ = bits;
    return {};
  }

  int slave_;
  IoMap map_;
  Image image_;
  std::optional<std::uint64_t> applied_;
};

}  // namespace

struct IoInterface::Impl {
  explicit Impl(IoLineConfig config)
      : now(config.line.now),
        stale(config.stale),
        boot_timeout(config.boot_timeout),
        station(config.slave, std::move(config.map)),
        line(std::move(config.line), {&station}) {}

  Now now;
  std::chrono::milliseconds stale;
  std::chrono::milliseconds boot_timeout;
  IoStation station;
  Line line;
};

IoInterface::IoInterface(IoLineConfig config) : impl_(std::make_unique<Impl>(std::move(config))) {}
IoInterface::~IoInterface() {
  stop();
}

Expected<> IoInterface::start() {
  stop();
  return impl_->line.start(impl_->boot_timeout);
}

void IoInterface::stop() noexcept {
  impl_->line.stop();
  impl_->station.outputs = 0;
  impl_->station.asked_at = Clock::time_point::min().time_since_epoch().count();
}

std::string IoInterface::fault_text() const {
  const auto text = impl_->line.trouble(0);
  return text ? "the device " + *text : "what it told last is too old; see that the computer has time for its line";
}

LineReport IoInterface::line_report() const {
  return impl_->line.report();
}

bool IoInterface::exchange(std::uint64_t outputs, std::uint64_t& inputs) noexcept {
  IoStation& station = impl_->station;
  const Clock::time_point asked{Clock::duration(station.asked_at.load(std::memory_order_acquire))};
  const bool fresh = asked != Clock::time_point::min() && impl_->now() - asked <= impl_->stale;
  const std::uint64_t wanted = fresh ? outputs : 0;
  if (station.outputs.exchange(wanted, std::memory_order_acq_rel) != wanted) impl_->line.wake();
  if (!fresh) return false;
  inputs = station.inputs.load(std::memory_order_acquire);
  return true;
}

}  // namespace rmac::fieldbus::modbus
