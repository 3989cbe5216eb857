#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gpiod.h>
#include <poll.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <ctime>
#include <map>
#include <memory>
#include <system_error>
#include <vector>

#include "rmac/fieldbus/gpio/line_port.hpp"

namespace rmac::fieldbus::gpio {
namespace {

constexpr const char* kConsumer = "rmacd";
/// As many edges as the kernel keeps of a line: where it had to keep so many there may have been more.
constexpr std::size_t kKept = 16;

struct CloseChip {
  void operator()(gpiod_chip* chip) const noexcept { gpiod_chip_close(chip); }  // releases its lines, too
};
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

tl::unexpected<Error> refuse(std::string what) {
  return failure(MinorCode::InvalidParameterValue, "GPIOInterface: " + std::move(what));
}

std::string chips_there() {
  std::vector<std::string> found;
  if (gpiod_chip_iter* const chips = gpiod_chip_iter_new()) {
    while (gpiod_chip* const chip = gpiod_chip_iter_next(chips)) {
      found.push_back(
          fmt::format("{} ({}, {} lines)", gpiod_chip_name(chip), gpiod_chip_label(chip), gpiod_chip_num_lines(chip)));
    }
    gpiod_chip_iter_free(chips);
  }
  return found.empty() ? "there is none that may be opened" : fmt::format("there are {}", fmt::join(found, ", "));
}

std::string lines_there(gpiod_chip* chip) {
  std::vector<std::string> found;
  for (unsigned i = 0; i < gpiod_chip_num_lines(chip); ++i) {
    gpiod_line* const line = gpiod_chip_get_line(chip, i);
    const char* const name = line != nullptr ? gpiod_line_name(line) : nullptr;
    if (name != nullptr) found.emplace_back(name);
  }
  const std::string numbers = fmt::format("#0 to #{}", gpiod_chip_num_lines(chip) - 1);
  return found.empty() ? "none of its lines has a name; by number there are " + numbers
                       : fmt::format("there are {}, and by number {}", fmt::join(found, ", "), numbers);
}

int bias_flags(Bias bias) noexcept {
  switch (bias) {
    case Bias::PullUp:
      return GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
    case Bias::PullDown:
      return GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
    case Bias::None:
      return GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE;
    case Bias::AsIs:
      break;
  }
  return 0;
}

Time to_time(const timespec& at) noexcept {
  return std::chrono::seconds(at.tv_sec) + Time(at.tv_nsec);
}

class KernelLines final : public LinePort {
 public:
  Expected<> open(std::span<const LineSpec> inputs, std::span<const LineSpec> outputs) override {
    close();
    auto claimed = claim_all(inputs, outputs);
    if (!claimed) close();
    return claimed;
  }

  void close() noexcept override {
    inputs_.clear();
    outputs_.clear();
    waits_.clear();
    edges_.clear();
    chips_.clear();
  }

  bool read_levels(std::span<std::uint8_t> high) noexcept override {
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      const int level = gpiod_line_get_value(inputs_[i]);
      if (level < 0) return false;
      high[i] = static_cast<std::uint8_t>(level);
    }
    return true;
  }

  bool read_edges(std::span<const Edge>& edges) noexcept override {
    std::size_t count = 0;
    const int ready = poll(waits_.data(), waits_.size(), 0);
    bool works = ready >= 0 || errno == EINTR;
    for (std::size_t i = 0; ready > 0 && i < waits_.size(); ++i) {
      if ((waits_[i].revents & POLLIN) != 0) works = read_line(i, count) && works;
      if ((waits_[i].revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) works = false;
    }
    edges = std::span<const Edge>(edges_.data(), count);
    return works;
  }

  bool write(std::size_t output, bool high) noexcept override {
    return gpiod_line_set_value(outputs_[output], high ? 1 : 0) == 0;
  }

  Time now() noexcept override {
    timespec at{};
    clock_gettime(CLOCK_MONOTONIC, &at);
    return to_time(at);
  }

 private:
  Expected<> claim_all(std::span<const LineSpec> inputs, std::span<const LineSpec> outputs) {
    for (const LineSpec& spec : inputs) {
      auto line = find(spec);
      if (!line) return tl::unexpected(line.error());
      if (gpiod_line_request_both_edges_events_flags(*line, kConsumer, bias_flags(spec.bias)) != 0) {
        return refused(spec, *line, "an input with edges");
      }
      const int descriptor = gpiod_line_event_get_fd(*line);
      // A cycle must never wait here: edges that came are read until there are none.
      if (descriptor < 0 || fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) | O_NONBLOCK) != 0) {
        return refused(spec, *line, "an input that does not block");
      }
      inputs_.push_back(*line);
      waits_.push_back({descriptor, POLLIN, 0});
    }
    for (const LineSpec& spec : outputs) {
      auto line = find(spec);
      if (!line) return tl::unexpected(line.error());
      if (gpiod_line_request_output(*line, kConsumer, spec.inverted ? 1 : 0) != 0) {
        return refused(spec, *line, "an output");
      }
      outputs_.push_back(*line);
    }
    edges_.resize(inputs_.size() * (kKept + 1));
    return {};
  }

