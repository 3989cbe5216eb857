// The flight recorder in a real controller: what it writes, when, and what happens where it cannot.
#include "gateway/record/flight_recorder.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "gateway/record/flight_record.hpp"
#include "unit/gateway/device_driver_manager/fixtures.hpp"
#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// A record as a reader sees it.
struct ReadRecord {
  json head;
  std::vector<std::string> columns;
  std::vector<std::map<std::string, std::string>> rows;

  [[nodiscard]] std::int64_t cycle(std::size_t row) const { return std::stoll(rows[row].at("cycle")); }
};

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
  return cells;
}

ReadRecord read_record(const FlightFolder& folder, const std::string& name) {
  std::string text;
  for (json offset = 0; !offset.is_null();) {
    const auto part = folder.read(name, offset.get<std::int64_t>());
    if (!part) {
      ADD_FAILURE() << part.error().message;
      return {};
    }
    text += (*part)["text"].get<std::string>();
    offset = (*part)["next_offset"];
  }
  ReadRecord record;
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  record.head = json::parse(line);
  std::getline(lines, line);
  record.columns = cells_of(line);
  while (std::getline(lines, line)) {
    const auto cells = cells_of(line);
    EXPECT_EQ(cells.size(), record.columns.size());
    auto& row = record.rows.emplace_back();
    for (std::size_t i = 0; i < std::min(cells.size(), record.columns.size()); ++i) row[record.columns[i]] = cells[i];
  }
  return record;
}

class FlightRecord : public testing::Test {
 protected:
  void start(double seconds = 0.5, std::size_t files_kept = 20) {
    start_in(folder_.path() / "records", seconds, files_kept);
  }
  void start_in(const std::filesystem::path& folder, double seconds = 0.5, std::size_t files_kept = 20) {
    ControllerOptions options = TestMachine::options();
    options.flight_recorder = {folder, seconds, files_kept};
    machine_ = std::make_unique<TestMachine>(options);
    const auto loaded = machine_->load_at_zero(TestMachine::mill());
    ASSERT_TRUE(loaded) << loaded.error().message;
  }
  void start_line() {
    ASSERT_TRUE(cam().path().set_feedrate(600));
    ASSERT_TRUE(machine_->line(1, {0, 0, 0}, {40, 0, 0}));
    ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
    ASSERT_TRUE(machine_->run_until_event(Event::Kind::MoveStarted, 1));
  }
  /// The event that tells what became of the last record.
  Event wait_for(Event::Kind kind) {
    EXPECT_TRUE(machine_->run_until([&] { return of_kind(kind) != nullptr; }));
    const Event* found = of_kind(kind);
    return found != nullptr ? *found : Event{};
  }
  [[nodiscard]] const Event* of_kind(Event::Kind kind) const {
    for (const Event& event : machine_->events) {
      if (event.kind == kind) return &event;
    }
    return nullptr;
  }
  std::string record_now() {
    machine_->events.clear();
    const auto name = machine_->controller.record_flight();
    EXPECT_TRUE(name) << name.error().message;
    EXPECT_EQ(wait_for(Event::Kind::FlightRecord).record, name.value_or(""));
    return name.value_or("");
  }
  sdk::RmacCam& cam() { return machine_->controller.cam(); }
  const FlightFolder& folder() { return *machine_->controller.flight_records(); }

  test::TemporaryFolder folder_;
  std::unique_ptr<TestMachine> machine_;
};

