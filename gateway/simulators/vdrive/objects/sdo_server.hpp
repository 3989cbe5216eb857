#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "rmac/fieldbus/can/can_port.hpp"
#include "rmac/fieldbus/eds/object_entry.hpp"

namespace rmac::vdrive {

using fieldbus::CanFrame;
using fieldbus::ObjectAddress;
using Bytes = std::vector<std::uint8_t>;

/// What an SDO server reads and writes. Both answer 0 or the abort code that refuses (CiA 301, 7.2.4.3.17, table 22).
class SdoObjects {
 public:
  virtual ~SdoObjects() = default;
  [[nodiscard]] virtual std::uint32_t read(ObjectAddress object, Bytes& bytes) = 0;
  [[nodiscard]] virtual std::uint32_t write(ObjectAddress object, const Bytes& bytes) = 0;
};

/// The server's side of service data objects, written from CiA 301's clauses alone: it shares no protocol code with the
/// master, so that a misreading cannot cancel itself out.
class SdoServer {
 public:
  SdoServer(std::uint8_t node, SdoObjects& objects) : node_(node), objects_(objects) {}

  bool knows_blocks = true;
  bool knows_crc = true;
  bool tells_size = true;
  std::uint8_t block_size = 127;

  /// A frame of identifier 600h + node; what is answered.
  [[nodiscard]] std::vector<CanFrame> receive(const CanFrame& frame);
  /// Forgets a transfer that runs, as a reset does.
  void reset() { mode_ = Mode::None; }

 private:
  enum class Mode { None, Download, Upload, BlockDownload, BlockDownloadEnd, BlockUpload, BlockUploadEnd };

  CanFrame answer(std::uint8_t command) const;
  std::vector<CanFrame> with_object(std::uint8_t command, Bytes rest = {}) const;
  std::vector<CanFrame> abort(std::uint32_t code);
  std::vector<CanFrame> initiate_download(const CanFrame& frame);
  std::vector<CanFrame> download_segment(const CanFrame& frame);
  std::vector<CanFrame> initiate_upload(const CanFrame& frame, bool block);
  std::vector<CanFrame> upload_segment(const CanFrame& frame);
  std::vector<CanFrame> initiate_block_download(const CanFrame& frame);
  std::vector<CanFrame> block_download_segment(const CanFrame& frame);
  std::vector<CanFrame> block_download_end(const CanFrame& frame);
  std::vector<CanFrame> block_upload(const CanFrame& frame);
  std::vector<CanFrame> send_block();
  std::uint32_t commit();

  std::uint8_t node_;
  SdoObjects& objects_;
  Mode mode_ = Mode::None;
  ObjectAddress object_;
  Bytes data_;
  std::size_t position_ = 0;
  std::optional<std::size_t> announced_;
  bool toggle_ = false;
  bool crc_ = false;
  std::uint8_t client_block_ = 0;
  std::uint8_t expected_ = 1;
  std::uint8_t sent_ = 0;
};

}  // namespace rmac::vdrive
