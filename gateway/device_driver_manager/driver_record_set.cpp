#include <fmt/format.h>

#include "gateway/device_driver_manager/device_driver_manager.hpp"

namespace rmac::gateway {
namespace {

tl::unexpected<Error> closed() {
  return failure(MinorCode::UnsupportedOperation,
                 "the device driver database is not open; call OpenDeviceDriverDatabase first");
}

}  // namespace

Expected<> DriverRecordSet::open() {
  Expected<std::vector<DriverRecord>> rows = manager_.all();
  if (!rows) return tl::make_unexpected(rows.error());
  rows_ = std::move(*rows);
  cursor_ = 0;
  open_ = true;
  return {};
}

void DriverRecordSet::close() noexcept {
  rows_.clear();
  cursor_ = 0;
  open_ = false;
}

Expected<int> DriverRecordSet::total() const {
  if (!open_) return closed();
  return static_cast<int>(rows_.size());
}

Expected<int> DriverRecordSet::search(const std::string& sql) {
  if (!open_) return closed();
  Expected<std::vector<DriverRecord>> rows = manager_.search(sql);
  if (!rows) return tl::make_unexpected(rows.error());
  rows_ = std::move(*rows);
  cursor_ = 0;
  return static_cast<int>(rows_.size());
}

Expected<DriverRecord> DriverRecordSet::current() const {
  if (!open_) return closed();
  if (rows_.empty()) {
    return failure(MinorCode::UnsupportedOperation,
                   "the record set is empty; search for something else, or open the database again for all records");
  }
  return rows_[cursor_];
}

Expected<> DriverRecordSet::first() {
  return current().map([this](const DriverRecord&) { cursor_ = 0; });
}

Expected<> DriverRecordSet::last() {
  return current().map([this](const DriverRecord&) { cursor_ = rows_.size() - 1; });
}

Expected<> DriverRecordSet::next() {
  return current().and_then([this](const DriverRecord& record) -> Expected<> {
    if (cursor_ + 1 == rows_.size()) {
      return failure(MinorCode::InvalidParameter, fmt::format("{} is the last record already", record.name));
    }
    ++cursor_;
    return {};
  });
}

Expected<> DriverRecordSet::previous() {
  return current().and_then([this](const DriverRecord& record) -> Expected<> {
    if (cursor_ == 0) {
      return failure(MinorCode::InvalidParameter, fmt::format("{} is the first record already", record.name));
    }
    --cursor_;
    return {};
  });
}

}  // namespace rmac::gateway
