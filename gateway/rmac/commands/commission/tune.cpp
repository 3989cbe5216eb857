#include <fmt/format.h>

#include <deque>
#include <optional>
#include <vector>

#include "gateway/rmac/commands/commission/experiment.hpp"
#include "gateway/rmac/commands/commission/registrations.hpp"
#include "gateway/rmac/commands/commission/tuning_laws.hpp"
#include "gateway/rmac/commands/commission/tuning_motion.hpp"
#include "gateway/rmac/commands/commission/tuning_text.hpp"
#include "gateway/rmac/wire/requests.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::cli {

namespace {

using Json = nlohmann::json;

/// What moves, and what is aimed at.
struct TuneOptions {
  Stroke stroke;
  double bandwidth_hz = 0;  ///< 0: the largest that keeps its margins
  double phase_margin_deg = 40;
  std::optional<double> sweep_effort;  ///< N or N·m; a twentieth of `MaxEffort` unless given; 0: no sweep
  std::string picture;                 ///< empty: tune-JOINT.png here
  bool creep = false;                  ///< friction before it slides, and cogging
  bool apply = false;
};

Result<> apply_gains(Connection& connection, const TuneOptions& options, const Json& found) {
  if (found["apply"].is_null() && !options.creep) {
    return fail(fmt::format("nothing is changed: {} takes other gains than those that were found; choose a PID law",
                            found["law"].get<std::string>()));
  }
  if (loses_filters(found)) {
    return fail("nothing is changed: the joint has filters, and without a sweep nobody knows what they are for");
  }
  return apply_found(connection, options.stroke.joint, found);
}

/// Refuses a machine of which nothing would be found.
Result<StateNote> check_machine(Connection& connection, int joint) {
  auto state = ask_state(connection);
  if (!state) return state;
  if (state->mechanism.empty()) return fail("no machine is loaded; `rmac load` one first");
  if (state->virtual_mode) return fail("the machine is in virtual mode, in which no drive moves; load it without");
  if (joint >= static_cast<int>(state->joints.size())) {
    return fail(fmt::format("there is no joint {}; the machine has {}", joint, state->joints.size()));
  }
  const auto law = connection.call("Device.Machine_GetMechanismJntServoControlLaw", {{"JntNum", joint}});
  if (!law) return tl::unexpected(law.error());
  if (law->get<std::string>().empty()) {
    return fail(fmt::format("joint {}: its drive closes the loop itself; tune it with its maker's tool", joint));
  }
  return state;
}

std::vector<std::string> program_words(const TuneOptions& options, const TemporaryFile& record, double begin_s,
                                       const std::string& picture) {
  return {record.path(),
          std::to_string(options.stroke.joint),
          fmt::format("{}", begin_s),
          "--picture",
          picture,
          "--margin",
          fmt::format("{}", options.phase_margin_deg),
          "--bandwidth",
          fmt::format("{}", options.bandwidth_hz)};
}

/// Of `MaxEffort`: with what the loop answers to it, more is a loop that swings (docs/servo.md).
constexpr double kMostShare = 0.095;

/// Why a joint is not swept; empty: it can be.
std::string unswept(const TuneOptions& options, const Json& found) {
  if (found["before"].is_null()) {
    return fmt::format(
        "{} has no feedback, which holds the joint while it is measured; put a PID law in force, or take the joint for "
        "rigid with --sweep-effort 0",
        found["law"].get<std::string>());
  }
  if (!options.sweep_effort && found["max_effort"] == 0) {
    return "the joint has no MaxEffort, of which the sweep would be a twentieth; give --sweep-effort";
  }
  const double most = kMostShare * found["max_effort"].get<double>();
  if (most > 0 && options.sweep_effort.value_or(0) > most) {
    return fmt::format(
        "--sweep-effort {:g}: from a tenth of the joint's MaxEffort on the watch takes the sines for a "
        "loop that swings; give at most {:g}",
        *options.sweep_effort, most);
  }
  return {};
}

/// Sweeps the joint, of which `found` is what its swings have shown, and has `words` tell `tune.py` where that is
/// recorded. What is lost in noise is swept again, until all of it together says enough.
Result<Json> measure_response(Connection& connection, const TuneOptions& options, const Json& found,
                              std::deque<TemporaryFile>& records, std::vector<std::string>& words,
                              const std::string& fault) {
  constexpr std::size_t kMostSweeps = 6;
  if (const std::string why = unswept(options, found); !why.empty()) return fail(why);
  const Sweep sweep = sweep_for(options.stroke, found, options.sweep_effort);
  std::vector<std::string> begins;
  const std::vector<std::string> before = words;
  for (;;) {
    const auto begin = ask_state(connection);
    if (!begin) return tl::unexpected(begin.error());
    begins.push_back(fmt::format("{}", begin->t_s));
    const auto swept = sweep_strokes(connection, options.stroke, found, sweep, fault).and_then([&] {
      return keep_record(connection, records.emplace_back());
    });
    if (!swept) return tl::unexpected(swept.error());
    words = before;
    words.insert(words.end(), {"--sweep-effort", fmt::format("{}", sweep.effort), "--sweep-period",
                               fmt::format("{}", sweep.period_s), "--sweeps", std::to_string(sweep.sweeps), "--from-hz",
                               fmt::format("{}", sweep.from_hz), "--to-hz", fmt::format("{}", sweep.to_hz), "--sweep"});
    for (const TemporaryFile& record : records) words.push_back(record.path());
    words.emplace_back("--sweep-begin");
    words.insert(words.end(), begins.begin(), begins.end());
    auto answer = plot_answer("tune.py", words);
    if (!answer || !answer->contains("unmeasured")) return answer;
    if (records.size() == kMostSweeps) return fail((*answer)["unmeasured"].get<std::string>());
  }
}

/// Creeps under the loop that is proposed, which follows better than the one in force; that of a joint that was only
/// taken for rigid may not hold.
Result<> creep(Connection& connection, const TuneOptions& options, const Json& found, CreepRecords& records,
               std::vector<std::string>& words, const std::string& fault) {
  const int joint = options.stroke.joint;
  const auto strokes = [&] { return creep_strokes(connection, options.stroke, found, records, fault); };
  for (const std::string& word : {std::string("--creep"), records.turning.path(), records.reversing.path()})
    words.push_back(word);
  const Result<> crept =
      found["misfit"].is_null()
          ? strokes()
          : under_law(
                connection, joint, found, [&] { return put_proposed(connection, joint, found); }, strokes);
  words.emplace_back("--creep-begin");
  for (const double begin : records.begins) words.push_back(fmt::format("{}", begin));
  return crept;
}

/// Swings, the joint's response, and where it is wanted creeping.
Result<Json> find_tuning(Connection& connection, const TuneOptions& options, double begin_s, const std::string& picture,
                         const std::string& fault) {
  if (auto moved = swing_at_speeds(connection, options.stroke, fault); !moved) return tl::unexpected(moved.error());
  const TemporaryFile record;
  std::deque<TemporaryFile> swept;
  if (auto kept = keep_record(connection, record); !kept) return tl::unexpected(kept.error());
  auto words = program_words(options, record, begin_s, picture);
  const bool sweeps = options.sweep_effort != 0;
  auto rigid = words;
  if (sweeps) rigid.back() = "0";  // the bandwidth that is wanted is for what will be measured
  auto found = plot_answer("tune.py", rigid);
  if (found && options.creep && !(*found)["no_creep"].is_null()) return fail((*found)["no_creep"].get<std::string>());
  if (found && sweeps) {
    found = measure_response(connection, options, *found, swept, words, fault);
  }
  if (!found || !options.creep) return found;
  CreepRecords records;
  if (auto crept = creep(connection, options, *found, records, words, fault); !crept)
    return tl::unexpected(crept.error());
  return plot_answer("tune.py", words);
}

Result<> tune(Connection& connection, const TuneOptions& options, bool json) {
  const std::string picture =
      options.picture.empty() ? fmt::format("tune-{}.png", options.stroke.joint) : options.picture;
  if (auto fine = check_picture(picture); !fine) return fine;  // before anything moves
  if (options.stroke.travel == 0) {
    return fail(fmt::format("--travel {}: give the way that the joint may go, in mm or degrees, negative the other way",
                            options.stroke.travel));
  }
  return commission(connection, [&](const std::string& fault) -> Result<> {
    const auto state = check_machine(connection, options.stroke.joint);
    if (!state) return tl::unexpected(state.error());
    const auto found = find_tuning(connection, options, state->t_s, picture, fault);
    if (!found) return tl::unexpected(found.error());
    if (json) {
      fmt::print("{}\n", found->dump());
    } else {
      print_tuning(*found, picture);
    }
    if (options.apply) return apply_gains(connection, options, *found);
    if (!json) fmt::print("nothing was changed; --apply puts this in force until the machine is loaded again\n");
    return {};
  });
}

}  // namespace

