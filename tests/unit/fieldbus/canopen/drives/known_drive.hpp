#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>

#include "unit/fieldbus/canopen/canopen_bench.hpp"

namespace rmac::fieldbus::test {

/// Of the virtual drive with node id 1.
inline canopen::DriveDescription description_of(const canopen::DriveManners& manners,
                                                const std::string& file = "etc/drives/maker-drive.json") {
  return {.file = file,
          .name = "maker drive",
          .tried = "never",
          .vendor_id = 0x101,
          .product_code = 0x201,
          .manners = manners,
          .refusal = {}};
}

class KnownDrive : public CanopenBench {
 protected:
  VirtualDrive& fresh_drive() {
    master_.reset();
    wire_ = CanWire();
    VirtualDrive& drive = wire_.add(1);
    drive.on_write = [this](Object object, const Bytes&) { ++writes_[object]; };
    writes_.clear();
    return drive;
  }
  void make_known(const canopen::DriveLibrary& library, const Numbers& numbers, const Texts& texts = {}) {
    auto config = canopen::read_canopen_config("can0", numbers, texts, kPeriodS, {},
                                               std::make_shared<canopen::DriveLibrary>(library));
    ASSERT_TRUE(config.has_value()) << config.error().message;
    make_from(*config);
  }
  void make_known(const canopen::DriveManners& manners, const Numbers& numbers, const Texts& texts = {}) {
    make_known(canopen::DriveLibrary{{description_of(manners)}, {}}, numbers, texts);
  }
  /// How often an object of any sub-index was written.
  [[nodiscard]] int writes(std::uint16_t index) const {
    int count = 0;
    for (const auto& [object, times] : writes_) count += object.index == index ? times : 0;
    return count;
  }

  std::map<Object, int> writes_;
};

}  // namespace rmac::fieldbus::test
