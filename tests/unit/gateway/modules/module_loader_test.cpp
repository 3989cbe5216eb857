#include "gateway/modules/module_loader.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "places.hpp"
#include "rmac/motion/ports/actuator_map.hpp"
#include "rmac/motion/ports/kinematics.hpp"
#include "rmac/motion/ports/servo_law.hpp"

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path kModules = fs::path(RMAC_BINARY_DIR) / "test_modules";

/// A folder that holds what a test puts into it.
class ModuleFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("rmac-test-" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) +
               std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

std::string error_of(const std::string& folder, const std::string& name) {
  const auto made = ModuleLoader({kModules / folder}).load<ServoLaw>({name, {}, {}});
  return made ? "it was loaded" : made.error().message;
}

TEST_F(ModuleFolder, GivesTheRebuiltModuleWhileTheOldOneIsInUse) {
  const fs::path file = folder_ / "TestKinematics3.so";
  const ModuleLoader loader({folder_});
  fs::copy_file(kModules / "good" / "TestKinematics3.so", file);
  const auto old = loader.load<Kinematics>({"TestKinematics3", {}, {}});
  ASSERT_TRUE(old) << old.error().message;
  fs::copy_file(kModules / "rebuilt" / "TestKinematics3.so", file, fs::copy_options::overwrite_existing);
  const auto rebuilt = loader.load<Kinematics>({"TestKinematics3", {}, {}});
  ASSERT_TRUE(rebuilt) << rebuilt.error().message;

  EXPECT_EQ(old->build_id, "one");
  EXPECT_EQ(rebuilt->build_id, "two");
  const std::array<double, 3> joints{1, 2, 3};
  ToolPose pose;
  old->object->forward(joints, {}, pose);
  EXPECT_DOUBLE_EQ(pose.tip[0], 1);
  rebuilt->object->forward(joints, {}, pose);
  EXPECT_DOUBLE_EQ(pose.tip[0], 2);
}

TEST_F(ModuleFolder, LooksIntoTheFirstFolderFirst) {
  const auto made =
      ModuleLoader({kModules / "rebuilt", kModules / "good"}).load<Kinematics>({"TestKinematics3", {}, {}});
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->build_id, "two");
}

TEST_F(ModuleFolder, RefusesAHalfCopiedModule) {
  const fs::path whole = kModules / "good" / "TestKinematics3.so", file = folder_ / "TestKinematics3.so";
  for (const double part : {0.1, 0.3, 0.6, 0.99}) {
    fs::copy_file(whole, file, fs::copy_options::overwrite_existing);
    fs::resize_file(file, static_cast<std::uintmax_t>(static_cast<double>(fs::file_size(whole)) * part));
    const auto made = ModuleLoader({folder_}).load<Kinematics>({"TestKinematics3", {}, {}});
    ASSERT_FALSE(made) << part;
    EXPECT_THAT(made.error().message, HasSubstr("is not a whole shared object")) << part;
  }
}

/// Why the kinematics in a folder are not opened.
std::string distrust(const fs::path& folder, ModuleLoader::Opens opens = ModuleLoader::Opens::Trusted) {
  const auto made = ModuleLoader({folder}, opens).load<Kinematics>({"TestKinematics3", {}, {}});
  return made ? "it was loaded" : made.error().message;
}