TEST_F(FlightRecord, OfAFaultHasItsCycleTheWayThereAndTheStop) {
  start();
  start_line();
  ASSERT_TRUE(machine_->run_until([&] { return machine_->samples.back().s_mm > 10; })) << "a second";
  machine_->bus->trip(1, 0x2310);
  const Event fault = wait_for(Event::Kind::Fault);
  ASSERT_FALSE(fault.record.empty());
  EXPECT_EQ(wait_for(Event::Kind::FlightRecord).record, fault.record);

  const ReadRecord record = read_record(folder(), fault.record);
  EXPECT_EQ(record.head["cause"], "fault");
  EXPECT_EQ(record.head["cycle"], fault.cycle);
  EXPECT_EQ(record.head["message"], fault.message);
  EXPECT_EQ(record.head["mechanism"], "Mill");
  EXPECT_EQ(record.head["joints"][2]["name"], "Z");
  ASSERT_GT(record.rows.size(), 500U);
  EXPECT_EQ(record.cycle(499), fault.cycle) << "half a second before it, and it";
  for (std::size_t row = 0; row < record.rows.size(); ++row) {
    ASSERT_EQ(record.cycle(row), record.cycle(0) + static_cast<std::int64_t>(row));
    ASSERT_EQ(record.rows[row].at("fault"), row < 499 ? "None" : "DriveFault") << "in cycle " << record.cycle(row);
  }
  EXPECT_EQ(record.rows[499].at("error_code2"), std::to_string(0x2310));
  EXPECT_EQ(record.rows[499].at("servo_state"), "Faulted");
}

TEST_F(FlightRecord, SaysOfEachCycleWhatItsSampleSaid) {
  start();
  start_line();
  ASSERT_TRUE(machine_->run_until([&] { return machine_->samples.back().s_mm > 10; }));
  const ReadRecord record = read_record(folder(), record_now());
  EXPECT_EQ(record.head["cause"], "demand");
  ASSERT_EQ(record.rows.size(), 500U);
  EXPECT_EQ(record.cycle(499), record.head["cycle"]);
  ASSERT_TRUE(machine_->run_until([&] { return machine_->samples.back().cycle >= record.cycle(499); }));
  std::size_t compared = 0;
  for (const CycleSample& sample : machine_->samples) {
    if (sample.cycle < record.cycle(0) || sample.cycle > record.cycle(499)) continue;
    const auto& row = record.rows[static_cast<std::size_t>(sample.cycle - record.cycle(0))];
    ++compared;
    // All digits: not nearly the same but the same.
    ASSERT_EQ(std::stod(row.at("t_s")), sample.t_s);
    ASSERT_EQ(std::stod(row.at("horizon_s")), sample.horizon.s);
    ASSERT_EQ(row.at("horizon_limit"), to_string(sample.horizon.limit));
    for (std::size_t j = 0; j < 3; ++j) {
      const std::string number = std::to_string(j + 1);
      ASSERT_EQ(std::stod(row.at("q" + number)), sample.position_set[j]);
      ASSERT_EQ(std::stod(row.at("a" + number)), sample.position[j]);
      ASSERT_EQ(std::stod(row.at("error" + number)), sample.following_error[j]);
      ASSERT_EQ(std::stod(row.at("effort" + number)), sample.effort[j]);
      ASSERT_EQ(row.at("torque_permille" + number), std::to_string(sample.torque_permille[j]));
      ASSERT_EQ(row.at("statusword" + number), std::to_string(sample.statusword[j]));
    }
  }
  EXPECT_EQ(compared, 500U);
}

TEST_F(FlightRecord, BeginsWithTheMechanismThatItIsOf) {
  start(3);
  ASSERT_TRUE(machine_->load(TestMachine::plane_mill()));
  const std::int64_t loaded = machine_->controller.sample().cycle;
  sdk::DeviceObject two = TestMachine::plane_mill();
  two.held_joints.clear();
  two.actuators.pop_back();
  two.actuator_map.numbers["joints"] = {2};
  const auto changed = machine_->load(two);
  ASSERT_TRUE(changed) << changed.error().message;
  const ReadRecord record = read_record(folder(), record_now());
  ASSERT_FALSE(record.rows.empty());
  EXPECT_GT(record.cycle(0), loaded) << "the cycles with three joints have other columns";
  EXPECT_THAT(record.columns, testing::Contains("q2"));
  EXPECT_THAT(record.columns, Not(testing::Contains("q3")));
}

