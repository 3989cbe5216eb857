#include "gateway/rmac/commands/programs/source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <string_view>
#include <utility>

#include "gateway/processes/child_process.hpp"

namespace rmac::cli {

namespace {

namespace fs = std::filesystem;

/// The importer bounds what it writes, so this ends one that hangs.
constexpr std::chrono::hours kImportPatience{1};

struct Passed {
  const char* name;
  const char* meaning;
};
// Of a program of another control; `rmac import --help` says more.
constexpr std::array<Passed, std::tuple_size_v<decltype(Source::values)>> kPassed{{
    {"--circle-axis", "clockwise or counter-clockwise: which way arcs go about the axis of an APT program's CIRCLE"},
    {"--unit", "mm or inch, of an imported program without G20 and G21, or UNITS"},
    {"--rapid", "feed of an imported program's G0, or RAPID, mm/min"},
    {"--tolerance", "path tolerance of an imported program's G64 without P, mm"},
    {"--approach", "X,Y,Z in mm: where an imported program's tool tip goes first"},
    {"--reference-point", "X,Y,Z in mm: where G28, or GOHOME, of an imported program goes"},
    {"--second-reference-point", "the same of G30"},
    {"--whole-numbers", "units or increments: what a Fanuc program's lengths without a decimal point count in"},
    {"--rotary", "C,A: the axes of an imported program's machine that turn the tool, from the part to the tool"},
    {"--rotary-way", "written or shorter: how a table of theirs goes to an angle more than half a turn away"},
    {"--rotary-diameter", "mm: that degrees of a table count as ways on, in an imported program's F"},
    {"--subroutines", "DIR[:DIR]: where the subs are that an imported RS274 program calls, each in NAME.ngc"},
    {"--output-limit", "MB of .rmac: an imported program with loops that becomes more does not end"},
}};
constexpr std::array<Passed, std::tuple_size_v<decltype(Source::repeated)>> kRepeated{{
    {"--offset", "G54=X,Y,Z in mm: where an imported program's work system is in the machine"},
    {"--output", "3=NAME: the output that M62 to M65 P3 of an imported program switch; 88=NAME, of a Haas' M88"},
    {"--input", "3=NAME: the input that M66 P3 of an imported program waits for"},
    {"--tool-diameter", "3=10: the diameter of tool 3 in mm, for G41 and G42 of an imported program"},
    {"--variable", "500=12.5: what the machine has in a common variable that a Fanuc program reads"},
    {"--rotary-centre", "A=X,Y,Z in mm, or X,Y,Z: a point on an axis of --rotary that turns a table"},
    {"--pass-over", "M10: an M code of the machine's builder that a Fanuc program may go without"},
}};

struct Ending {
  std::string_view ending;
  const char* dialect;
};
constexpr std::array<Ending, 6> kEndings{
    {{".ngc", "rs274"}, {".nc", "rs274"}, {".tap", "rs274"}, {".apt", "apt"}, {".cls", "apt"}, {".aptsource", "apt"}}};

/// The language of a file by its ending; empty where it is `.rmac`, none where the ending tells nothing.
std::optional<std::string> dialect_of(const std::string& file) {
  std::string ending = fs::path(file).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char letter) { return std::tolower(letter); });
  if (file == "-" || ending.empty() || ending == ".rmac") return "";
  const auto* found = std::ranges::find(kEndings, ending, &Ending::ending);
  return found == kEndings.end() ? std::nullopt : std::optional<std::string>(found->dialect);
}

