#include "gateway/rmac/commands/programs/learn.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/files/content_hash.hpp"
#include "gateway/files/whole_file.hpp"
#include "gateway/learning/learned_json.hpp"
#include "gateway/learning/learner.hpp"
#include "gateway/rmac/commands/programs/run_files.hpp"
#include "gateway/rmac/terminal/table.hpp"
#include "gateway/rmac/wire/authority.hpp"
#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {

namespace {

using Json = nlohmann::json;

constexpr const char* kProgram = "Program";
constexpr const char* kOption = "--offsets";

std::string file_of(const Program& program, const LearnOptions& options) {
  return options.file.empty() ? program.file + ".learned" : options.file;
}

std::string hash_of(const Program& program) {
  gateway::ContentHash hash;
  for (const Request& request : program.requests) {
    hash.add(request.text);
    hash.add("\n");
  }
  return hash.text();
}

/// Refuses what cannot be repeated, or whose places could not be told apart.
Result<> check(const Program& program) {
  constexpr std::string_view kConfigures = "RMAC_Config.";
  std::set<std::int64_t> ids;
  for (const Request& request : program.requests) {
    const auto refuse = [&](const std::string& why) {
      return fail(fmt::format("{}:{}: {}", program.file, request.line, why));
    };
    if (request.method.starts_with(kConfigures) || request.method == kLoadMachine ||
        request.method == "Device.Unload") {
      return refuse(
          fmt::format("{} changes the machine, and what is learned is forgotten by that; do it before, as with "
                      "--machine",
                      request.method));
    }
    const bool move = request.timing == Timing::Move && !request.tool_change;
    if (move && !ids.insert(request.move_id).second) {
      return refuse(
          fmt::format("MoveID {} stands on an earlier line too; places are told apart by it, so give each move "
                      "its own",
                      request.move_id));
    }
  }
  return ids.empty() ? fail(fmt::format("{}: queues no move, so there is nothing to learn", program.file)) : Result<>();
}

struct MachineTold {
  std::string name, configuration;
  std::vector<std::string> joints;
  std::vector<int> delays;
  gateway::Learner::Options learner;
};

Result<MachineTold> ask_machine(Connection& connection, const LearnOptions& options) {
  const auto told = connection.call("RMAC_CAM.GetLearnedOffsets");
  if (!told) return tl::unexpected(told.error());
  MachineTold machine{(*told)["Machine"], (*told)["Configuration"], {}, {}, {}};
  if ((*told)["Virtual"].get<bool>()) {
    return fail(
        fmt::format("{} is loaded in virtual mode: no drive runs, and there is nothing to learn", machine.name));
  }
  machine.learner.period_s = (*told)["Period"];
  machine.learner.bandwidth_hz = options.bandwidth_hz;
  for (const Json& joint : (*told)["Joints"]) {
    machine.joints.push_back(joint["Name"]);
    machine.delays.push_back(joint["AnswerDelay"]);
    machine.learner.largest.push_back(joint["LargestOffset"]);
  }
  if (std::ranges::all_of(machine.learner.largest, [](double largest) { return largest == 0; })) {
    return fail(
        fmt::format("the drives of {} close their loops themselves, and there is nothing to learn here", machine.name));
  }
  const double highest = 0.1 / machine.learner.period_s;
  if (options.bandwidth_hz > highest) {
    return fail(fmt::format("{:g} Hz cannot be learned with cycles of {:g} s; {:g} Hz are the most",
                            options.bandwidth_hz, machine.learner.period_s, highest));
  }
  return machine;
}

/// The passes of one program, and what is told of them.
class Lesson {
 public:
  Lesson(Connection& connection, const Program& program, RunOptions run, const LearnOptions& options,
         MachineTold machine)
      : connection_(connection),
        program_(program),
        run_(std::move(run)),
        file_(file_of(program, options)),
        machine_(std::move(machine)),
        learner_(machine_.learner) {}

  Result<> pass();
  [[nodiscard]] Result<> write(const gateway::Pass& last);
  void print(bool json) const;

 private:
  [[nodiscard]] Json learned() const {
    return gateway::to_json({machine_.name, machine_.configuration, learner_.next_parts()});
  }
  [[nodiscard]] std::size_t line_bytes() const;
  void note(const gateway::Pass& pass, const RunReport& report);

