#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "rmac/fieldbus/can/can_port.hpp"

namespace rmac::fieldbus::test {

using Bytes = std::vector<std::uint8_t>;
using Object = std::pair<std::uint16_t, std::uint8_t>;
using ObjectDictionary = std::map<Object, Bytes>;

/// The server's side of service data objects, written from CiA 301's clauses alone: it shares no protocol code with the
/// master, so that a misreading cannot cancel itself out.
class SdoServer {
 public:
  /// Called before a write takes effect; anything but 0 is the abort code that refuses it.
  using WriteCheck = std::function<std::uint32_t(Object, const Bytes&)>;

  SdoServer(std::uint8_t node, ObjectDictionary& dictionary) : node_(node), dictionary_(dictionary) {}

  bool knows_blocks = true;
  bool knows_crc = true;
  bool tells_size = true;
  std::uint8_t block_size = 127;
  WriteCheck write_check;

  /// A frame of identifier 600h + node; what is answered.
  [[nodiscard]] std::vector<CanFrame> receive(const CanFrame& frame);

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
  ObjectDictionary& dictionary_;
  Mode mode_ = Mode::None;
  Object object_;
  Bytes data_;
  std::size_t position_ = 0;
  std::optional<std::size_t> announced_;
  bool toggle_ = false;
  bool crc_ = false;
  std::uint8_t client_block_ = 0;
  std::uint8_t expected_ = 1;
  std::uint8_t sent_ = 0;
};

}  // namespace rmac::fieldbus::test