  Expected<gpiod_chip*> chip(const std::string& name) {
    Chip& known = chips_[name];
    if (!known) known.reset(gpiod_chip_open_lookup(name.c_str()));
    if (known) return known.get();
    if (errno == EACCES || errno == EPERM) {
      return refuse(fmt::format("chip {} may not be opened; let the daemon's user into the group that owns it", name));
    }
    return refuse(fmt::format("there is no chip \"{}\"; {}", name, chips_there()));
  }

  Expected<gpiod_line*> find(const LineSpec& spec) {
    auto there = chip(spec.chip);
    if (!there) return tl::unexpected(there.error());
    gpiod_line* line = nullptr;
    if (unsigned number = 0; spec.name.starts_with('#')) {
      const char* const end = spec.name.data() + spec.name.size();
      const auto [rest, trouble] = std::from_chars(spec.name.data() + 1, end, number);
      if (trouble == std::errc() && rest == end) line = gpiod_chip_get_line(*there, number);
    } else {
      line = gpiod_chip_find_line(*there, spec.name.c_str());
    }
    if (line == nullptr) {
      return refuse(fmt::format("chip {} has no line \"{}\"; {}", spec.chip, spec.name, lines_there(*there)));
    }
    return line;
  }

  tl::unexpected<Error> refused(const LineSpec& spec, gpiod_line* line, const char* what) {
    const int reason = errno;
    if (reason == EBUSY) {
      const char* const who = gpiod_line_update(line) == 0 ? gpiod_line_consumer(line) : nullptr;
      return refuse(fmt::format("line {} of chip {} is taken by \"{}\"; end that, or name another line", spec.name,
                                spec.chip, who != nullptr ? who : "the kernel"));
    }
    return refuse(fmt::format("line {} of chip {} cannot be {}: {}", spec.name, spec.chip, what,
                              std::generic_category().message(reason)));
  }

  /// The edges of one line. After as many as the kernel keeps, the level is asked for: some may be lost.
  bool read_line(std::size_t line, std::size_t& count) noexcept {
    std::array<gpiod_line_event, kKept> events{};
    const int descriptor = waits_[line].fd;
    const int read = gpiod_line_event_read_fd_multiple(descriptor, events.data(), kKept);
    if (read < 0) return errno == EAGAIN;
    for (int i = 0; i < read; ++i) {
      const gpiod_line_event& event = events[static_cast<std::size_t>(i)];
      edges_[count++] = {line, event.event_type == GPIOD_LINE_EVENT_RISING_EDGE, to_time(event.ts)};
    }
    if (static_cast<std::size_t>(read) < kKept) return true;
    const int level = gpiod_line_get_value(inputs_[line]);
    if (level < 0) return false;
    if (edges_[count - 1].high != (level != 0)) edges_[count++] = {line, level != 0, now()};
    return true;
  }

  std::map<std::string, Chip> chips_;
  std::vector<gpiod_line*> inputs_, outputs_;  ///< the chips'
  std::vector<pollfd> waits_;                  ///< one an input
  std::vector<Edge> edges_;
};

}  // namespace

std::unique_ptr<LinePort> make_kernel_lines() {
  return std::make_unique<KernelLines>();
}

}  // namespace rmac::fieldbus::gpio
