#pragma once

#include <gmock/gmock.h>

#include <fstream>

#include "gateway/rmac/program/runner.hpp"
#include "unit/gateway/rmac/fake_appliance.hpp"

namespace rmac::cli {

inline constexpr const char* kMove = "RMAC_CAM.MoveToXYZ";
inline constexpr const char* kStart = "RMAC_CAM.CycleStart";

/// Runs programs of some moves against an appliance that does each at once, unless the test says something else.
class RunnerTest : public testing::Test {
 protected:
  RunnerTest() {
    appliance_.handles(kMove, [this](const nlohmann::json& params) {
      move_is_done(params.at("MoveID"));
      return gateway::Answer(true);
    });
  }

  void move_is_done(std::int64_t id) {
    clock_s_ += 1;
    appliance_.push_event(gateway::Event::Kind::MoveStarted, {{"move_id", id}, {"t_s", clock_s_ - 1}});
    appliance_.push_event(gateway::Event::Kind::MoveDone, {{"move_id", id}, {"t_s", clock_s_}});
  }

  /// Lines of the program; its name is p.rmac.
  void line(const std::string& method, const nlohmann::json& params = nlohmann::json::object()) {
    text_ += nlohmann::json{{"jsonrpc", "2.0"}, {"method", method}, {"params", params}}.dump() + "\n";
  }
  void move(std::int64_t id) { line(kMove, {{"MoveID", id}, {"x", 1}, {"y", 0}, {"z", 0}, {"Speed", 10}}); }

  Result<RunReport> run() {
    const std::string file = testing::TempDir() + "runner_test.rmac";
    std::ofstream(file) << text_;
    auto program = read_program(file);
    if (!program) return tl::unexpected(program.error());
    program->file = "p.rmac";
    auto connection = Connection::open(appliance_.endpoint());
    if (!connection) return tl::unexpected(connection.error());
    options_.terminal = appliance_.terminal();
    return Runner(**connection, *program, options_).run();
  }

  /// Enters a line when the client has heard all that came before: it asks for the state of a machine that stopped.
  void type_once_heard(const std::string& entered) {
    appliance_.push_event(gateway::Event::Kind::Stopped);
    appliance_.handles("RMAC_CAM.GetState", [this, entered](const nlohmann::json&) {
      appliance_.answers("RMAC_CAM.GetState", state());
      appliance_.type(entered);
      return gateway::Answer(state({{"moves_in_buffer", 99}, {"mode", "MANUAL"}}));
    });
  }

  /// How often a method was asked for.
  std::size_t count(const std::string& method) { return appliance_.params_of(method).size(); }

  FakeAppliance appliance_;
  std::string text_;
  RunOptions options_;
  double clock_s_ = 100;
};

}  // namespace rmac::cli