/// A cycle of a machine with two joints.
CycleSample with_drives(std::int64_t cycle, std::uint32_t drives) {
  CycleSample sample;
  sample.cycle = cycle;
  sample.joint_count = sample.joint_count_with_held = 2;
  sample.actuator_count = drives;
  for (std::uint32_t i = 0; i < drives; ++i) {
    sample.statusword[i] = static_cast<std::uint16_t>(100 + i);
    sample.error_code[i] = static_cast<std::uint16_t>(200 + i);
    sample.torque_permille[i] = static_cast<std::int16_t>(300 + i);
    sample.counts[i] = -60000 - static_cast<std::int32_t>(i);
  }
  return sample;
}

/// The record up to cycle 20 of a machine that makes these samples.
ReadRecord record_of(const FlightFolder& folder, const std::filesystem::path& path,
                     const std::function<CycleSample(std::int64_t)>& sample_at) {
  CycleHistory history(100);
  for (std::int64_t cycle = 1; cycle <= 20; ++cycle) history.add(sample_at(cycle));
  std::string name;
  {
    FlightRecorder recorder({path, 0.015, 20}, 0.001, history);
    FlightHead head;
    head.cycle = 20;
    name = recorder.request(std::move(head)).value_or("");
  }
  return read_record(folder, name);
}

/// The same of a machine that has `now` drives, and had `before` until cycle 10.
ReadRecord record_of_drives(const FlightFolder& folder, const std::filesystem::path& path, std::uint32_t before,
                            std::uint32_t now) {
  return record_of(folder, path, [&](std::int64_t cycle) { return with_drives(cycle, cycle <= 10 ? before : now); });
}

// Red when the columns of drives are counted as joints.
TEST_F(FlightRecord, HasAColumnForEachDriveOfAGantry) {
  const ReadRecord record = record_of_drives(FlightFolder(folder_.path()), folder_.path(), 3, 3);
  EXPECT_THAT(record.columns, testing::Contains("q2"));
  EXPECT_THAT(record.columns, Not(testing::Contains("q3")));
  EXPECT_THAT(record.columns, Not(testing::Contains("statusword4")));
  ASSERT_EQ(record.rows.size(), 15U);
  EXPECT_EQ(record.rows[0].at("statusword3"), "102");
  EXPECT_EQ(record.rows[0].at("error_code3"), "202");
  EXPECT_EQ(record.rows[0].at("torque_permille3"), "302");
  EXPECT_EQ(record.rows[0].at("counts2"), "-60001");
}

// Red when only joints tell one mechanism from another: rows with other columns would follow.
TEST_F(FlightRecord, BeginsWithTheDrivesThatItIsOf) {
  const ReadRecord record = record_of_drives(FlightFolder(folder_.path()), folder_.path(), 3, 2);
  EXPECT_THAT(record.columns, Not(testing::Contains("statusword3")));
  ASSERT_EQ(record.rows.size(), 10U);
  EXPECT_EQ(record.cycle(0), 11);
}

// Red when an error is made of positions of one row: drives answer late.
TEST_F(FlightRecord, TellsFollowingErrorsAndHowLateTheirDrivesAnswer) {
  CycleHistory history(100);
  for (std::int64_t cycle = 1; cycle <= 20; ++cycle) {
    CycleSample sample = with_drives(cycle, 2);
    sample.position_set = {10, 20};
    sample.position = {9, 19};
    sample.following_error = {0.25, -0.125};
    sample.answer_delay = {1, 3};
    history.add(sample);
  }
  const FlightFolder folder(folder_.path());
  std::string name;
  {
    FlightRecorder recorder({folder_.path(), 0.015, 20}, 0.001, history);
    FlightHead head;
    head.cycle = 20;
    head.joints.resize(2);
    name = recorder.request(std::move(head)).value_or("");
  }
  const ReadRecord record = read_record(folder, name);
  ASSERT_FALSE(record.rows.empty());
  EXPECT_EQ(record.rows[0].at("error1"), "0.25");
  EXPECT_EQ(record.rows[0].at("error2"), "-0.125");
  EXPECT_EQ(record.head["joints"][0]["answer_delay"], 1);
  EXPECT_EQ(record.head["joints"][1]["answer_delay"], 3);
}

