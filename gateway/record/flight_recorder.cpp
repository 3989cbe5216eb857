#include "gateway/record/flight_recorder.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace rmac::gateway {
namespace {

/// How the machine came to rest belongs to a fault's record.
constexpr double kAfterFault_s = 0.25;
/// Longer than this nobody waits for the cycles after a fault: the servo thread may have ended, or time stand still.
constexpr std::chrono::seconds kPatience{2};
constexpr std::chrono::milliseconds kLookAgain{5};
/// From what happens until its cycles are copied, with the gateway and other records in between.
constexpr double kMargin_s = 3;
/// The same in virtual time, which waits for the gateway and for us.
constexpr double kMarginCycles = 4200;
constexpr std::size_t kMostRequests = 8;

}  // namespace

std::size_t FlightRecorder::history_cycles(const FlightRecorderOptions& options, double period_s) {
  if (!options.wanted() || !(period_s > 0)) return 0;
  const double shown = (options.seconds + kAfterFault_s) / period_s;
  return static_cast<std::size_t>(std::ceil(shown + std::max(kMargin_s / period_s, kMarginCycles)));
}

FlightRecorder::FlightRecorder(FlightRecorderOptions options, double period_s, CycleHistory& history)
    : options_(std::move(options)), period_s_(period_s), history_(history), folder_(options_.folder) {
  folder_.remove_unfinished();
  thread_ = std::thread([this] { run(); });
}

FlightRecorder::~FlightRecorder() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

Expected<std::string> FlightRecorder::request(FlightHead head) {
  // No two records have one name, however fast they are asked for.
  const auto now = std::max(std::chrono::system_clock::now(), last_named_ + std::chrono::milliseconds(1));
  last_named_ = now;
  head.name = FlightFolder::name_for(head.cause, head.cycle, now);
  head.utc = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(now)));
  std::string name = head.name;
  const std::int64_t first = head.cycle - std::lround(options_.seconds / period_s_) + 1;
  const std::int64_t after = head.cause == FlightCause::Fault ? std::lround(kAfterFault_s / period_s_) : 0;
  {
    const std::lock_guard lock(mutex_);
    if (requests_.size() >= kMostRequests) {
      return failure(MinorCode::Other, fmt::format("{} flight records are still being written; ask again when they are",
                                                   requests_.size()));
    }
    const std::int64_t last = head.cycle + after;
    requests_.push_back({std::move(head), first, last});
    want_what_is_left();
  }
  changed_.notify_one();
  return name;
}

std::vector<FlightRecorder::Outcome> FlightRecorder::take_outcomes() {
  const std::lock_guard lock(mutex_);
  return std::exchange(outcomes_, {});
}

void FlightRecorder::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ends_ || !requests_.empty(); });
    if (requests_.empty()) return;
    Request& request = requests_.front();  // stays where it is while others come behind it
    lock.unlock();
    Expected<> written = write(request);
    lock.lock();
    outcomes_.push_back({std::move(request.head), std::move(written)});
    requests_.pop_front();
    want_what_is_left();
  }
}

void FlightRecorder::want_what_is_left() {
  std::int64_t first = CycleHistory::kNothing;
  for (const Request& request : requests_) {
    if (!request.copied) first = std::min(first, request.first);
  }
  history_.want_from(first);
}

Expected<> FlightRecorder::write(Request& request) {
  try {
    FlightHead& head = request.head;
    wait_for_cycle(request.last);
    const auto samples = samples_of(request);
    {
      const std::lock_guard lock(mutex_);
      request.copied = true;
      want_what_is_left();
    }
    if (samples.empty()) {
      return failure(MinorCode::Other, fmt::format("the cycles before {} were overwritten before they could be written "
                                                   "down; is the computer too slow for this period?",
                                                   head.cycle));
    }
    head.first_cycle = samples.front().cycle;
    head.last_cycle = samples.back().cycle;
    for (std::size_t j = 0; j < head.joints.size(); ++j) head.joints[j].answer_delay = samples.back().answer_delay[j];
    return write_flight_record(folder_.file_of(head.name), head, samples).map([&] {
      folder_.prune(head.cause, options_.files_kept);
    });
  } catch (const std::exception& error) {
    return failure(MinorCode::Other, error.what());
  }
}

void FlightRecorder::wait_for_cycle(std::int64_t cycle) {
  std::unique_lock lock(mutex_);
  const auto give_up = std::chrono::steady_clock::now() + kPatience;
  while (!ends_ && history_.newest() < cycle && std::chrono::steady_clock::now() < give_up) {
    changed_.wait_for(lock, kLookAgain);
  }
}

std::vector<CycleSample> FlightRecorder::samples_of(const Request& request) const {
  // Newest first: the oldest may be overwritten meanwhile, and the record begins after them.
  std::vector<CycleSample> samples;
  const std::int64_t cycle_of_it = request.head.cycle;
  const std::int64_t first = std::max(history_.oldest(), request.first);
  samples.reserve(static_cast<std::size_t>(std::max<std::int64_t>(0, request.last - first + 1)));
  CycleSample sample;
  const auto add = [&](std::int64_t cycle) {
    const bool fits = history_.read(cycle, sample) && sample.joint_count_with_held > 0 &&
                      (samples.empty() || (sample.joint_count_with_held == samples.front().joint_count_with_held &&
                                           sample.actuator_count == samples.front().actuator_count &&
                                           sample.truth.has_value() == samples.front().truth.has_value()));
    if (fits) samples.push_back(sample);
    return fits;
  };
  // A mechanism with other joints, before or after, is not part of it: its columns differ.
  for (std::int64_t cycle = cycle_of_it; cycle >= first && add(cycle);) --cycle;
  std::reverse(samples.begin(), samples.end());
  if (!samples.empty()) {
    for (std::int64_t cycle = cycle_of_it + 1; cycle <= request.last && add(cycle);) ++cycle;
  }
  return samples;
}

}  // namespace rmac::gateway
