#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <span>

#include "rmac/fieldbus/can/can_port.hpp"
#include "rmac/fieldbus/canopen/sdo.hpp"

namespace rmac::fieldbus::canopen {

/// The client's side of service data objects with one node (CiA 301, 7.2.4.3): expedited, segmented and block
/// transfers, both ways. A state machine without clock or socket: frames go in, frames come out. One transfer at a
/// time. Real-time safe.
///
/// An answer to something else than what was asked last (a late one, after a time-out) is passed over; it never counts
/// for the transfer that runs.
class SdoClient {
 public:
  struct Options {
    std::chrono::nanoseconds timeout = std::chrono::milliseconds(500);  ///< for each answer of the server
    /// Beyond so many bytes (of data, or of room for them) a block transfer is tried first; a server that does not know
    /// it gets a segmented one.
    std::size_t block_from = 29;
    std::uint8_t block_size = 127;  ///< segments that the server may send in a row, 1 to 127
  };
  enum class State : std::uint8_t {
    Idle,
    Busy,
    Done,
    Refused,  ///< the server aborted; `abort_code` says why
    Failed,   ///< this side aborted: no answer in time, or one against the protocol
  };

  explicit SdoClient(std::uint8_t node, Options options);
  explicit SdoClient(std::uint8_t node) : SdoClient(node, Options{}) {}

  /// Begins to read an object, once the transfer before is `finished`. `into` must live until the transfer is over.
  void upload(ObjectAddress object, std::span<std::uint8_t> into, std::chrono::nanoseconds now) noexcept;
  /// Begins to write an object, once the transfer before is `finished`. `data` must live until the transfer is over.
  void download(ObjectAddress object, std::span<const std::uint8_t> data, std::chrono::nanoseconds now) noexcept;

  /// A frame of identifier 580h + node.
  void receive(const CanFrame& frame, std::chrono::nanoseconds now) noexcept;
  /// The next frame to send, if there is one. To be called until there is none, also while nothing is received: this is
  /// where time passes.
  [[nodiscard]] bool next_frame(std::chrono::nanoseconds now, CanFrame& frame) noexcept;

  [[nodiscard]] State state() const noexcept { return state_; }
  /// Over, and all of its frames fetched.
  [[nodiscard]] bool finished() const noexcept { return state_ != State::Busy && !pending_; }
  [[nodiscard]] std::uint32_t abort_code() const noexcept { return abort_code_; }
  /// Bytes read; valid when Done.
  [[nodiscard]] std::size_t size() const noexcept { return moved_; }

 private:
  enum class Phase : std::uint8_t {
    Idle,
    UploadInitiate,
    UploadSegment,
    BlockUploadInitiate,
    BlockUploadData,
    BlockUploadEnd,
    DownloadInitiate,
    DownloadSegment,
    BlockDownloadInitiate,
    BlockDownloadData,
    BlockDownloadAck,
    BlockDownloadEnd,
  };

  void begin(ObjectAddress object, std::chrono::nanoseconds now) noexcept;
  void initiate_upload(bool block) noexcept;
  void initiate_download(bool block) noexcept;
  void take_upload_initiate(const CanFrame& frame) noexcept;
  void take_upload_segment(const CanFrame& frame) noexcept;
  void take_block_upload_initiate(const CanFrame& frame) noexcept;
  void take_block_upload_data(const CanFrame& frame) noexcept;
  void take_block_upload_end(const CanFrame& frame) noexcept;
  void take_download_initiate(const CanFrame& frame) noexcept;
  void take_download_segment(const CanFrame& frame) noexcept;
  void take_block_download_initiate(const CanFrame& frame) noexcept;
  void take_block_download_ack(const CanFrame& frame) noexcept;
  void take_block_download_end(const CanFrame& frame) noexcept;
  void take_abort(const CanFrame& frame) noexcept;

  [[nodiscard]] bool initiating() const noexcept;
  [[nodiscard]] bool answers_object(const CanFrame& frame) const noexcept;
  void send_segment() noexcept;
  void request_segment() noexcept;
  [[nodiscard]] bool store(std::span<const std::uint8_t> bytes) noexcept;
  [[nodiscard]] std::span<const std::uint8_t> rest(std::size_t from) const noexcept;
  void put(std::uint8_t command, bool with_object) noexcept;
  void abort(std::uint32_t code) noexcept;
  void done() noexcept;
  void block_segment(CanFrame& frame) noexcept;

  std::uint8_t node_;
  Options options_;
  State state_ = State::Idle;
  Phase phase_ = Phase::Idle;
  ObjectAddress object_;
  std::span<std::uint8_t> into_;
  std::span<const std::uint8_t> from_;
  std::chrono::nanoseconds deadline_{0};
  std::uint32_t abort_code_ = 0;
  std::size_t moved_ = 0;  ///< bytes that the other side has, or that were stored
  std::uint32_t announced_ = 0;
  bool announces_ = false;
  std::uint8_t toggle_ = 0;

  std::uint8_t block_size_ = 0;
  std::uint8_t sequence_ = 0;  ///< of the last segment sent, or received in order
  std::uint8_t stalls_ = 0;    ///< blocks in a row of which the server took nothing
  bool with_crc_ = false;
  bool last_seen_ = false;
  bool tail_waits_ = false;
  std::array<std::uint8_t, 7> tail_{};  ///< how much of a block's last segment counts is told only at the end

  bool pending_ = false;
  CanFrame out_;
};

}  // namespace rmac::fieldbus::canopen
