#pragma once

#include <map>

#include "rmac/fieldbus/can/candump_log.hpp"
#include "rmac/fieldbus/canopen/frame_decoder.hpp"

namespace rmac::cli {

/// What of a trace is shown, and how.
struct TraceView {
  bool json = false;
  bool without_cyclic = false;  ///< no SYNC, no PDOs
  int node = 0;                 ///< frames of this one and of all nodes; 0: every frame
};

/// Decodes frames in their order and prints each that is to be seen, a line each.
class TraceOutput {
 public:
  /// `buses` of the machine; none: there is no mapping. They must live as long.
  TraceOutput(const std::vector<fieldbus::canopen::CanopenConfig>& buses, const TraceView& view)
      : buses_(buses), view_(view) {}

  void show(const fieldbus::LoggedFrame& logged);

 private:
  [[nodiscard]] bool hides(const fieldbus::canopen::DecodedFrame& decoded) const;

  const std::vector<fieldbus::canopen::CanopenConfig>& buses_;
  TraceView view_;
  std::map<std::string, fieldbus::canopen::FrameDecoder> decoders_;  ///< by interface
};

}  // namespace rmac::cli
