#include "gateway/verification/verification.hpp"

#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;

TEST(VerificationOfADraft, IsRefusedWhereThereIsNoRoomForIt) {
  const Verification verification({.program = "/nowhere/rmac-verify", .verdicts = {}, .module_folders = {}});
  sdk::DeviceObject draft;
  draft.name = "Drafted";
  ::setenv("TMPDIR", "/nowhere", 1);
  const auto required = verification.require(draft, "/nowhere/mill");
  ::unsetenv("TMPDIR");
  ASSERT_FALSE(required);
  EXPECT_THAT(required.error().message, testing::HasSubstr("$TMPDIR"));
  EXPECT_FALSE(fs::exists("device.json")) << "written wherever the daemon stands";
}

}  // namespace
}  // namespace rmac::gateway
