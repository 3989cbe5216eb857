#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "clients/legacy/program/input_file.hpp"
#include "clients/legacy/program/output_file.hpp"

namespace rmac::legacy {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A folder of its own, that goes with it.
class ProgramFiles : public testing::Test {
 protected:
  ProgramFiles() : folder_(fs::path(testing::TempDir()) / ("rmac_program_files." + std::to_string(::getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "a");
    fs::create_directories(folder_ / "b");
  }
  ~ProgramFiles() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string put(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  static std::string text_of(const std::string& file) {
    std::ifstream input(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(input), {}};
  }
  /// Of files that are not whole yet, or never were.
  int parts() const {
    int count = 0;
    for (const auto& entry : fs::directory_iterator(folder_)) count += entry.path().extension() == ".part" ? 1 : 0;
    return count;
  }

  fs::path folder_;
};

TEST_F(ProgramFiles, AreReadAsTheyAre) {
  EXPECT_EQ(read_file(put("x", "G0 X1\r\n\x80")).value(), "G0 X1\r\n\x80");
  EXPECT_EQ(read_file(put("x", "\xEF\xBB\xBFG0 X1\n")).value(), "G0 X1\n") << "a byte order mark is no letter";
  EXPECT_EQ(read_file(put("x", "\xEF\xBBG0")).value(), "\xEF\xBBG0");
}

TEST_F(ProgramFiles, ThatHoldNoProgramSayWhy) {
  const auto why = [](const std::string& file) {
    const auto text = read_file(file);
    return text ? "read" : text.error();
  };
  for (const std::string blank : {"", " ", "\n", " \t\r\n", "\xEF\xBB\xBF \n"})
    EXPECT_EQ(why(put("x", blank)), "is empty");
  EXPECT_THAT(why(put("x", "\xFF\xFEG")), HasSubstr("is text in UTF-16"));
  EXPECT_THAT(why(put("x", "\xFE\xFFG")), HasSubstr("is text in UTF-16"));
  EXPECT_EQ(why(put("x", std::string("G0\0X1", 5))), "is no text");
  EXPECT_EQ(why(path("a")), "is a folder");
  EXPECT_EQ(why(path("none")), "cannot be read: No such file or directory");
}

TEST_F(ProgramFiles, OfSubsAreThoseOfTheFirstFolderThatHasThem) {
  const std::string program = put("a/own.ngc", "own");
  put("b/own.ngc", "other");
  put("b/only.ngc", "only");
  put("a/both.ngc", "first");
  put("b/both.ngc", "second");
  put("a/empty.ngc", "");
  fs::create_directories(folder_ / "a/folder.ngc");
  const std::vector<std::string> folders{path("a"), path("b")};
  const auto found = [&](const std::string& name) { return find_file(folders, name, program); };
  EXPECT_EQ(found("both.ngc").value()->text, "first");
  EXPECT_EQ(found("both.ngc").value()->name, path("a/both.ngc"));
  EXPECT_EQ(found("only.ngc").value()->text, "only");
  EXPECT_EQ(found("own.ngc").value()->text, "other") << "a program is no sub of itself";
  EXPECT_EQ(found("none.ngc").value(), std::nullopt);
  EXPECT_EQ(found("folder.ngc").value(), std::nullopt);
  EXPECT_EQ(found("empty.ngc").error(), path("a/empty.ngc") + ": is empty");
}

TEST_F(ProgramFiles, AreWrittenWholeOrNotAtAll) {
  const std::string name = put("out.rmac", "old");
  {
    OutputFile output(name);
    ASSERT_TRUE(output.open());
    output.write("half");
    EXPECT_EQ(text_of(name), "old");
    EXPECT_EQ(parts(), 1);
  }
  EXPECT_EQ(text_of(name), "old");
  EXPECT_EQ(parts(), 0);
  {
    OutputFile output(name);
    output.write("one ");
    output.write("and the other");
    EXPECT_TRUE(output.finish());
    EXPECT_EQ(text_of(name), "one and the other");
  }
  EXPECT_EQ(text_of(name), "one and the other");
  EXPECT_EQ(parts(), 0);
}

TEST_F(ProgramFiles, LeaveAloneWhatSomebodyElseWritesUnderSuchAName) {
  const std::string somebodys = put("out.rmac.0.part", "somebody's");
  OutputFile output(path("out.rmac"));
  ASSERT_TRUE(output.open());
  output.write("mine");
  EXPECT_TRUE(output.finish());
  EXPECT_EQ(text_of(somebodys), "somebody's");
  EXPECT_EQ(text_of(path("out.rmac")), "mine");
}

TEST_F(ProgramFiles, BehindALinkAreTheOnesThatItLeadsTo) {
  put("real.rmac", "old");
  fs::create_symlink(path("real.rmac"), path("link.rmac"));
  OutputFile output(path("link.rmac"));
  output.write("new");
  EXPECT_TRUE(output.finish());
  EXPECT_TRUE(fs::is_symlink(path("link.rmac")));
  EXPECT_EQ(text_of(path("real.rmac")), "new");
}

// A FIFO and not /dev/null: who takes the one for a file puts a file in its place, and root's tests put one in /dev.
TEST_F(ProgramFiles, ThatAreNoFilesGetWhatIsWhole) {
  const std::string fifo = path("fifo"), text(200'000, 'x');
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  const int reader = ::open(fifo.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(::fcntl(reader, F_SETPIPE_SZ, 1 << 18), 200'000);
  std::string got(300'000, ' ');
  {
    OutputFile output(fifo);
    ASSERT_TRUE(output.open());
    output.write(text);
    EXPECT_LT(::read(reader, got.data(), got.size()), 0) << "nothing before it is whole";
    EXPECT_TRUE(output.finish());
    got.resize(static_cast<std::size_t>(std::max(::read(reader, got.data(), got.size()), ssize_t{0})));
    EXPECT_TRUE(got == text);
  }
  EXPECT_TRUE(fs::is_fifo(fifo));
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  OutputFile broken(fifo);
  broken.write(text);
  ::close(reader);
  EXPECT_FALSE(broken.finish()) << "what is not written is told";
  std::signal(SIGPIPE, before);
}

TEST_F(ProgramFiles, OfFoldersThatAreNotThereAreNotOpen) {
  EXPECT_FALSE(OutputFile(path("none/out.rmac")).open());
  EXPECT_FALSE(OutputFile(path("a")).open());
}

}  // namespace
}  // namespace rmac::legacy
