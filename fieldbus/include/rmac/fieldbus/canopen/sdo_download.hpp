#pragma once

#include <cstdint>
#include <span>

#include "rmac/fieldbus/canopen/sdo_step.hpp"

namespace rmac::fieldbus::canopen {

/// Writes one object of a server: expedited, segmented, or by blocks (CiA 301, 7.2.4.3.3, 4, 9 to 12). It knows bytes
/// alone, neither time nor identifiers. Real-time safe.
class SdoDownload {
 public:
  /// From `block_from` bytes a block transfer is tried first.
  explicit SdoDownload(std::size_t block_from) noexcept : block_from_(block_from) {}

  /// Begins. `data` must live until the transfer is over.
  [[nodiscard]] SdoStep begin(ObjectAddress object, std::span<const std::uint8_t> data) noexcept;
  /// Begins again, segmented.
  [[nodiscard]] SdoStep begin_without_blocks() noexcept;
  [[nodiscard]] SdoStep take(const SdoBytes& answer) noexcept;

  /// Whether segments of a block are to be sent one after the other, without an answer.
  [[nodiscard]] bool streams() const noexcept { return phase_ == Phase::BlockData; }
  /// The next of them.
  [[nodiscard]] SdoBytes next_segment() noexcept;

  /// Whether the answer to the first frame is still to come, which names the object.
  [[nodiscard]] bool initiating() const noexcept { return phase_ == Phase::Initiate || phase_ == Phase::BlockInitiate; }
  /// Whether the first frame asked for blocks, and is not answered.
  [[nodiscard]] bool tries_blocks() const noexcept { return phase_ == Phase::BlockInitiate; }

 private:
  enum class Phase : std::uint8_t { Initiate, Segment, BlockInitiate, BlockData, BlockAck, BlockEnd };

  [[nodiscard]] SdoStep take_initiate(const SdoBytes& answer) noexcept;
  [[nodiscard]] SdoStep take_segment(const SdoBytes& answer) noexcept;
  [[nodiscard]] SdoStep take_block_initiate(const SdoBytes& answer) noexcept;
  [[nodiscard]] SdoStep take_block_ack(const SdoBytes& answer) noexcept;
  [[nodiscard]] SdoStep segment() noexcept;
  [[nodiscard]] SdoBytes block_end() const noexcept;
  [[nodiscard]] bool fits_first_frame() const noexcept;
  /// What a segment from there on holds.
  [[nodiscard]] std::span<const std::uint8_t> rest(std::size_t from) const noexcept;

  std::size_t block_from_;
  Phase phase_ = Phase::Initiate;
  ObjectAddress object_;
  std::span<const std::uint8_t> data_;
  std::size_t taken_ = 0;  ///< bytes that the server has
  std::uint8_t toggle_ = 0;
  std::uint8_t block_size_ = 0;  ///< segments in a row, as the server wants them
  std::uint8_t sequence_ = 0;    ///< of the last segment sent
  std::uint8_t stalls_ = 0;      ///< blocks in a row of which the server took nothing
  bool with_crc_ = false;
};

}  // namespace rmac::fieldbus::canopen