// Red when a column of zeros stands for what a real drive does not tell, or rows of both kinds stand under one head.
TEST_F(FlightRecord, HasTheTruthOfJointsWhereItIsToldAndNoColumnElsewhere) {
  const FlightFolder folder(folder_.path());
  const auto told_from = [&](std::int64_t first) {
    return record_of(folder, folder_.path(), [first](std::int64_t cycle) {
      CycleSample sample = with_drives(cycle, 3);
      sample.position = {1.5, 2.5};
      if (cycle >= first) sample.truth = {1.25, 2.75};
      return sample;
    });
  };
  const ReadRecord told = told_from(1);
  ASSERT_EQ(told.rows.size(), 15U);
  EXPECT_EQ(told.rows[0].at("a2"), "2.5");
  EXPECT_EQ(told.rows[0].at("truth1"), "1.25");
  EXPECT_EQ(told.rows[0].at("truth2"), "2.75");
  EXPECT_EQ(told.rows[0].at("torque_permille1"), "300");
  EXPECT_THAT(told.columns, Not(testing::Contains("truth3")));
  const ReadRecord untold = told_from(100);
  EXPECT_THAT(untold.columns, Not(testing::Contains("truth1")));
  EXPECT_EQ(untold.rows.at(0).at("torque_permille1"), "300");
  const ReadRecord half = told_from(11);
  ASSERT_EQ(half.rows.size(), 10U);
  EXPECT_EQ(half.rows[0].at("truth1"), "1.25");
}

TEST_F(FlightRecord, TheOldestMakeWayAndFaultsAreNotPushedOutByThoseAskedFor) {
  start(0.05, 2);
  start_line();
  machine_->bus->trip(0, 0x2310);
  const std::string fault = wait_for(Event::Kind::FlightRecord).record;
  std::vector<std::string> asked;
  for (int i = 0; i < 4; ++i) asked.push_back(record_now());
  std::vector<std::string> kept;
  for (const json& head : folder().list()) kept.push_back(head["name"]);
  EXPECT_THAT(kept, testing::ElementsAre(fault, asked[2], asked[3]));
}

TEST_F(FlightRecord, ThatCannotBeWrittenIsToldAndChangesNothingElse) {
  const auto file = folder_.write("no-folder", "");
  start_in(file / "records");
  start_line();
  machine_->bus->trip(1, 0x2310);
  const Event failed = wait_for(Event::Kind::FlightRecordFailed);
  EXPECT_THAT(failed.message, HasSubstr((file / "records").string()));
  EXPECT_THAT(failed.message, HasSubstr("Not a directory"));
  EXPECT_THAT(failed.message, HasSubstr("flight_recorder in rmacd.json"));
  EXPECT_EQ(failed.record, wait_for(Event::Kind::Fault).record);
  EXPECT_TRUE(folder().list().empty());

  ASSERT_TRUE(cam().cycle().reset());
  ASSERT_TRUE(machine_->run_until([&] { return machine_->controller.sample().state == CycleState::Idle; }));
  const CycleSample now = machine_->controller.sample();
  ASSERT_TRUE(machine_->line(2, {now.position_set[0], now.position_set[1], now.position_set[2]}, {0, 0, 0}));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  EXPECT_TRUE(machine_->run_until_event(Event::Kind::MoveDone, 2));
}

/// While it lives, no file of this process may grow beyond some bytes: as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit full{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &full);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    (void)std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

