#pragma once

#include <algorithm>
#include <functional>
#include <map>

#include "gateway/simulators/vdrive/objects/sdo_server.hpp"

namespace rmac::fieldbus::test {

using vdrive::Bytes;
using Object = ObjectAddress;
using ObjectDictionary = std::map<Object, Bytes>;

/// Objects that anyone may read and write.
class ObjectBank final : public vdrive::SdoObjects {
 public:
  /// Called before a write takes effect; anything but 0 is the abort code that refuses it.
  using WriteCheck = std::function<std::uint32_t(Object, const Bytes&)>;

  explicit ObjectBank(ObjectDictionary& dictionary) : dictionary_(dictionary) {}
  WriteCheck write_check;
  std::map<Object, std::uint32_t> unreadable, unwritable;  ///< by abort code

  std::uint32_t read(Object object, Bytes& bytes) override {
    if (const auto refused = unreadable.find(object); refused != unreadable.end()) return refused->second;
    const auto entry = dictionary_.find(object);
    if (entry == dictionary_.end()) return absent(object);
    bytes = entry->second;
    return 0;
  }
  std::uint32_t write(Object object, const Bytes& bytes) override {
    if (const auto refused = unwritable.find(object); refused != unwritable.end()) return refused->second;
    const auto entry = dictionary_.find(object);
    if (entry == dictionary_.end()) return absent(object);
    if (write_check) {
      if (const std::uint32_t code = write_check(object, bytes); code != 0) return code;
    }
    entry->second = bytes;
    return 0;
  }

 private:
  [[nodiscard]] std::uint32_t absent(Object object) const {
    const bool known = std::any_of(dictionary_.begin(), dictionary_.end(),
                                   [&](const auto& entry) { return entry.first.index == object.index; });
    return known ? 0x06090011 : 0x06020000;
  }
  ObjectDictionary& dictionary_;
};

}  // namespace rmac::fieldbus::test
