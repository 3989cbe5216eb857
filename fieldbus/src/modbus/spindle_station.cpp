#include "modbus/spindle_station.hpp"

#include <algorithm>
#include <cmath>

namespace rmac::fieldbus::modbus {
namespace {

// A drive that was told to run says that it does within this time.
constexpr std::chrono::seconds kStartsWithin{2};
// Some drives restart when they are reset, and answer nothing meanwhile (WJ200: about a second).
constexpr std::chrono::seconds kBetweenResets{2};

constexpr auto kBetweenStops = 2 * Client::kSettle;

constexpr std::uint64_t kTripped = std::uint64_t{1} << 48U;
constexpr std::uint64_t kDropped = std::uint64_t{1} << 49U;
constexpr std::uint16_t kNoCodeOfItsOwn = 0xFF00;  // CiA 402: manufacturer specific

std::vector<Image::Wanted> spindle_registers(const SpindleMap& map) {
  std::vector<Image::Wanted> wanted;
  const auto add = [&wanted](const Place& place) { wanted.push_back({place.table, place.address, place.count()}); };
  add(map.speed.place);
  if (map.speed_read_back) add(*map.speed_read_back);
  if (map.running) add(map.running->place);
  if (map.backward) add(map.backward->place);
  if (map.tripped) add(map.tripped->place);
  if (map.fault_code) add(*map.fault_code);
  return wanted;
}

}  // namespace

SpindleStation::SpindleStation(SpindleConfig config)
    : config_(std::move(config)), image_(spindle_registers(config_.map), config_.map.most_per_read) {}

bool SpindleStation::command(std::int32_t rpm) noexcept {
  const bool possible = rpm >= 0 || !config_.map.backward_run.empty();
  const std::int32_t wanted = possible ? rpm : 0;
  return wanted_rpm_.exchange(wanted, std::memory_order_acq_rel) != wanted;
}

SpindleStation::Report SpindleStation::report() const noexcept {
  // The time first: what comes with it may then be newer than it says, and never older.
  const Clock::time_point asked{Clock::duration(asked_.load(std::memory_order_acquire))};
  const std::uint64_t values = values_.load(std::memory_order_acquire);
  return {.rpm = static_cast<std::int32_t>(static_cast<std::uint32_t>(values)),
          .error_code = static_cast<std::uint16_t>(values >> 32U),
          .tripped = (values & kTripped) != 0,
          .dropped = (values & kDropped) != 0,
          .asked = asked,
          .busy = Clock::time_point(Clock::duration(busy_.load(std::memory_order_acquire)))};
}

void SpindleStation::publish(Clock::time_point asked) noexcept {
  const SpindleMap& map = config_.map;
  const double raw = image_.number(map.speed.place) / map.speed.per_unit;
  const bool backward = map.backward ? image_.holds(*map.backward) : applied_.value_or(0) < 0;
  const double hz = backward && !map.speed.place.is_signed ? -raw : raw;
  const double rpm = std::clamp(std::round(hz * config_.rpm_per_hz), -2e9, 2e9);
  const std::uint32_t code = map.fault_code ? image_.raw(*map.fault_code) : 0;
  const bool tripped = map.tripped ? image_.holds(*map.tripped) : code != 0;
  const bool stands = map.running && !image_.holds(*map.running);
  const bool dropped = stands && applied_.value_or(0) != 0 && asked - applied_at_ > kStartsWithin;

  std::uint64_t values = static_cast<std::uint32_t>(static_cast<std::int32_t>(rpm));
  if (tripped) {
    const auto word = static_cast<std::uint16_t>(code);
    values |= kTripped | std::uint64_t{word != 0 ? word : kNoCodeOfItsOwn} << 32U;
  }
  if (dropped) values |= kDropped;
  values_.store(values, std::memory_order_release);
  asked_.store(asked.time_since_epoch().count(), std::memory_order_release);
}

void SpindleStation::clear() noexcept {
  wanted_rpm_ = 0;
  resets_done_ = resets_;
  asked_ = kNever;
  busy_ = kNever;
  applied_.reset();
  speed_.reset();
}

/// A stop is sent again in doubt, and so is a speed. A run is not: a drive that was told to and stands was stopped by
/// someone, who must not see it start again.
void SpindleStation::forget() noexcept {
  if (applied_ == 0) applied_.reset();
  speed_.reset();
}

Answer<> SpindleStation::write(Client& client, const std::vector<RegisterWrite>& writes) const {
  for (const RegisterWrite& one : writes) {
    if (auto written = client.write(config_.slave, one.table, one.address, {&one.value, 1}); !written) return written;
  }
  return {};
}

Words SpindleStation::speed_words(std::int32_t rpm) const noexcept {
  const SpindleMap& map = config_.map;
  const double hz = std::abs(static_cast<double>(rpm)) / config_.rpm_per_hz;
  const double value = map.speed_command_unit == SpindleMap::Unit::Hertz ? hz : hz / config_.maximum_hz;
  return to_words(map.speed_command.place, value * map.speed_command.per_unit);
}

/// Speed before run: a drive never starts towards a speed of the past.
Answer<> SpindleStation::apply(Client& client, std::int32_t rpm) {
  if (applied_ == rpm && (rpm == 0 || speed_ == speed_words(rpm))) return {};
  const SpindleMap& map = config_.map;
  if (rpm != 0) {
    stop_sent_at_ = {};
    const Words words = speed_words(rpm);
    if (speed_ != words) {
      const Place& place = map.speed_command.place;
      const std::span<const std::uint16_t> values(words.words.data(), words.count);
      if (auto written = client.write(config_.slave, place.table, place.address, values); !written) return written;
      speed_ = words;
    }
  }
  const bool same_way = applied_ && (*applied_ > 0) == (rpm > 0) && (*applied_ < 0) == (rpm < 0);
  if (!same_way) {
    const auto& writes = rpm == 0 ? map.stop : rpm > 0 ? map.forward_run : map.backward_run;
    applied_.reset();  // until it is confirmed
    if (auto written = write(client, writes); !written) return written;
    applied_at_ = client.now();
  }
  applied_ = rpm;
  return {};
}

Answer<> SpindleStation::reset_if_asked(Client& client) {
  const std::uint32_t asked = resets_.load(std::memory_order_relaxed);
  const auto now = client.now();
  if (asked == resets_done_ || now - reset_at_ < kBetweenResets) return {};
  resets_done_ = asked;
  reset_at_ = now;
  return write(client, config_.map.reset_fault);
}

/// The drive shows another speed than it confirmed: it is told again.
void SpindleStation::check_read_back() noexcept {
  const SpindleMap& map = config_.map;
  if (!map.speed_read_back || !speed_) return;
  Place place = *map.speed_read_back;
  place.mask = 0xFFFFFFFF;
  if (to_words(place, image_.number(place)) != *speed_) speed_.reset();
}

/// The drive tripped between the reading of its code and that of its state.
bool SpindleStation::lacks_its_code() const noexcept {
  const SpindleMap& map = config_.map;
  const bool told = (values_.load(std::memory_order_relaxed) & kTripped) != 0;
  return !told && map.tripped && map.fault_code && image_.holds(*map.tripped) && image_.raw(*map.fault_code) == 0;
}

/// A stop goes out before anything is asked, in doubt too: once, and then again seldom, because a slave may have to be
/// left alone before its answers can be trusted again. A drive that is busy did not take it, and is told again.
Answer<> SpindleStation::stop_at_once(Client& client) {
  const auto now = client.now();
  const bool wanted = wanted_rpm_.load(std::memory_order_acquire) == 0;
  if (!wanted || applied_ == 0 || now - stop_sent_at_ < kBetweenStops) return {};
  stop_sent_at_ = now;
  auto stopped = apply(client, 0);
  if (!stopped && stopped.error().kind == Failure::Kind::InDoubt) return {};
  if (stopped || !stopped.error().busy()) return stopped;
  stop_sent_at_ = {};
  return {};  // it may tell its state all the same
}

Answer<> SpindleStation::serve(Client& client) {
  auto served = serve_once(client);
  // What was read before it was told to run or stop does not hold on for its being busy.
  const bool holds = Clock::time_point(Clock::duration(asked_.load(std::memory_order_relaxed))) >= applied_at_;
  if (!served && served.error().busy() && holds) {
    busy_.store(client.now().time_since_epoch().count(), std::memory_order_release);
  }
  return served;
}

Answer<> SpindleStation::serve_once(Client& client) {
  if (auto stopped = stop_at_once(client); !stopped) return stopped;
  if (auto sure = image_.resynchronise(client, config_.slave); !sure) return sure;
  auto asked = image_.read(client, config_.slave);
  if (asked && lacks_its_code()) asked = image_.read(client, config_.slave);
  if (!asked) return tl::unexpected(asked.error());
  check_read_back();
  publish(*asked);
  if (auto done = reset_if_asked(client); !done) return done;
  return apply(client, wanted_rpm_.load(std::memory_order_acquire));
}

Answer<> SpindleStation::make_safe(Client& client) {
  wanted_rpm_ = 0;
  auto stopped = write(client, config_.map.stop);
  // In doubt the answer may be another's. After the next one it is this one's.
  if (!stopped && stopped.error().kind == Failure::Kind::InDoubt) {
    if (auto sure = image_.resynchronise(client, config_.slave); !sure) return sure;
    return write(client, config_.map.stop);
  }
  return stopped;
}

}  // namespace rmac::fieldbus::modbus
