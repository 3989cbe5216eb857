// Flight records of events, from cycles that the test wrote.
#include "gateway/record/flight_reporter.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "unit/gateway/device_driver_manager/fixtures.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kPeriod_s = 0.001;

sdk::DeviceObject gantry() {
  sdk::DeviceObject device;
  device.name = "Gantry";
  device.joints.resize(1);
  device.joints[0].limits.name = "X";
  device.joints[0].gains = {300, 4};
  device.held_joints.resize(1);
  device.held_joints[0].limits.name = "C";
  device.held_joints[0].limits.type = JointType::Rotary;
  return device;
}

class FlightReporterTest : public testing::Test {
 protected:
  void run_cycles(int count, std::uint32_t actuators) {
    for (int i = 0; i < count; ++i) {
      CycleSample sample;
      sample.cycle = ++cycle_;
      sample.t_s = static_cast<double>(cycle_) * kPeriod_s;
      sample.joint_count = 1;
      sample.joint_count_with_held = 2;
      sample.actuator_count = actuators;
      sample.ahead = {0.25, -0.25};
      sample.statusword = {0x27, 0x08, 0x40};
      history_.add(sample);
    }
  }
  [[nodiscard]] Event fault() const {
    Event event;
    event.kind = Event::Kind::Fault;
    event.cycle = cycle_;
    event.message = "it broke";
    return event;
  }
  /// The recorder writes on a thread of its own.
  Event outcome() {
    std::vector<Event> events;
    while (events.empty()) events = reporter_.take_events();
    return events.front();
  }
  std::string text_of(const std::string& name) {
    const auto part = reporter_.folder()->read(name, 0);
    return part ? (*part)["text"].get<std::string>() : part.error().message;
  }

  std::int64_t cycle_ = 0;
  test::TemporaryFolder folder_;
  CycleHistory history_{1000};
  FlightReporter reporter_{{folder_.path() / "records", 0.01, 20}, kPeriod_s, history_};
  sdk::DeviceObject device_ = gantry();
};

TEST_F(FlightReporterTest, RecordsBothMotorsOfAGantryAndDescribesHeldJointsLast) {
  device_.joints[0].mechanics.resonances = {{274, 0.05, 0.7}};
  device_.joints[0].mechanics.low_pass_hz = 180;
  device_.actuators = {{.bus = "can0", .axis = 1, .scale = {65536, 2.4, -1, 0}}};
  device_.actuators[0].cogging = {{{60, 0.001, -0.006}}, 0.0015};
  run_cycles(20, 3);
  Event asked;
  asked.cycle = cycle_;
  const auto name = reporter_.record(FlightCause::Demand, asked, &device_);
  ASSERT_TRUE(name) << name.error().message;
  const Event written = outcome();
  EXPECT_EQ(written.kind, Event::Kind::FlightRecord);
  EXPECT_EQ(written.record, *name);
  EXPECT_THAT(written.message, HasSubstr("cycles 11 to 20"));
  const std::string text = text_of(*name);
  EXPECT_THAT(text, HasSubstr(",statusword1,statusword2,statusword3,error_code1,"));
  EXPECT_THAT(text, HasSubstr(",39,8,64,"));
  EXPECT_THAT(text, HasSubstr(",error_code3,ahead1,ahead2,ahead3,rpm1,"));
  EXPECT_THAT(text, HasSubstr(",0.25,-0.25,0,"));
  const auto head = nlohmann::json::parse(text.substr(0, text.find('\n')));
  EXPECT_EQ(head["mechanism"], "Gantry");
  EXPECT_EQ(head["joints"][0]["name"], "X");
  EXPECT_EQ(head["joints"][0]["gains"], nlohmann::json::parse("[300,4]"));
  EXPECT_EQ(head["joints"][0]["resonances"],
            nlohmann::json::parse(R"([{"frequency": 274.0, "damping": 0.05, "width": 0.7}])"));
  EXPECT_EQ(head["joints"][0]["low_pass"], 180);
  EXPECT_EQ(head["actuators"], nlohmann::json::parse(
                                   R"([{"counts_per_revolution": 65536.0, "rated_torque": 2.4, "direction": -1,
                                         "cogging": {"lead": 0.0015, "harmonics": [{"order": 60, "cosine": 0.001, "sine": -0.006}]}}])"));
  EXPECT_EQ(head["joints"][1]["name"], "C");
  EXPECT_EQ(head["joints"][1]["resonances"], nlohmann::json::array());
  EXPECT_EQ(head["joints"][1]["unit"], "deg");
}

TEST_F(FlightReporterTest, KeepsWhatTheBusesHadGoneThroughHoweverLongThatIs) {
  run_cycles(20, 1);
  // As of two full buses: far longer than any other head.
  const nlohmann::json report{{"buses", nlohmann::json::array({std::string(600'000, 'x')})}, {"lines", {}}};
  FlightReporter reporter({folder_.path() / "full", 0.01, 20}, kPeriod_s, history_, [&] { return report; });
  Event event = fault();
  reporter.annotate(event, &device_);
  while (reporter.take_events().empty()) {
  }
  std::ifstream file(reporter.folder()->file_of(event.record));
  std::string head;
  std::getline(file, head);
  EXPECT_EQ(nlohmann::json::parse(head)["buses"], report);
  const auto listed = reporter.folder()->list();
  ASSERT_EQ(listed.size(), 1U) << "a long head is one";
  EXPECT_FALSE(listed[0].contains("buses")) << "a list of many of them would be";
}

TEST_F(FlightReporterTest, ARecordBeginsWhereTheNumberOfDrivesChanged) {
  run_cycles(5, 2);
  run_cycles(4, 3);
  Event asked;
  asked.cycle = cycle_;
  ASSERT_TRUE(reporter_.record(FlightCause::Demand, asked, &device_));
  EXPECT_THAT(outcome().message, HasSubstr("cycles 6 to 9")) << "those before it have other columns";
}

TEST_F(FlightReporterTest, AddsTheRecordsNameToAFaultAndToNothingElse) {
  run_cycles(20, 1);
  Event event = fault();
  reporter_.annotate(event, &device_);
  EXPECT_THAT(event.record, HasSubstr("-fault-20"));
  EXPECT_EQ(event.message, "it broke");
  Event stopped;
  stopped.cycle = cycle_;
  reporter_.annotate(stopped, &device_);
  EXPECT_THAT(stopped.record, IsEmpty());
}

TEST_F(FlightReporterTest, SaysWhyAFaultIsNotRecorded) {
  Event event = fault();
  reporter_.annotate(event, nullptr);
  EXPECT_THAT(event.record, IsEmpty());
  EXPECT_EQ(event.message, "it broke; it is not recorded: there is nothing to record: no mechanism is loaded");
}

TEST_F(FlightReporterTest, MakesNoneWhereNoneAreWanted) {
  FlightReporter none({{}, 10, 20}, kPeriod_s, history_);
  Event event = fault();
  none.annotate(event, &device_);
  EXPECT_EQ(event.message, "it broke") << "nobody asked for records, so that none is no news";
  EXPECT_EQ(none.folder(), nullptr);
  EXPECT_THAT(none.take_events(), IsEmpty());
  const auto refused = none.record(FlightCause::Demand, event, &device_);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("seconds above 0 in rmacd.json"));
}

}  // namespace
}  // namespace rmac::gateway
