#include "rmac/fieldbus/eds/type_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "eds/ini.hpp"

namespace rmac::fieldbus::eds {
namespace {

struct Named {
  DataType type;
  const char* name;        ///< CiA 301
  const char* short_name;  ///< CiA 309-3, 5.2
};

constexpr std::array kNames{
    Named{DataType::Boolean, "BOOLEAN", "b"},
    Named{DataType::Integer8, "INTEGER8", "i8"},
    Named{DataType::Integer16, "INTEGER16", "i16"},
    Named{DataType::Integer24, "INTEGER24", "i24"},
    Named{DataType::Integer32, "INTEGER32", "i32"},
    Named{DataType::Integer40, "INTEGER40", "i40"},
    Named{DataType::Integer48, "INTEGER48", "i48"},
    Named{DataType::Integer56, "INTEGER56", "i56"},
    Named{DataType::Integer64, "INTEGER64", "i64"},
    Named{DataType::Unsigned8, "UNSIGNED8", "u8"},
    Named{DataType::Unsigned16, "UNSIGNED16", "u16"},
    Named{DataType::Unsigned24, "UNSIGNED24", "u24"},
    Named{DataType::Unsigned32, "UNSIGNED32", "u32"},
    Named{DataType::Unsigned40, "UNSIGNED40", "u40"},
    Named{DataType::Unsigned48, "UNSIGNED48", "u48"},
    Named{DataType::Unsigned56, "UNSIGNED56", "u56"},
    Named{DataType::Unsigned64, "UNSIGNED64", "u64"},
    Named{DataType::Real32, "REAL32", "r32"},
    Named{DataType::Real64, "REAL64", "r64"},
    Named{DataType::VisibleString, "VISIBLE_STRING", "vs"},
    Named{DataType::OctetString, "OCTET_STRING", "os"},
    Named{DataType::UnicodeString, "UNICODE_STRING", "us"},
    Named{DataType::TimeOfDay, "TIME_OF_DAY", "t"},
    Named{DataType::TimeDifference, "TIME_DIFFERENCE", "td"},
    Named{DataType::Domain, "DOMAIN", "d"},
};

}  // namespace

std::string type_name(DataType type) {
  const auto found =
      std::find_if(kNames.begin(), kNames.end(), [type](const Named& named) { return named.type == type; });
  return found != kNames.end() ? found->name : fmt::format("type {:04X}h", static_cast<unsigned>(type));
}

std::optional<DataType> read_type_name(std::string_view text) {
  const std::string wanted = lower_case(text);
  const auto found = std::find_if(kNames.begin(), kNames.end(), [&](const Named& named) {
    return wanted == named.short_name || wanted == lower_case(named.name);
  });
  return found != kNames.end() ? std::optional(found->type) : std::nullopt;
}

std::string short_type_names() {
  std::string names;
  for (const Named& named : kNames) names += fmt::format("{}{}", names.empty() ? "" : ", ", named.short_name);
  return names;
}

}  // namespace rmac::fieldbus::eds
