// The test is the servo thread: it answers, or not, while it is waited for.
#include "gateway/reconfiguration/servo_requests.hpp"

#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

using testing::HasSubstr;
using Result = SwapRequest::Result;

class ServoRequestsTest : public testing::Test {
 protected:
  /// Answers the third time that it is asked.
  void answer_with(Result result) {
    meanwhile_ = [this, result, passes = 0]() mutable {
      if (++passes < 3) return;
      SwapRequest* const request = link_.swap.exchange(nullptr);
      if (request == nullptr) return;
      generation_ = request->generation;
      request->result.store(result);
    };
  }
  ServoRequests patient() {
    return {link_, [this] { meanwhile_(); }};
  }
  ServoRequests hasty() {
    return {link_, [this] { meanwhile_(); }, std::chrono::nanoseconds(-1)};
  }

  ServoLink link_{1};
  std::uint64_t generation_ = 0;
  std::function<void()> meanwhile_ = [] {};
};

TEST_F(ServoRequestsTest, HandOverAMechanismUnderItsGeneration) {
  answer_with(Result::Done);
  EXPECT_TRUE(patient().swap(nullptr, 7));
  EXPECT_EQ(generation_, 7U);
}

TEST_F(ServoRequestsTest, SayThatTheMachineMovesWhereTheServoThreadRefuses) {
  answer_with(Result::Refused);
  const auto refused = patient().swap(nullptr, 1);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "the machine is moving; a mechanism is put in at rest only");
}

TEST_F(ServoRequestsTest, AreTakenBackWhenNobodyAnswers) {
  SwapRequest request;
  const auto refused = hasty().ask(request);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, MinorCode::ResponseTimeout);
  EXPECT_EQ(link_.swap.load(), nullptr) << "the servo thread would find a request that is gone";
}

TEST_F(ServoRequestsTest, WaitForAStatus) {
  meanwhile_ = [this] {
    ServoStatus status = link_.status.read();
    ++status.homings;
    link_.status.write(status);
  };
  EXPECT_TRUE(patient().wait_for_status([](const ServoStatus& now) { return now.homings == 5; }));
  EXPECT_EQ(patient().status().homings, 5U);
  EXPECT_FALSE(hasty().wait_for_status([](const ServoStatus& now) { return now.homings == 6; }));
}

}  // namespace
}  // namespace rmac::gateway
