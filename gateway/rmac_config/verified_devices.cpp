#include "gateway/rmac_config/verified_devices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gateway/rmac_config/verified_bounds.hpp"

namespace rmac::gateway {
namespace {

tl::unexpected<Error> refused(const Error& why, const std::string& what_to_do) {
  return failure(why.code, fmt::format("{}. {}", why.message, what_to_do));
}

}  // namespace

void VerifiedDevices::begin(const sdk::DeviceObject& database) {
  const std::lock_guard hold(mutex_);
  verified_.assign(1, database);
}

void VerifiedDevices::add(sdk::DeviceObject draft) {
  constexpr std::size_t kKept = 8;  // the database, and the last drafts
  const std::lock_guard hold(mutex_);
  if (verified_.empty() || verified_.front().name != draft.name) return;
  verified_.push_back(std::move(draft));
  if (verified_.size() > kKept) verified_.erase(verified_.begin() + 1);
}

Expected<> VerifiedDevices::admit(const sdk::DeviceObject& wanted) const {
  const std::lock_guard hold(mutex_);
  if (verified_.empty()) return {};
  const sdk::DeviceObject& database = verified_.front();
  if (auto fits = check_within_database(wanted, database); !fits) {
    return refused(fits.error(), fmt::format("What the joints of {} can is for its device.json to say: change that "
                                             "file, have it verified (Device.Verify) and load it anew (Device.Load)",
                                             database.machine()));
  }
  const auto holds = [&](const sdk::DeviceObject& verified) {
    return check_within_verified(wanted, verified).has_value();
  };
  if (std::ranges::any_of(verified_, holds)) return {};
  return refused(check_within_verified(wanted, database).error(),
                 "RMAC_Config.Apply and Device.Machine_ConfigureMotionPlanner have what is wanted verified before they "
                 "put it in force; it changed meanwhile: ask again");
}

bool VerifiedDevices::lacks_verification(const sdk::DeviceObject& wanted) const {
  if (admit(wanted)) return false;
  const std::lock_guard hold(mutex_);
  return check_within_database(wanted, verified_.front()).has_value();
}

}  // namespace rmac::gateway
