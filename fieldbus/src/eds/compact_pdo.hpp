#pragma once

#include "rmac/fieldbus/eds/device_description.hpp"

namespace rmac::fieldbus::eds {

/// PDOs that a file does not write out (CiA 306-1: CompactPDO, NrOfRXPDO and NrOfTXPDO of [DeviceInfo]).
struct CompactPdos {
  unsigned subs = 0;              ///< bit n: communication parameters have sub-index n + 1; 0: all PDOs are written out
  unsigned rpdos = 0, tpdos = 0;  ///< how many there are, with those that are written out
  std::size_t line = 0;           ///< of CompactPDO
};

constexpr unsigned kMostPdos = 512;  ///< each way (CiA 301, 7.5.2.35)

/// Adds communication and mapping parameters of the PDOs that are not written out: the first numbers that are free.
void add_compact_pdos(const CompactPdos& pdos, std::map<ObjectAddress, ObjectEntry>& entries);

}  // namespace rmac::fieldbus::eds