TEST_F(FlightRecord, LeavesNothingHalfWrittenWhenTheDiskIsFull) {
  start();
  {
    const FullDisk full(1000);
    ASSERT_TRUE(machine_->controller.record_flight());
    EXPECT_THAT(wait_for(Event::Kind::FlightRecordFailed).message, HasSubstr("File too large"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path() / "records"));
  record_now();
  EXPECT_EQ(folder().list().size(), 1U);
}

TEST_F(FlightRecord, IsRefusedWhereThereIsNothingToRecordOrNobodyWhoDoes) {
  {
    TestMachine without;
    const auto refused = without.controller.record_flight();
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("seconds above 0 in rmacd.json"));
    EXPECT_EQ(without.controller.flight_records(), nullptr);
  }
  start();
  ASSERT_TRUE(machine_->controller.unload());
  const auto refused = machine_->controller.record_flight();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("no mechanism is loaded"));
}

TEST_F(FlightRecord, OfADaemonThatEndsIsWrittenFirst) {
  start();
  const auto name = machine_->controller.record_flight();
  ASSERT_TRUE(name) << name.error().message;
  machine_.reset();
  EXPECT_FALSE(read_record(FlightFolder(folder_.path() / "records"), *name).rows.empty());
}

TEST_F(FlightRecord, IsReadByItsOwnNameAlone) {
  start();
  const std::string name = record_now();
  folder_.write("secret.flight", "x");
  for (const std::string& other : {std::string("../secret"), std::string(""), name + "/../" + name, name + ".flight"}) {
    EXPECT_FALSE(folder().read(other, 0)) << other;
  }
  const auto beyond = folder().read(name, 1'000'000'000);
  ASSERT_TRUE(beyond);
  EXPECT_EQ((*beyond)["text"], "");
  EXPECT_TRUE((*beyond)["next_offset"].is_null());
}

/// Who writes a list of them out calls himself as often as they are deep.
TEST_F(FlightRecord, WhoseHeadIsDeeperThanAnyIsLeftOutOfTheList) {
  start();
  const std::string deep = R"({"joints":)" + std::string(30'000, '[') + std::string(30'000, ']') + "}\n";
  folder_.write("records/20261121T000000.000Z-demand-1.flight", deep);
  EXPECT_EQ(folder().list(), json::array());
}

TEST_F(FlightRecord, ThatADeadDaemonLeftUnfinishedGoesAtTheNextStart) {
  folder_.write("records/20261121T104600.123Z-fault-5.flight.part", "x");
  folder_.write("records/somebody-elses.part", "x");
  start();
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "records/20261121T104600.123Z-fault-5.flight.part"));
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "records/somebody-elses.part"));
}

TEST_F(FlightRecord, LastStopSaysWhatHappenedAndInWhichCycle) {
  start();
  EXPECT_THAT(machine_->controller.last_stop()->message, HasSubstr("one move")) << "homing, so far";
  start_line();
  ASSERT_TRUE(cam().cycle().stop());
  const Event stopped = wait_for(Event::Kind::Stopped);
  EXPECT_THAT(stopped.message, HasSubstr("after a CycleStop; what is queued goes on with CycleStart"));
  ASSERT_TRUE(machine_->run_until([&] { return machine_->samples.back().cycle >= stopped.cycle; }));
  for (const CycleSample& sample : machine_->samples) {
    if (sample.cycle == stopped.cycle) {
      EXPECT_FALSE(sample.moving);
    }
  }
  EXPECT_EQ(machine_->controller.last_stop()->cycle, stopped.cycle);
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  machine_->bus->set_online(2, false);
  const Event fault = wait_for(Event::Kind::Fault);
  EXPECT_EQ(machine_->controller.last_stop()->message, fault.message);
  EXPECT_EQ(machine_->controller.last_stop()->record, fault.record);
}

}  // namespace
}  // namespace rmac::gateway
