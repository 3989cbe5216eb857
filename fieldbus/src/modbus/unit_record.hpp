#pragma once

#include <map>
#include <mutex>

#include "rmac/fieldbus/modbus/client.hpp"

namespace rmac::fieldbus::modbus {

/// What passed between a client and its units: the client's thread notes it, any but the servo thread reads it.
class UnitRecords {
 public:
  void asked(int unit);
  void ended(int unit, const Answer<>& answer, Clock::time_point now);
  [[nodiscard]] UnitTraffic traffic(int unit, Clock::time_point now) const;

 private:
  struct Entry {
    UnitTraffic traffic;
    Clock::time_point troubled;
  };
  mutable std::mutex mutex_;
  std::map<int, Entry> units_;
};

}  // namespace rmac::fieldbus::modbus
