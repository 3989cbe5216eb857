#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "gateway/cycle/standing_wishes.hpp"
#include "gateway/queue/cycle_news.hpp"
#include "gateway/queue/queue_step.hpp"

namespace rmac::gateway {

/// What a program does between moves, taken when its turn has come: at rest, and while the cycle runs. One thread at a
/// time: the caller locks.
class ProgramTurn {
 public:
  enum class Outcome : std::uint8_t {
    Waits,  ///< ask again
    Done,
    SpindlesTold,  ///< done, and motion is to wait for the spindles
    Held,          ///< the program is to be held; asked again, it was told to go on
  };
  struct Seen {
    double t_s = 0;
    std::uint64_t inputs = 0;
    bool virtual_mode = false;  ///< no device is behind the inputs
  };

  ProgramTurn(StandingWishes& wishes, CycleNews& news) : wishes_(wishes), news_(news) {}

  /// The switch on the panel: optional stops hold the program from now on, or are passed over.
  void set_optional_stops(bool on) noexcept { optional_stops_ = on; }
  [[nodiscard]] bool optional_stops() const noexcept { return optional_stops_; }

  /// Begins or goes on with the step whose turn it is.
  [[nodiscard]] Outcome take(const InTurn& turn, const Seen& seen);
  /// The cycle does not run: what is waited for is not waited for meanwhile.
  void pause() noexcept;
  /// The queue was emptied.
  void drop();

  /// What the step whose turn it is waits for, in a word; empty when it does not.
  [[nodiscard]] const char* waits_for() const noexcept { return begun_ ? begun_->waits_for : ""; }
  /// What a person is to see to before the program goes on; empty: nothing.
  [[nodiscard]] const std::string& prompt() const noexcept { return prompt_; }

 private:
  /// A step under way.
  struct Begun {
    double waited_s = 0;
    std::optional<double> seen_s{};  ///< when the cycle ran last
    const char* waits_for = "";
    bool held = false;
  };

  [[nodiscard]] Outcome go_on(const InTurn& turn, const Dwell& dwell, const Seen& seen);
  [[nodiscard]] Outcome go_on(const InTurn& turn, const ProgramStop& stop, const Seen& seen);
  [[nodiscard]] Outcome go_on(const InTurn& turn, const AwaitInput& input, const Seen& seen);
  [[nodiscard]] Outcome go_on(const InTurn& turn, const Switch& switching, const Seen& seen);
  void begin(const InTurn& turn);
  void end(const InTurn& turn);
  [[nodiscard]] Outcome hold(const InTurn& turn, std::string prompt, const char* how_it_goes_on, MinorCode code);
  void tell(Event::Kind kind, const InTurn& turn, std::string message, MinorCode code = MinorCode::None);

  StandingWishes& wishes_;
  CycleNews& news_;
  std::optional<Begun> begun_;
  std::string prompt_;
  bool optional_stops_ = false;
};

}  // namespace rmac::gateway
