#pragma once

#include <map>

#include "rmac/fieldbus/canopen/frame_decoder.hpp"

namespace rmac::fieldbus::canopen {

/// What the PDOs of a bus hold, by their identifiers.
class PdoTable {
 public:
  explicit PdoTable(const CanopenConfig* config);

  /// Takes apart a frame of a PDO's identifier (181h to 57Fh).
  [[nodiscard]] DecodedFrame decode(const CanFrame& frame) const;

 private:
  struct Content {
    ObjectAddress object;  ///< of its axis
    std::uint8_t bits = 0;
    std::shared_ptr<const eds::DeviceDescription> sheet;
  };
  /// One axis's view of a frame: axes that share an RPDO have each their own.
  using Contents = std::vector<Content>;

  void add(const AxisConfig& axis, std::uint16_t id, const std::vector<MappedObject>& mapped);

  std::map<std::uint16_t, std::vector<Contents>> contents_;
};

}  // namespace rmac::fieldbus::canopen