TEST_F(ModuleFolder, IsTrustedWhereNobodyElseMayWrite) {
  const fs::path inner = folder_ / "a" / "b", file = inner / "TestKinematics3.so";
  fs::create_directories(inner);
  fs::copy_file(kModules / "good" / "TestKinematics3.so", file);
  EXPECT_EQ(distrust(inner), "it was loaded");
  for (const fs::path& place : {file, inner, folder_ / "a"}) {
    for (const auto writers : {fs::perms::others_write, fs::perms::others_write | fs::perms::group_write}) {
      fs::permissions(place, writers, fs::perm_options::add);
      EXPECT_THAT(distrust(inner), HasSubstr(place.string() + " (mode")) << place;
      EXPECT_THAT(distrust(inner), HasSubstr("chmod go-w")) << place;
      EXPECT_EQ(distrust(inner, ModuleLoader::Opens::Whichever), "it was loaded") << place;
      fs::permissions(place, writers, fs::perm_options::remove);
    }
  }
  if (::geteuid() != 0) return;  // nobody else gives files away
  constexpr uid_t kStranger = 54321;
  for (const fs::path& place : {file, inner}) {
    ASSERT_EQ(::chown(place.c_str(), kStranger, 0), 0);
    EXPECT_THAT(distrust(inner), HasSubstr(place.string() + " belongs to 54321")) << place;
    ASSERT_EQ(::chown(place.c_str(), 0, 0), 0);
  }
  EXPECT_EQ(distrust(inner), "it was loaded");
}

TEST_F(ModuleFolder, TakesNoLinkThatLeadsOutOfTheFolders) {
  const fs::path shared = folder_ / "shared", mechanism = folder_ / "mechanism";
  fs::create_directories(shared);
  fs::create_directories(mechanism);
  fs::copy_file(kModules / "good" / "TestKinematics3.so", shared / "TestKinematics3.so");
  fs::create_symlink(shared / "TestKinematics3.so", mechanism / "TestKinematics3.so");
  EXPECT_THAT(distrust(mechanism), HasSubstr("it is a link to " + fs::canonical(shared).string()));
  const auto made = ModuleLoader({mechanism, shared}).load<Kinematics>({"TestKinematics3", {}, {}});
  EXPECT_TRUE(made) << made.error().message;
}

TEST_F(ModuleFolder, LeavesNoCopyBehind) {
  ::setenv("TMPDIR", folder_.c_str(), 1);
  const auto made = ModuleLoader({kModules / "good"}).load<ServoLaw>({"TestLaw", {}, {}});
  ::unsetenv("TMPDIR");
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST(ModuleLoader, NamesTheFoldersSearchedWhenAModuleIsMissing) {
  const auto made = ModuleLoader({"/one", "/two"}).load<Kinematics>({"Nowhere", {}, {}});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().message, "there is no kinematics module Nowhere: no file Nowhere.so in /one, /two");
}

TEST(ModuleLoader, RefusesANameThatIsAPath) {
  EXPECT_THAT(error_of("good", "../good/TestLaw"), HasSubstr("cannot be the name of a servo control law module"));
}

TEST(ModuleLoader, NamesBothVersionsWhenTheAbiDiffers) {
  EXPECT_THAT(error_of("bad", "WrongAbi"),
              HasSubstr("built for module ABI 999 and this controller has ABI " + std::to_string(sdk::kModuleAbi)));
}

TEST(ModuleLoader, RefusesAModuleOfAnotherKind) {
  EXPECT_THAT(error_of("good", "TestKinematics3"), HasSubstr("of kind kinematics, but servo control law is wanted"));
}

TEST(ModuleLoader, RefusesAModuleOfAnotherName) {
  EXPECT_THAT(error_of("bad", "WrongName"), HasSubstr("it calls itself \"Otherwise\""));
}

TEST(ModuleLoader, RefusesALibraryWithoutADescriptor) {
  EXPECT_THAT(error_of("bad", "NoSymbol"), HasSubstr("does not export rmac_module()"));
}

TEST_F(ModuleFolder, RefusesAFileThatIsNoLibrary) {
  { std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen((folder_ / "Text.so").c_str(), "w"), std::fclose); }
  const auto made = ModuleLoader({folder_}).load<ServoLaw>({"Text", {}, {}});
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error().message, HasSubstr("cannot load module " + (folder_ / "Text.so").string()));
}

TEST(ModuleLoader, HandsOnWhyAModuleRefusesItsParameters) {
  const auto made = ModuleLoader({kModules / "good"}).load<ActuatorMap>({"TestMap", {{"joints", {0}}}, {}});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().message, "module TestMap refuses its parameters: joints must be 1 or more");
}

}  // namespace
}  // namespace rmac::gateway
