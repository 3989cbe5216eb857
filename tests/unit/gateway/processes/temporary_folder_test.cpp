#include "gateway/processes/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;

TEST(TemporaryFolder, IsItsOwnersAloneAndEndsWithIt) {
  fs::path path;
  {
    const TemporaryFolder one("test"), other("test");
    path = one.path();
    EXPECT_TRUE(fs::is_directory(path));
    EXPECT_NE(path, other.path());
    EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_all);
  }
  EXPECT_FALSE(fs::exists(path));
}

/// And none is made wherever the daemon happens to stand.
TEST(TemporaryFolder, HasNoPathWhereTheSystemsIsNotThere) {
  ::setenv("TMPDIR", "/nowhere", 1);
  const TemporaryFolder none("test");
  ::unsetenv("TMPDIR");
  EXPECT_EQ(none.path(), fs::path());
}

}  // namespace
}  // namespace rmac::gateway
