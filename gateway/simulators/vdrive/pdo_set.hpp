#pragma once

#include <array>

#include "gateway/simulators/vdrive/objects/dictionary.hpp"
#include "gateway/simulators/vdrive/outlet.hpp"

namespace rmac::vdrive {

/// The process data objects of a node as its dictionary configures them: 1400h to 1403h, 1600h to 1603h, 1800h to 1803h
/// and 1A00h to 1A03h (CiA 301, 7.5.2.35 to 7.5.2.38).
class PdoSet {
 public:
  static constexpr std::size_t kPairs = 4;

  explicit PdoSet(Dictionary& dictionary) : dictionary_(dictionary) {}

  /// Abort code that refuses a write to one of the objects above; 0 for any other object.
  [[nodiscard]] std::uint32_t check(ObjectAddress object, std::int64_t value) const;
  /// Takes up what the dictionary says, after a change or a reset.
  void reload();

  enum class Fit : std::uint8_t { Fits, TooShort, TooLong };
  /// A frame that may be a setpoint. Those of SYNC wait for it, the latest alone; others act at once. Tells of a length
  /// that does not fit what is mapped; a frame that is too short is not acted on.
  Fit receive(const CanFrame& frame);
  /// Acts on what waited.
  void act_on_sync();

  /// What is to be told with this SYNC, or without one, from the dictionary as it is.
  void tell_on_sync(std::vector<CanFrame>& output);
  [[nodiscard]] bool tells_events() const;
  void tell_events(Time now, std::vector<CanFrame>& output);
  /// Also the first change after the node became operational is told.
  void forget_told();

  int length_change = 0;  ///< a fault: bytes that what it tells is longer than mapped

 private:
  struct Mapped {
    ObjectAddress object;
    std::size_t bytes = 0;
  };
  struct Pdo {
    bool valid = false;
    std::uint16_t id = 0;
    std::uint8_t type = 0;  ///< of transmission
    std::vector<Mapped> contents;
    std::size_t bytes = 0;
    std::optional<CanFrame> waits;
  };
  struct Told : Pdo {
    Time inhibit{0};
    Time event_timer{0};
    Time told_at{0};
    int syncs = 0;  ///< since it was told last
    std::optional<CanFrame> last;
  };
  void load(Pdo& pdo, std::uint16_t communication) const;
  [[nodiscard]] std::uint32_t check_id(std::uint16_t communication, std::uint32_t value) const;
  [[nodiscard]] std::uint32_t check_contents(ObjectAddress object, std::uint32_t value) const;
  [[nodiscard]] CanFrame frame_of(const Told& pdo) const;
  void act(const Pdo& pdo, const CanFrame& frame);

  Dictionary& dictionary_;
  std::array<Pdo, kPairs> setpoints_;
  std::array<Told, kPairs> told_;
};

}  // namespace rmac::vdrive
