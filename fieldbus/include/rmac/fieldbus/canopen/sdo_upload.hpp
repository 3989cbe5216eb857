#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "rmac/fieldbus/canopen/sdo_dialogue.hpp"

namespace rmac::fieldbus::canopen {

/// Reading an object: expedited, segmented (CiA 301, 7.2.4.3.5 and 7.2.4.3.6) or in blocks (7.2.4.3.13 to 7.2.4.3.16).
/// Real-time safe.
class SdoUpload {
 public:
  struct Blocks {
    bool tried = false;             ///< before an ordinary transfer
    std::uint8_t size = 127;        ///< segments that the server may send in a row, 1 to 127
    std::uint8_t switch_below = 0;  ///< up to so many bytes the server may answer with an ordinary upload instead
  };

  void begin(std::span<std::uint8_t> into, const Blocks& blocks, SdoDialogue& dialogue) noexcept;
  /// The server does not know the command: where that was a block transfer, an ordinary one begins.
  [[nodiscard]] bool fall_back(SdoDialogue& dialogue) noexcept;
  void receive(const CanFrame& frame, SdoDialogue& dialogue) noexcept;

  /// The answer that is awaited names the object.
  [[nodiscard]] bool initiating() const noexcept { return phase_ == Phase::Initiate || phase_ == Phase::BlockInitiate; }
  /// Bytes read.
  [[nodiscard]] std::size_t moved() const noexcept { return moved_; }

 private:
  enum class Phase : std::uint8_t { Initiate, Segment, BlockInitiate, BlockData, BlockEnd };

  void initiate(SdoDialogue& dialogue) noexcept;
  void request_segment(SdoDialogue& dialogue) noexcept;
  void take_initiate(const CanFrame& frame, SdoDialogue& dialogue) noexcept;
  void take_segment(const CanFrame& frame, SdoDialogue& dialogue) noexcept;
  void take_block_initiate(const CanFrame& frame, SdoDialogue& dialogue) noexcept;
  void take_block_data(const CanFrame& frame, SdoDialogue& dialogue) noexcept;
  void take_block_end(const CanFrame& frame, SdoDialogue& dialogue) noexcept;
  [[nodiscard]] bool store(std::span<const std::uint8_t> bytes, SdoDialogue& dialogue) noexcept;

  std::span<std::uint8_t> into_;
  Phase phase_ = Phase::Initiate;
  std::size_t moved_ = 0;
  bool announces_ = false;  ///< the server told how many bytes there are
  std::uint32_t announced_ = 0;
  std::uint8_t toggle_ = 0;
  std::uint8_t block_size_ = 0;
  std::uint8_t sequence_ = 0;  ///< of the last segment received in order
  bool with_crc_ = false;
  bool last_seen_ = false;
  bool tail_waits_ = false;
  std::array<std::uint8_t, kSdoSegment> tail_{};  ///< how much of a block's last segment counts is told only at the end
};

}  // namespace rmac::fieldbus::canopen
