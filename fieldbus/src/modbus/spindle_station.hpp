#pragma once

#include <atomic>
#include <optional>

#include "modbus/image.hpp"
#include "rmac/fieldbus/modbus/modbus_config.hpp"

namespace rmac::fieldbus::modbus {

/// One spindle drive: the line's thread serves it, the servo thread leaves commands and takes reports.
class SpindleStation final : public Station {
 public:
  explicit SpindleStation(SpindleConfig config);

  /// What was read last.
  struct Report {
    std::int32_t rpm = 0;
    std::uint16_t error_code = 0;
    bool tripped = false;
    bool dropped = false;  ///< told to run, and stands: someone stopped it at its panel, or it does not take commands
    Clock::time_point asked = Clock::time_point::min();  ///< it is at least as new as this
    Clock::time_point busy = Clock::time_point::min();   ///< when the drive said last that it is
  };

  // The servo thread's; real-time safe.
  /// 0: stop, and so is backward where the drive's map has no way to. True when that is news.
  bool command(std::int32_t rpm) noexcept;
  void request_reset() noexcept { resets_.fetch_add(1, std::memory_order_relaxed); }
  [[nodiscard]] Report report() const noexcept;
  /// What was reported counts no more, and the drive is to stop. Not while the line's thread runs.
  void clear() noexcept;

  [[nodiscard]] int slave() const noexcept override { return config_.slave; }
  Answer<> serve(Client& client) override;
  void forget() noexcept override;
  Answer<> make_safe(Client& client) override;

  [[nodiscard]] const SpindleMap& map() const noexcept { return config_.map; }

 private:
  static constexpr Clock::rep kNever = Clock::time_point::min().time_since_epoch().count();

  [[nodiscard]] Answer<> write(Client& client, const std::vector<RegisterWrite>& writes) const;
  [[nodiscard]] Words speed_words(std::int32_t rpm) const noexcept;
  Answer<> stop_at_once(Client& client);
  Answer<> apply(Client& client, std::int32_t rpm);
  Answer<> reset_if_asked(Client& client);
  void check_read_back() noexcept;
  [[nodiscard]] bool lacks_its_code() const noexcept;
  void publish(Clock::time_point asked) noexcept;
  Answer<> serve_once(Client& client);

  SpindleConfig config_;
  Image image_;
  std::optional<std::int32_t> applied_;  ///< rpm that the drive confirmed; none: not known
  Clock::time_point applied_at_{};
  Clock::time_point stop_sent_at_{};
  std::optional<Words> speed_;  ///< speed command that the drive confirmed
  std::uint32_t resets_done_ = 0;
  Clock::time_point reset_at_{};

  std::atomic<std::int32_t> wanted_rpm_{0};
  std::atomic<std::uint32_t> resets_{0};
  std::atomic<std::uint64_t> values_{0};  ///< rpm, error code, flags
  std::atomic<Clock::rep> asked_{kNever};
  std::atomic<Clock::rep> busy_{kNever};
};

}  // namespace rmac::fieldbus::modbus
