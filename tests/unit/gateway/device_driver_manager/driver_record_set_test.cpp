#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gateway/device_driver_manager/device_driver_manager.hpp"
#include "unit/gateway/device_driver_manager/fixtures.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class DriverRecordSetTest : public testing::Test {
 protected:
  DriverRecordSetTest() {
    write_tree(folder_, test::table_4_1());
    auto opened = DeviceDriverManager::open({.device_tree = folder_.path() / "tree",
                                             .database = (folder_.path() / "drivers.sqlite").string(),
                                             .searcher = test::kSearcher});
    if (!opened) throw std::runtime_error(opened.error().message);
    manager_ = std::move(*opened);
  }

  const test::TemporaryFolder folder_;
  std::unique_ptr<DeviceDriverManager> manager_;
};

TEST_F(DriverRecordSetTest, IsClosedAtFirst) {
  DriverRecordSet set(*manager_);
  EXPECT_FALSE(set.is_open());
  EXPECT_THAT(set.total().error().message, HasSubstr("OpenDeviceDriverDatabase"));
  EXPECT_FALSE(set.current());
  EXPECT_FALSE(set.search("SELECT * FROM DeviceDrivers"));
  EXPECT_FALSE(set.next());
}

TEST_F(DriverRecordSetTest, OpensOnTheFirstOfAllRecords) {
  DriverRecordSet set(*manager_);
  ASSERT_TRUE(set.open());
  EXPECT_TRUE(set.is_open());
  EXPECT_EQ(set.total().value(), 6);
  EXPECT_EQ(set.current().value().name, "DMACXYZ");
}

TEST_F(DriverRecordSetTest, CursorStaysAtTheEndsWithAnError) {
  DriverRecordSet set(*manager_);
  ASSERT_TRUE(set.open());
  EXPECT_THAT(set.previous().error().message, HasSubstr("DMACXYZ is the first record already"));
  EXPECT_EQ(set.current().value().name, "DMACXYZ");
  ASSERT_TRUE(set.next());
  EXPECT_EQ(set.current().value().name, "TarusXYZCA");
  ASSERT_TRUE(set.last());
  EXPECT_EQ(set.current().value().name, "DMACXY");
  EXPECT_THAT(set.next().error().message, HasSubstr("DMACXY is the last record already"));
  EXPECT_EQ(set.current().value().name, "DMACXY");
  ASSERT_TRUE(set.previous());
  EXPECT_EQ(set.current().value().name, "CMM");
  ASSERT_TRUE(set.first());
  EXPECT_EQ(set.current().value().name, "DMACXYZ");
}

TEST_F(DriverRecordSetTest, SearchReplacesTheRowsAndAFailedOneKeepsThem) {
  DriverRecordSet set(*manager_);
  ASSERT_TRUE(set.open());
  EXPECT_EQ(set.search("SELECT * FROM DeviceDrivers WHERE NumberOfJoints = 5").value(), 2);
  EXPECT_EQ(set.total().value(), 2);
  EXPECT_EQ(set.current().value().name, "TarusXYZCA");
  ASSERT_TRUE(set.next());
  EXPECT_FALSE(set.search("DROP TABLE DeviceDrivers"));
  EXPECT_EQ(set.total().value(), 2);
  EXPECT_EQ(set.current().value().name, "SuginoXYZAC");
}

TEST_F(DriverRecordSetTest, AnEmptyResultHasNoCurrentRecord) {
  DriverRecordSet set(*manager_);
  ASSERT_TRUE(set.open());
  EXPECT_EQ(set.search("SELECT * FROM DeviceDrivers WHERE Length > 1000000").value(), 0);
  EXPECT_EQ(set.total().value(), 0);
  EXPECT_THAT(set.current().error().message, HasSubstr("the record set is empty"));
  EXPECT_FALSE(set.first());
  EXPECT_FALSE(set.last());
}

TEST_F(DriverRecordSetTest, EachConnectionHasItsOwnCursor) {
  DriverRecordSet one(*manager_);
  DriverRecordSet other(*manager_);
  ASSERT_TRUE(one.open());
  ASSERT_TRUE(other.open());
  ASSERT_TRUE(one.last());
  other.close();
  EXPECT_EQ(one.current().value().name, "DMACXY");
  EXPECT_FALSE(other.is_open());
}

}  // namespace
}  // namespace rmac::gateway
