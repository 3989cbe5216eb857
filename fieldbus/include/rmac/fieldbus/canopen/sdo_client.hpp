#pragma once

#include <chrono>
#include <cstdint>
#include <span>

#include "rmac/fieldbus/can/can_port.hpp"
#include "rmac/fieldbus/canopen/sdo_download.hpp"
#include "rmac/fieldbus/canopen/sdo_upload.hpp"

namespace rmac::fieldbus::canopen {

/// The client's side of service data objects with one node (CiA 301, 7.2.4.3): expedited, segmented and block
/// transfers, both ways. Frames go in, frames come out, without clock or socket: it keeps the time of answers and the
/// aborts, while SdoUpload and SdoDownload know the steps. One transfer at a time. Real-time safe.
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

  /// For each answer of the transfers that are begun from now on.
  void set_timeout(std::chrono::nanoseconds timeout) noexcept { timeout_ = timeout; }

  /// Forgets the transfer that runs, if one does, and tells the server nothing.
  void abandon() noexcept {
    state_ = State::Idle;
    pending_ = false;
  }

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
  [[nodiscard]] std::size_t size() const noexcept { return upload_.size(); }

 private:
  void begin(ObjectAddress object, std::chrono::nanoseconds now) noexcept;
  void act(const SdoStep& step) noexcept;
  void take_abort(const CanFrame& frame) noexcept;
  [[nodiscard]] bool answers_object(const CanFrame& frame) const noexcept;
  [[nodiscard]] bool initiating() const noexcept;
  [[nodiscard]] bool tries_blocks() const noexcept;
  [[nodiscard]] CanFrame frame_of(const SdoBytes& bytes) const noexcept;
  void send(const SdoBytes& bytes) noexcept;
  void abort(std::uint32_t code) noexcept;

  std::uint8_t node_;
  std::chrono::nanoseconds timeout_;
  SdoUpload upload_;
  SdoDownload download_;
  bool uploads_ = false;  ///< which of the two runs, or ran last
  State state_ = State::Idle;
  ObjectAddress object_;
  std::chrono::nanoseconds deadline_{0};
  std::uint32_t abort_code_ = 0;
  bool pending_ = false;  ///< `out_` is to be fetched
  CanFrame out_;
};

}  // namespace rmac::fieldbus::canopen