std::vector<std::string> importer_words(const Source& source, const std::string& dialect) {
  std::vector<std::string> words{beside_rmac(kImporter), "--dialect", dialect, "--ids-are-lines", "-o", "-"};
  for (std::size_t i = 0; i < kPassed.size(); ++i) {
    if (!source.values.at(i).empty()) words.push_back(fmt::format("{}={}", kPassed.at(i).name, source.values.at(i)));
  }
  for (std::size_t i = 0; i < kRepeated.size(); ++i) {
    for (const auto& value : source.repeated.at(i)) words.push_back(fmt::format("{}={}", kRepeated.at(i).name, value));
  }
  if (source.assume_g43) words.emplace_back("--assume-g43");
  if (source.assume_end) words.emplace_back("--assume-end");
  if (source.block_delete) words.emplace_back("--block-delete");
  if (source.multax) words.emplace_back("--multax");
  words.emplace_back("--");
  words.push_back(source.file);
  return words;
}

/// As this program says what is wrong: one line, without the name of another one.
Failure told_by_importer(std::string complaint) {
  const std::string prefix = fmt::format("{}: ", kImporter);
  if (complaint.starts_with(prefix)) complaint.erase(0, prefix.size());
  while (complaint.ends_with('\n')) complaint.pop_back();
  std::ranges::replace(complaint, '\n', ' ');
  return {complaint.empty() ? fmt::format("{} ended without a word", kImporter) : complaint};
}

Result<Program> import(const Source& source, const std::string& dialect) {
  if (source.file == "-") {
    return fail(
        fmt::format("standard input is taken as .rmac; write rmac import --dialect {} - -o - before it", dialect));
  }
  const std::atomic<bool> never = false;
  auto outcome = gateway::run_child(importer_words(source, dialect), kImportPatience, never);
  if (!outcome) return fail(outcome.error().message);
  if (outcome->exit_code != 0) return tl::unexpected(told_by_importer(std::move(outcome->complaint)));
  return read_imported(std::move(outcome->output), source.file);
}

}  // namespace

std::string beside_rmac(const char* program) {
  std::error_code unread;
  return (fs::read_symlink("/proc/self/exe", unread).parent_path() / program).string();
}

void declare_source(Command& command, Source& source) {
  command
      .option(
          "FILE", &source.file,
          "the .rmac file, - for standard input; .ngc, .nc and .tap (RS274/NGC), .apt, .cls and .aptsource (APT) are "
          "imported first")
      .required();
  command.option("--dialect", &source.dialect,
                 "whose language FILE is in, whatever its ending: rs274, fanuc, haas or apt");
  for (std::size_t i = 0; i < kPassed.size(); ++i) {
    command.option(kPassed.at(i).name, &source.values.at(i), kPassed.at(i).meaning);
  }
  for (std::size_t i = 0; i < kRepeated.size(); ++i) {
    command.option(kRepeated.at(i).name, &source.repeated.at(i), kRepeated.at(i).meaning).repeats();
  }
  command.flag("--assume-g43", &source.assume_g43, "an imported program's tool length counts from M6 on");
  command.flag("--assume-end", &source.assume_end, "an imported program ends where its file does");
  command.flag("--block-delete", &source.block_delete, "leave out an imported program's blocks that begin with /");
  command.flag("--multax", &source.multax, "an APT program's tool axes count though no MULTAX/ON says so");
}

Result<Program> read_source(const Source& source) {
  const auto dialect = source.dialect.empty() ? dialect_of(source.file) : std::optional(source.dialect);
  if (!dialect) {
    return fail(
        fmt::format("{}: its ending tells no language; .rmac is ours, .ngc, .nc and .tap are RS274/NGC, .apt, "
                    ".cls and .aptsource are APT, and of another file --dialect says it",
                    source.file));
  }
  if (!dialect->empty()) return import(source, *dialect);
  const auto given = [](const auto& value) { return !value.empty(); };
  const bool told = source.assume_g43 || source.assume_end || source.block_delete || source.multax ||
                    std::ranges::any_of(source.values, given) || std::ranges::any_of(source.repeated, given);
  if (told)
    return fail(fmt::format("{}: is taken as .rmac, and has no options of an import; name its --dialect", source.file));
  return read_program(source.file);
}

}  // namespace rmac::cli
