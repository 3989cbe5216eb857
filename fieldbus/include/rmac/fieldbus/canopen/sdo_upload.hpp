#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "rmac/fieldbus/canopen/sdo_step.hpp"

namespace rmac::fieldbus::canopen {

/// Reads one object of a server: expedited, segmented, or by blocks (CiA 301, 7.2.4.3.5, 6, 13 to 16). It knows bytes
/// alone, neither time nor identifiers. Real-time safe.
class SdoUpload {
 public:
  /// From `block_from` bytes of room a block transfer is tried first, `block_size` segments in a row.
  SdoUpload(std::size_t block_from, std::uint8_t block_size) noexcept
      : block_from_(block_from), block_size_(block_size) {}

  /// Begins. `into` must live until the transfer is over.
  [[nodiscard]] SdoStep begin(ObjectAddress object, std::span<std::uint8_t> into) noexcept;
  /// Begins again, segmented.
  [[nodiscard]] SdoStep begin_without_blocks() noexcept;
  [[nodiscard]] SdoStep take(const SdoBytes& answer) noexcept;

  /// Whether the answer to the first frame is still to come, which names the object.
  [[nodiscard]] bool initiating() const noexcept { return phase_ == Phase::Initiate || phase_ == Phase::BlockInitiate; }
  /// Whether the first frame asked for blocks, and is not answered.
  [[nodiscard]] bool tries_blocks() const noexcept { return phase_ == Phase::BlockInitiate; }
  /// Bytes that were stored.
  [[nodiscard]] std::size_t size() const noexcept { return stored_; }

 private:
  enum class Phase : std::uint8_t { Initiate, Segment, BlockInitiate, BlockData, BlockEnd };

  [[nodiscard]] SdoStep take_initiate(const SdoBytes& answer) noexcept;
  [[nodiscard]] SdoStep take_segment(const SdoBytes& answer) noexcept;
  [[nodiscard]] SdoStep take_block_initiate(const SdoBytes& answer) noexcept;
  [[nodiscard]] SdoStep take_block_data(const SdoBytes& answer) noexcept;
  [[nodiscard]] SdoStep take_block_end(const SdoBytes& answer) noexcept;
  [[nodiscard]] SdoStep request_segment() noexcept;
  /// Notes the size that an answer announces; false when there is no room for it.
  [[nodiscard]] bool announce(bool sized, const SdoBytes& answer) noexcept;
  [[nodiscard]] bool store(std::span<const std::uint8_t> bytes) noexcept;
  [[nodiscard]] bool complete() const noexcept { return !announces_ || stored_ == announced_; }

  std::size_t block_from_;
  std::uint8_t block_size_;
  Phase phase_ = Phase::Initiate;
  ObjectAddress object_;
  std::span<std::uint8_t> into_;
  std::size_t stored_ = 0;
  std::uint32_t announced_ = 0;
  bool announces_ = false;
  std::uint8_t toggle_ = 0;
  std::uint8_t sequence_ = 0;  ///< of the last segment of a block that came in order
  bool with_crc_ = false;
  bool last_seen_ = false;
  bool tail_waits_ = false;
  std::array<std::uint8_t, sdo_command::kSegment> tail_{};  ///< how much of the last segment counts is told at the end
};

}  // namespace rmac::fieldbus::canopen
