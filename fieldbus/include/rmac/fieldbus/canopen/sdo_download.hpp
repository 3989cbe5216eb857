#pragma once

#include <cstdint>
#include <span>

#include "rmac/fieldbus/canopen/sdo_dialogue.hpp"

namespace rmac::fieldbus::canopen {

/// Writing an object: expedited, segmented (CiA 301, 7.2.4.3.3 and 7.2.4.3.4) or in blocks (7.2.4.3.9 to 7.2.4.3.12).
/// Real-time safe.
class SdoDownload {
 public:
  /// `in_blocks`: a block transfer is tried first.
  void begin(std::span<const std::uint8_t> data, bool in_blocks, SdoDialogue& dialogue) noexcept;
  /// The server does not know the command: where that was a block transfer, an ordinary one begins.
  [[nodiscard]] bool fall_back(SdoDialogue& dialogue) noexcept;
  void receive(const CanFrame& frame, SdoDialogue& dialogue) noexcept;

  /// In the midst of a block, segments are sent and no answer is awaited: `put_segment` makes the next one.
  [[nodiscard]] bool sends_block() const noexcept { return phase_ == Phase::BlockData; }
  void put_segment(SdoDialogue& dialogue) noexcept;

  /// The answer that is awaited names the object.
  [[nodiscard]] bool initiating() const noexcept { return phase_ == Phase::Initiate || phase_ == Phase::BlockInitiate; }
  /// Bytes that the server has.
  [[nodiscard]] std::size_t moved() const noexcept { return moved_; }

 private:
  enum class Phase : std::uint8_t { Initiate, Segment, BlockInitiate, BlockData, BlockAck, BlockEnd };

  void initiate(SdoDialogue& dialogue) noexcept;
  void take_initiate(const CanFrame& frame, SdoDialogue& dialogue) noexcept;
  void send_segment(SdoDialogue& dialogue) noexcept;
  void take_segment(const CanFrame& frame, SdoDialogue& dialogue) noexcept;
  void take_block_initiate(const CanFrame& frame, SdoDialogue& dialogue) noexcept;
  void take_block_ack(const CanFrame& frame, SdoDialogue& dialogue) noexcept;
  void take_block_end(const CanFrame& frame, SdoDialogue& dialogue) noexcept;
  [[nodiscard]] bool expedited() const noexcept { return !from_.empty() && from_.size() <= kSdoExpedited; }
  [[nodiscard]] std::span<const std::uint8_t> rest(std::size_t from) const noexcept;

  std::span<const std::uint8_t> from_;
  Phase phase_ = Phase::Initiate;
  std::size_t moved_ = 0;
  std::uint8_t toggle_ = 0;
  std::uint8_t block_size_ = 0;
  std::uint8_t sequence_ = 0;  ///< of the last segment sent
  std::uint8_t stalls_ = 0;    ///< blocks in a row of which the server took nothing
  bool with_crc_ = false;
};

}  // namespace rmac::fieldbus::canopen
