#include "canopen/object_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <sstream>
#include <string_view>

#include "canopen/pdo.hpp"

namespace rmac::fieldbus::canopen {
namespace {

constexpr std::size_t kPdoBytes = 8;

template <typename Number>
bool read_number(std::string_view text, int base, Number& number) {
  if (base == 10 && text.starts_with("0x")) {
    text.remove_prefix(2);
    base = 16;
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

/// "6040:00/16"
std::optional<MappedObject> read_object(std::string_view text) {
  const std::size_t colon = text.find(':');
  const std::size_t slash = text.find('/');
  if (colon == std::string_view::npos || slash == std::string_view::npos || slash < colon) return {};
  MappedObject object;
  if (!read_number(text.substr(0, colon), 16, object.object.index) ||
      !read_number(text.substr(colon + 1, slash - colon - 1), 16, object.object.sub) ||
      !read_number(text.substr(slash + 1), 10, object.bits)) {
    return {};
  }
  const bool whole_bytes = object.bits % 8 == 0 && object.bits >= 8 && object.bits <= 32;
  return whole_bytes ? std::optional(object) : std::nullopt;
}

/// The length that an object of the master's own has; 0 for any other.
template <typename Words>
std::uint8_t length_of(const Words& words, ObjectAddress object) {
  const auto found = std::find_if(words.begin(), words.end(), [&](const auto& word) { return word.object == object; });
  return found == words.end() ? std::uint8_t{0} : found->bits;
}

template <typename Words>
Expected<> check_words(const std::vector<MappedObject>& objects, const Words& words, ObjectAddress needed,
                       bool foreign_allowed) {
  bool found = false;
  for (auto at = objects.begin(); at != objects.end(); ++at) {
    const MappedObject& object = *at;
    found = found || object.object == needed;
    const bool dummy = object.object.index < kFirstObject;
    const auto same = [&](const MappedObject& other) { return other.object == object.object; };
    if (!dummy && std::any_of(objects.begin(), at, same)) {
      return failure(MinorCode::InvalidParameterValue, fmt::format("{} is mapped twice", to_string(object.object)));
    }
    const std::uint8_t bits = length_of(words, object.object);
    if (bits == 0 && !foreign_allowed) {
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("{} has no value that the master could send", to_string(object.object)));
    }
    if (bits != 0 && bits != object.bits) {
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("{} has {} bits, not {}", to_string(object.object), bits, object.bits));
    }
  }
  if (!found) return failure(MinorCode::InvalidParameterValue, to_string(needed) + " is missing");
  return {};
}

}  // namespace

Expected<std::vector<MappedObject>> read_mapping(const std::string& text) {
  std::vector<MappedObject> objects;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto object = read_object(word);
    if (!object) {
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("\"{}\" is no object; write index:sub/bits, whole bytes of 32 bits at most, for "
                                 "example 6040:00/16",
                                 word));
    }
    objects.push_back(*object);
  }
  if (const std::size_t bytes = mapped_bytes(objects); bytes > kPdoBytes) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{} bytes are mapped; a PDO holds {}", bytes, kPdoBytes));
  }
  return objects;
}

Expected<std::vector<SdoWrite>> read_setup(const std::string& text) {
  std::vector<SdoWrite> writes;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    const auto object = read_object(std::string_view(word).substr(0, equals));
    std::int64_t value = 0;
    const bool number =
        equals != std::string::npos && read_number(std::string_view(word).substr(equals + 1), 10, value);
    const std::int64_t bound = object ? std::int64_t{1} << object->bits : 0;
    if (!object || !number || value < -bound / 2 || value >= bound) {
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("\"{}\" is no value to write; write index:sub/bits=value, the value fitting the bits, "
                                 "for example 6085:00/32=100000",
                                 word));
    }
    SdoWrite write{object->object, std::vector<std::uint8_t>(object->bits / 8)};
    for (std::size_t i = 0; i < write.bytes.size(); ++i) write.bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
    writes.push_back(std::move(write));
  }
  return writes;
}

Expected<> check_setpoints(const std::vector<MappedObject>& objects) {
  return check_words(objects, kSetpointWords, {0x6040, 0}, false);
}

Expected<> check_answers(const std::vector<MappedObject>& objects) {
  return check_words(objects, kAnswerWords, {0x6041, 0}, true);
}

std::vector<MappedObject> together(std::vector<MappedObject> objects, const std::vector<MappedObject>& more) {
  objects.insert(objects.end(), more.begin(), more.end());
  return objects;
}

}  // namespace rmac::fieldbus::canopen
