#include "modbus/unit_record.hpp"

namespace rmac::fieldbus::modbus {

void UnitRecords::asked(int unit) {
  const std::lock_guard lock(mutex_);
  ++units_[unit].traffic.requests;
}

void UnitRecords::ended(int unit, const Answer<>& answer, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  auto& [traffic, troubled] = units_[unit];
  if (answer) {
    ++traffic.answers;
    return;
  }
  traffic.last_trouble = {answer.error().message, 0};
  troubled = now;
  switch (answer.error().kind) {
    case Failure::Kind::Timeout:
      ++traffic.timeouts;
      break;
    case Failure::Kind::WrongAnswer:
      ++traffic.wrong_answers;
      break;
    case Failure::Kind::Exception:
      ++traffic.exceptions[answer.error().exception_code];
      break;
    case Failure::Kind::Disconnected:
      ++traffic.disconnects;
      break;
    case Failure::Kind::BadRequest:
    case Failure::Kind::NotConnected:
    case Failure::Kind::InDoubt:  // nothing was sent
      break;
  }
}

UnitTraffic UnitRecords::traffic(int unit, Clock::time_point now) const {
  const std::lock_guard lock(mutex_);
  const auto known = units_.find(unit);
  if (known == units_.end()) return {};
  UnitTraffic told = known->second.traffic;
  if (told.last_trouble) {
    told.last_trouble->age_s = std::chrono::duration<double>(now - known->second.troubled).count();
  }
  return told;
}

}  // namespace rmac::fieldbus::modbus
