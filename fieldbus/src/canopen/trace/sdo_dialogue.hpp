#pragma once

#include <optional>
#include <vector>

#include "rmac/fieldbus/canopen/sdo_step.hpp"

namespace rmac::fieldbus::canopen {

/// What a frame of an SDO dialogue says to who listens.
struct SdoRemark {
  enum class Kind : std::uint8_t {
    Reads,     ///< the client asks for an object
    Writes,    ///< the client gives one a value: `bytes`, or none where they follow in segments
    Goes,      ///< on: a segment, or an acknowledgement
    Read,      ///< the server told all of `bytes`
    Written,   ///< the server took the value: `bytes`
    Aborted,   ///< by either side
    Unheeded,  ///< it belongs to nothing that began while somebody listened, or is no SDO
  };
  Kind kind = Kind::Unheeded;
  std::optional<ObjectAddress> object;
  std::vector<std::uint8_t> bytes;
  std::uint32_t abort_code = 0;
};

/// Follows the transfers between the clients of a bus and one server, from the frames of both: expedited, segmented and
/// by blocks (CiA 301, 7.2.4.3). SdoUpload and SdoDownload conduct a transfer; this one only overhears it, and so it
/// never refuses a frame. Off the cycle.
class SdoDialogue {
 public:
  [[nodiscard]] SdoRemark from_client(const SdoBytes& bytes);
  [[nodiscard]] SdoRemark from_server(const SdoBytes& bytes);

 private:
  enum class Phase : std::uint8_t { Idle, Read, Write, BlockRead, BlockWrite };

  [[nodiscard]] SdoRemark begin(SdoRemark::Kind kind, Phase phase, const SdoBytes& bytes);
  [[nodiscard]] SdoRemark aborted(const SdoBytes& bytes);
  [[nodiscard]] SdoRemark goes_on() const;
  [[nodiscard]] SdoRemark done(SdoRemark::Kind kind);
  [[nodiscard]] SdoRemark take_segment(const SdoBytes& bytes, Phase phase);
  [[nodiscard]] SdoRemark take_block_segment(const SdoBytes& bytes);
  /// The first `segments` of a block were taken; the others come again.
  [[nodiscard]] SdoRemark acknowledge(std::size_t segments);
  void drop_unused(std::size_t bytes);
  void store(const std::uint8_t* bytes, std::size_t count);

  Phase phase_ = Phase::Idle;
  ObjectAddress object_;
  std::vector<std::uint8_t> data_;
  std::vector<std::uint8_t> block_;  ///< what came since the last acknowledgement, in order
  bool last_ = false;                ///< the segment that ends it was seen
  std::uint8_t toggle_ = 0;          ///< of the next segment
  bool streams_ = false;             ///< segments of a block come
};

}  // namespace rmac::fieldbus::canopen