  Connection& connection_;
  const Program& program_;
  RunOptions run_;
  std::string file_;
  MachineTold machine_;
  gateway::Learner learner_;
  Json told_ = Json::array();
};

std::size_t Lesson::line_bytes() const {
  constexpr std::size_t kBeside = 1000;  // of the request that it goes in
  constexpr std::size_t kUnlessTold = 8U << 20U;
  const auto limits = connection_.greeting().value("limits", Json::object());
  return limits.value("line_bytes", kUnlessTold) - kBeside;
}

Result<> Lesson::pass() {
  gateway::Pass pass(machine_.delays);
  run_.on_cycle = [&pass](const JointSample& sample) {
    pass.add({sample.cycle, sample.move_id, sample.s_mm, sample.moving, sample.position_set, sample.following_error});
  };
  run_.learned = learner_.next() ? learned() : Json();
  const auto report = Runner(connection_, program_, run_).run();
  if (!report) return tl::unexpected(report.error());
  pass.end();
  if (pass.missing() > 0) {
    return fail(fmt::format("{} cycles were not told: another client has the full rate", pass.missing()));
  }
  if (pass.went_back()) return fail("the path was gone back on, and what was seen is not that of the program");
  if (pass.steps().size() < 2) return fail("no joint moved along a path, so there is nothing to learn");
  note(pass, *report);
  learner_.learn(pass);
  if (!learner_.next()) return fail(learner_.problem());
  if (learned().dump().size() > line_bytes()) {
    return fail(
        "the program is too long: what would be learned of it is more than the appliance takes at once; learn "
        "its parts, or with a lower --bandwidth");
  }
  return told_.size() < 2 ? Result<>() : write(pass);
}

void Lesson::note(const gateway::Pass& pass, const RunReport& report) {
  Json rms = Json::array(), largest = Json::array();
  for (std::size_t j = 0; j < machine_.joints.size(); ++j) {
    rms.push_back(pass.rms(j));
    largest.push_back(pass.largest(j));
  }
  told_.push_back({{"rms", std::move(rms)}, {"largest", std::move(largest)}, {"cycle_time_s", report.cycle_time_s}});
}

Result<> Lesson::write(const gateway::Pass& last) {
  gateway::Learner best = learner_;
  best.settle(last);
  Json learned = gateway::to_json({machine_.name, machine_.configuration, best.next_parts()});
  learned[kProgram] = hash_of(program_);
  const auto written = gateway::write_whole(file_, learned.dump() + "\n");
  return written ? Result<>() : fail(written.error().message);
}

void Lesson::print(bool json) const {
  Json best = Json::array();
  for (std::size_t j = 0; j < machine_.joints.size(); ++j) best.push_back(learner_.best_pass(j) + 1);
  if (json) {
    fmt::print("{}\n",
               Json{{"ok", true}, {"joints", machine_.joints}, {"passes", told_}, {"best_pass", best}, {"file", file_}}
                   .dump());
    return;
  }
  std::vector<std::string> header{"pass"};
  for (const std::string& joint : machine_.joints) {
    header.push_back(joint + " rms");
    header.push_back("largest");
  }
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < told_.size(); ++i) {
    rows.push_back({std::to_string(i + 1)});
    for (std::size_t j = 0; j < machine_.joints.size(); ++j) {
      for (const char* what : {"rms", "largest"})
        rows.back().push_back(fmt::format("{:.2f}", 1000 * told_[i][what][j].get<double>()));
    }
  }
  fmt::print("following errors, µm or 0.001°\n{}", table(header, rows));
  for (std::size_t j = 0; j < machine_.joints.size(); ++j) {
    if (learner_.best_pass(j) + 1 == told_.size()) continue;
    fmt::print("joint {}: later passes were no better; that of pass {} is kept\n", machine_.joints[j],
               learner_.best_pass(j) + 1);
  }
  fmt::print("{} is written; rmac run {} --learned takes it up\n", file_, program_.file);
}

}  // namespace

Result<> learn_program(Connection& connection, const Program& program, const RunOptions& run,
                       const LearnOptions& options, bool json) {
  const std::string file = file_of(program, options);
  if (program.file == "-" || program.file == "standard input") {
    return fail("standard input cannot be run again; learn a file");
  }
  auto ready = check(program).and_then([&] { return refuse_unwritable(file, kOption); }).and_then([&] {
    return refuse_used(file, kOption, {program.file});
  });
  if (!ready) return ready;
  RunOptions again = run;
  if (const std::string machine = std::exchange(again.machine, ""); !machine.empty()) {
    auto loaded = with_authority(connection, [&] { return load_machine(connection, machine, run.virtual_mode); });
    if (!loaded) return loaded;
  }
  auto machine = ask_machine(connection, options);
  if (!machine) return tl::unexpected(machine.error());
  fmt::print(stderr, "rmac: {} goes round {} times on {}; what is learned goes to {}\n", program.file, options.passes,
             machine->name, file);
  Lesson lesson(connection, program, std::move(again), options, std::move(*machine));
  for (int pass = 1; pass <= options.passes; ++pass) {
    if (auto done = lesson.pass(); !done) {
      return fail(fmt::format("pass {} of {}: {}{}", pass, options.passes, done.error().message,
                              pass > 2 ? fmt::format("; what was learned before is in {}", file) : ""));
    }
  }
  lesson.print(json);
  return {};
}

Result<Json> learned_of(const Program& program, const LearnOptions& options) {
  const std::string file = file_of(program, options);
  std::ifstream stream(file);
  if (!stream) {
    return fail(fmt::format("{}: cannot be read; rmac run {} --learn 4 writes it", file, program.file));
  }
  Json learned = Json::parse(stream, nullptr, false);
  if (!learned.is_object() || !learned.contains(kProgram))
    return fail(fmt::format("{}: is not what was learned", file));
  if (learned[kProgram] != hash_of(program)) {
    return fail(fmt::format("{}: was learned of another program, or {} has changed since; learn it anew with --learn",
                            file, program.file));
  }
  learned.erase(kProgram);
  return learned;
}

}  // namespace rmac::cli
