#include "gateway/simulators/console/line_input.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <optional>
#include <string>
#include <vector>

#include "gateway/processes/temporary_folder.hpp"

namespace rmac::vdrive::test {
namespace {

/// A FIFO as a person makes it, with the simulator at one end.
class Commands : public testing::Test {
 protected:
  Commands() {
    EXPECT_EQ(mkfifo(fifo_.c_str(), 0600), 0);
    auto opened = LineInput::open(fifo_);
    EXPECT_TRUE(opened.has_value());
    input_.emplace(std::move(opened.value()));
  }
  /// As `echo … > fifo` does: opened, written and closed.
  void type(const std::string& text) const {
    const int file = ::open(fifo_.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    ASSERT_EQ(write(file, text.data(), text.size()), static_cast<ssize_t>(text.size()));
    close(file);
  }
  std::vector<std::string> lines() {
    std::vector<std::string> all;
    while (auto line = input_->next()) all.push_back(std::move(*line));
    return all;
  }

  gateway::TemporaryFolder folder_{"commands"};
  std::string fifo_ = (folder_.path() / "commands").string();
  std::optional<LineInput> input_;
};

using Lines = std::vector<std::string>;

TEST_F(Commands, ComeLineByLineWhoeverWritesThem) {
  EXPECT_EQ(lines(), Lines{}) << "it waits for nobody";
  type("5 status\n5 fault 1\n");
  EXPECT_EQ(lines(), (Lines{"5 status", "5 fault 1"}));
  type("\n5 mute on\n");
  EXPECT_EQ(lines(), (Lines{"", "5 mute on"})) << "another writer, after the first one closed it";
}

TEST_F(Commands, AreWholeLines) {
  type("5 sta");
  EXPECT_EQ(lines(), Lines{});
  type("tus\n5 mu");
  EXPECT_EQ(lines(), Lines{"5 status"});
  type("te on\n");
  EXPECT_EQ(lines(), Lines{"5 mute on"});
}

TEST_F(Commands, MayBeLongerThanWhatIsReadAtOnce) {
  const std::string longest(4000, 'x');
  type(longest + "\n5 status\n");
  EXPECT_EQ(lines(), (Lines{longest, "5 status"}));
}

TEST_F(Commands, AreNotWhatALineThatIsTooLongEndsWith) {
  for (std::size_t length = 4000; length < 6000; length += 100) {
    type(std::string(length, 'x') + "5 fault 1\n5 status\n");
    const Lines got = lines();
    ASSERT_EQ(got.size(), 2U) << length;
    EXPECT_EQ(got[0].substr(0, 4000), std::string(4000, 'x')) << "whoever carries it out sees that it is none";
    EXPECT_EQ(got[1], "5 status");
  }
}

TEST_F(Commands, TakeNoMoreMemoryThanALineMayHave) {
  for (int i = 0; i < 100; ++i) {
    type(std::string(10'000, 'x'));
    EXPECT_EQ(lines(), Lines{});
  }
  type("\n");
  const Lines got = lines();
  ASSERT_EQ(got.size(), 1U);
  EXPECT_LT(got[0].size(), 5000U);
}

TEST(LineInput, SaysWhatIsMissingWhereThereIsNoFifo) {
  const auto opened = LineInput::open("/nowhere/commands");
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(opened.error().message,
            "/nowhere/commands: cannot be opened for commands: No such file or directory; make it with mkfifo");
}

}  // namespace
}  // namespace rmac::vdrive::test