void add_tune(Command& rmac) {
  const auto options = std::make_shared<TuneOptions>();
  Command tuned = rmac.add(
      "tune",
      "move a joint, find its mass, friction, delay and resonances, and propose gains and filters; needs python3-scipy "
      "and -matplotlib");
  tuned.option("JOINT", &options->stroke.joint, "counted from 0")
      .required()
      .within(0, static_cast<int>(kMaxJoints) - 1);
  tuned.option("--travel", &options->stroke.travel, "mm or degrees that it may go from where it stands, signed")
      .required();
  tuned.option("--bandwidth", &options->bandwidth_hz, "Hz; the largest that keeps its margins unless given").positive();
  tuned.option("--phase-margin", &options->phase_margin_deg, "degrees").within(32.0, 70.0).shows_default();
  tuned
      .option("--sweep-effort", &options->sweep_effort,
              "N or N·m of the sines that find resonances; a twentieth of MaxEffort unless given, 0 for none")
      .within(0.0, 1e7);
  tuned.flag("--creep", &options->creep,
             "also creep along, two turns of the motor and to and fro: finds its cogging, and how friction builds up "
             "before it slides");
  tuned.option("-o,--output", &options->picture, "the picture to draw; tune-JOINT.png here unless given");
  tuned.flag("--apply", &options->apply,
             "put gains and filters in force, with --creep the law with feedforward and what it found; without it "
             "nothing is changed");
  tuned.does(with_appliance([options](Connection& appliance, bool json) { return tune(appliance, *options, json); }));
}

}  // namespace rmac::cli
