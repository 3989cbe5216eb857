#include "gateway/buses/drive_library_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "gateway/json/json_document.hpp"
#include "gateway/json/schemas.hpp"

namespace rmac::gateway {
namespace {

using fieldbus::canopen::DriveDescription;
using fieldbus::canopen::DriveLibrary;
using fieldbus::canopen::DriveManners;
using fieldbus::canopen::InterpolationTimes;
using fieldbus::canopen::SkippedObject;
using Json = nlohmann::json;

/// What the schema lets pass as a number; nothing of anything else.
std::optional<std::uint32_t> number_at(const Json& document, const char* key) {
  constexpr std::uint64_t kMost = 0xFFFFFFFF;
  constexpr std::size_t kMostDigits = 9;
  if (!document.is_object() || !document.contains(key)) return {};
  const Json& value = document[key];
  if (value.is_number_unsigned() && value.get<std::uint64_t>() <= kMost) return value.get<std::uint32_t>();
  if (!value.is_string()) return {};
  const auto text = value.get<std::string>();
  const bool form = text.size() > 1 && text.size() <= kMostDigits && text.back() == 'h' &&
                    text.find_first_not_of("0123456789ABCDEFabcdef") == text.size() - 1;
  if (!form) return {};
  return static_cast<std::uint32_t>(std::stoul(text, nullptr, 16));
}

std::chrono::milliseconds milliseconds(const Json& seconds) {
  constexpr double kPerSecond = 1e3;
  return std::chrono::milliseconds(std::llround(seconds.get<double>() * kPerSecond));
}

/// "60C2h", "60C2h:02"
SkippedObject skipped(const std::string& text) {
  constexpr std::size_t kDigits = 4, kSubAt = 6;
  SkippedObject object{static_cast<std::uint16_t>(std::stoul(text.substr(0, kDigits), nullptr, 16)), {}};
  if (text.size() > kSubAt) object.sub = static_cast<std::uint8_t>(std::stoul(text.substr(kSubAt), nullptr, 16));
  return object;
}

DriveManners manners(const Json& document) {
  DriveManners read;
  for (const Json& object : document.value("Skip", Json::array())) read.skip.push_back(skipped(object));
  if (document.contains("SdoTimeout")) read.sdo_timeout = milliseconds(document["SdoTimeout"]);
  if (document.contains("SdoRetries")) read.sdo_retries = document["SdoRetries"].get<int>();
  if (document.contains("BootTimeout")) read.boot_timeout = milliseconds(document["BootTimeout"]);
  read.fixed_mapping = document.value("FixedMapping", false);
  read.store_after_mapping = document.value("StoreAfterMapping", false);
  read.no_abort_connection = document.value("NoAbortConnection", false);
  read.node_guarding = document.value("NodeGuarding", false);
  read.quick_stop_inverted = document.value("QuickStopInverted", false);
  read.homing_without_target_reached = document.value("HomingWithoutTargetReached", false);
  read.answer_delay = document.value("AnswerDelay", 1);
  read.no_heartbeat_consumer = document.value("NoHeartbeatConsumer", std::string());
  if (document.contains("InterpolationTimePeriod")) {
    const Json& times = document["InterpolationTimePeriod"];
    read.interpolation = InterpolationTimes{times["Index"], times.value("Values", std::vector<std::uint8_t>())};
  }
  return read;
}

/// The rest of a description whose identity is known; the error names key and reason.
Expected<> read_rest(const Json& document, DriveDescription& drive) {
  static const JsonSchema kSchema(drive_schema_text());
  if (const std::string problems = kSchema.check(document); !problems.empty()) {
    return failure(MinorCode::InvalidParameterValue, problems);
  }
  drive.name = document["Name"];
  drive.tried = document["Tried"];
  drive.manners = manners(document);
  if (drive.first_revision > drive.last_revision) {
    return failure(MinorCode::InvalidParameterValue, "/RevisionNumber has its Min above its Max");
  }
  if (drive.vendor_id == 0 && drive.product_code == 0) {
    return failure(MinorCode::InvalidParameterValue, "/VendorId and /ProductCode are 0, which no drive tells");
  }
  const Json pages = document.value("Pages", Json::object());
  for (const auto& [key, page] : pages.items()) {
    if (!document.contains(key)) {
      return failure(MinorCode::InvalidParameterValue, fmt::format("/Pages/{} is of a key that is not given", key));
    }
  }
  return check(drive.manners);
}

void read_file(const std::filesystem::path& file, DriveLibrary& library) {
  static const JsonSchema kAnything("{}");
  const auto document = read_json_document(file, kAnything);
  if (!document) {
    library.unreadable.push_back(document.error().message);
    return;
  }
  DriveDescription drive;
  drive.file = file.string();
  const auto vendor = number_at(*document, "VendorId"), product = number_at(*document, "ProductCode");
  drive.vendor_id = vendor.value_or(0);
  drive.product_code = product.value_or(0);
  if (document->is_object() && document->contains("RevisionNumber")) {
    drive.first_revision = number_at((*document)["RevisionNumber"], "Min").value_or(drive.first_revision);
    drive.last_revision = number_at((*document)["RevisionNumber"], "Max").value_or(drive.last_revision);
  }
  if (auto sound = read_rest(*document, drive); !sound) {
    drive.refusal = fmt::format("{}: {}", drive.file, sound.error().message);
    if (!vendor || !product) {
      library.unreadable.push_back(drive.refusal);
      return;
    }
  }
  library.drives.push_back(std::move(drive));
}

}  // namespace

DriveLibrary read_drive_library(const std::filesystem::path& folder) {
  DriveLibrary library;
  if (folder.empty()) return library;
  std::error_code code;
  std::set<std::filesystem::path> files;
  for (std::filesystem::directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    if (at->path().extension() == ".json") files.insert(at->path());
  }
  if (code) {
    library.unreadable.push_back(fmt::format("{}: no drive is known: {}", folder.string(), code.message()));
  }
  for (const std::filesystem::path& file : files) read_file(file, library);
  library.refuse_doubles();
  return library;
}

Expected<> check(const DriveLibrary& library) {
  std::set<std::string> problems(library.unreadable.begin(), library.unreadable.end());
  for (const DriveDescription& drive : library.drives) {
    if (!drive.refusal.empty()) problems.insert(drive.refusal);
  }
  if (problems.empty()) return {};
  std::string text;
  for (const std::string& problem : problems) text += (text.empty() ? "" : "; ") + problem;
  return failure(MinorCode::InvalidParameterValue, text);
}

}  // namespace rmac::gateway
