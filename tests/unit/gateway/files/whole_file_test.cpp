#include "gateway/files/whole_file.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <fstream>
#include <iterator>
#include <random>

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class Whole : public testing::Test {
 protected:
  Whole() {
    std::string name = (fs::temp_directory_path() / "rmac-whole-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    file_ = folder_ / "out.csv";
  }
  ~Whole() override { fs::remove_all(folder_); }

  static std::string text_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder_)) found.push_back(entry.path().filename().string());
    return found;
  }
  static std::string many() { return std::string(300'000, 'x'); }

  fs::path folder_, file_;
};

TEST_F(Whole, FilesHaveWhatWasWrittenHoweverItCame) {
  std::mt19937 random(5);
  for (int round = 0; round < 20; ++round) {
    WholeFile out(file_);
    std::string all;
    for (int piece = 0; piece < 30; ++piece) {
      const std::string bytes(random() % 20'000, static_cast<char>(random()));
      out.write(bytes);
      all += bytes;
    }
    ASSERT_TRUE(out.finish());
    EXPECT_EQ(text_of(file_), all);
    EXPECT_THAT(names(), ElementsAre("out.csv"));
  }
}

TEST_F(Whole, FilesAreWhatTheyWereUntilTheyAreFinished) {
  for (const bool finished : {false, true}) {
    ASSERT_TRUE(write_whole(file_, "old"));
    {
      WholeFile out(file_);
      out.write(many());
      EXPECT_EQ(text_of(file_), "old");
      if (finished) {
        EXPECT_TRUE(out.finish());
      }
    }
    EXPECT_EQ(text_of(file_), finished ? many() : "old");
    EXPECT_THAT(names(), ElementsAre("out.csv")) << "nothing else is left";
  }
}

TEST_F(Whole, FilesAreWhatTheyWereWhenTheProcessIsKilled) {
  ASSERT_TRUE(write_whole(file_, "old"));
  const pid_t child = fork();
  if (child == 0) {
    WholeFile out(file_);
    out.write(many());
    ::kill(::getpid(), SIGKILL);
  }
  ASSERT_GT(child, 0);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_EQ(text_of(file_), "old");
  EXPECT_THAT(names(), ElementsAre("out.csv"));
}

TEST_F(Whole, FilesAreWhatTheyWereWhereTheDiskHasNoRoom) {
  ASSERT_TRUE(write_whole(file_, "old"));
  const auto before = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit little{100'000, limit.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &little);
  WholeFile out(file_);
  out.write(many());
  out.write("more");
  const auto finished = out.finish();
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, before);
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().message, file_.string() + ": cannot be written: File too large");
  EXPECT_EQ(text_of(file_), "old");
}

TEST_F(Whole, FilesKeepTheirAccessRights) {
  ASSERT_TRUE(write_whole(file_, "old"));
  ASSERT_EQ(::chmod(file_.c_str(), 0640), 0);
  ASSERT_TRUE(write_whole(file_, "new"));
  struct stat now {};
  ASSERT_EQ(::stat(file_.c_str(), &now), 0);
  EXPECT_EQ(now.st_mode & 07777U, 0640U);
  EXPECT_EQ(text_of(file_), "new");
}

TEST_F(Whole, LinksGoOnLeadingToTheirFile) {
  ASSERT_TRUE(write_whole(file_, "old"));
  fs::create_symlink("out.csv", folder_ / "link");
  ASSERT_TRUE(write_whole(folder_ / "link", "new"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(text_of(file_), "new");
}

TEST_F(Whole, PipesGetTheBytesAsTheyCome) {
  ASSERT_EQ(::mkfifo(file_.c_str(), 0600), 0);
  const int reader = ::open(file_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  WholeFile out(file_);
  out.write("first");
  std::array<char, 16> got{};
  EXPECT_EQ(::read(reader, got.data(), got.size()), 5);
  EXPECT_TRUE(out.finish());
  ::close(reader);
  EXPECT_TRUE(fs::is_fifo(file_));
}

TEST_F(Whole, FilesThatCannotBeOpenedAreToldByTheirNameAndTheReason) {
  for (const auto& [file, why] :
       {std::pair(folder_ / "none" / "out.csv", "cannot be opened: No such file or directory"),
        std::pair(folder_, "cannot be opened: Is a directory")}) {
    const auto written = write_whole(file, "new");
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().message, file.string() + ": " + why);
  }
  EXPECT_THAT(write_whole("/dev/full", "new").error().message, HasSubstr("No space left on device"));
}

}  // namespace
}  // namespace rmac::gateway
