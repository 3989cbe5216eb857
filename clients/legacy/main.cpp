#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <tl/expected.hpp>
#include <tuple>
#include <utility>
#include <vector>

#include "clients/legacy/apt/import.hpp"
#include "clients/legacy/fanuc/import.hpp"
#include "clients/legacy/option_values.hpp"
#include "clients/legacy/program/input_file.hpp"
#include "clients/legacy/program/output_file.hpp"
#include "clients/legacy/program/writer.hpp"
#include "clients/legacy/rs274/import.hpp"

namespace {

namespace fs = std::filesystem;
using namespace rmac;

struct Words {
  std::string file, output, dialect = "rs274", unit, approach, reference, second_reference;
  std::vector<std::string> offsets, outputs, inputs, diameters, variables, passed, subroutines, centres;
  bool ids_are_lines = false;
  rs274::Options options;
  std::string circle_axis, whole_numbers, rotary, rotary_way;
  bool multax = false;

  [[nodiscard]] bool is_apt() const { return dialect == "apt"; }
  [[nodiscard]] bool is_haas() const { return dialect == "haas"; }
  /// A Haas reads what a Fanuc does, and more.
  [[nodiscard]] bool is_fanuc() const { return dialect == "fanuc" || is_haas(); }
};

FurtherSystems further_systems(const Words& words) {
  if (words.is_haas()) return {"G154P", 99};
  return words.is_fanuc() ? FurtherSystems{"G54.1P", 300} : FurtherSystems{};
}

int fail(const std::string& message) {
  fmt::print(stderr, "rmac-import: {}\n", message);
  return 1;
}

/// What A, B and C turn.
std::optional<std::string> finish_rotary(Words& words) {
  auto& options = words.options;
  if (!words.rotary.empty()) options.rotary = read_rotary(words.rotary);
  if (!words.rotary.empty() && options.rotary.empty())
    return "--rotary is A, B and C, each at most once and with - where it turns the other way, as C,A or C,-B";
  for (const auto& text : words.centres) {
    if (!read_rotary_centre(text, options.rotary))
      return fmt::format(
          "--rotary-centre {}: it is three numbers in mm, as 0,0,-50, or those of an axis that --rotary "
          "has, as A=0,0,-50",
          text);
  }
  if (!words.rotary_way.empty())
    options.rotary_way = words.rotary_way == "shorter" ? gcode::RotaryWay::Shorter : gcode::RotaryWay::Written;
  return std::nullopt;
}

/// What a Fanuc program alone has.
std::optional<std::string> finish_fanuc(Words& words) {
  if (!words.whole_numbers.empty()) {
    words.options.whole_numbers =
        words.whole_numbers == "units" ? gcode::WholeNumbers::Units : gcode::WholeNumbers::Increments;
  }
  for (const auto& text : words.variables) {
    if (!read_variable(text, words.options.variables))
      return fmt::format("--variable {}: it is a number from 100 to 199 or 500 to 999, and a value, as 500=12.5", text);
  }
  for (const auto& text : words.passed) {
    if (!read_m(text, words.options.passed_m)) return fmt::format("--pass-over {}: it is an M code, as M10", text);
  }
  const auto& outputs = words.options.outputs;
  const auto unused =
      std::ranges::find_if(outputs, [](const auto& output) { return !fanuc::switches_output(output.first); });
  if (words.is_haas() && unused != outputs.end())
    return fmt::format("--output {}={}: of a Haas' program M73, M83 and M88 switch outputs, as 88=NAME", unused->first,
                       unused->second);
  const auto dialect = words.is_haas() ? fanuc::Dialect::Haas : fanuc::Dialect::Fanuc;
  for (const int number : words.options.passed_m) {
    if (words.is_fanuc() && !fanuc::may_pass_over(number, dialect))
      return fmt::format("--pass-over M{0}: M{0} is carried out here, and no program goes without it", number);
  }
  return std::nullopt;
}

/// What the command line parser leaves as text. What is wrong, or nothing.
std::optional<std::string> finish(Words& words) {
  if (!legacy::is_feed(words.options.rapid_mm_min)) return "--rapid is 0.01 to 1 000 000 mm/min";
  if (words.ids_are_lines) words.options.ids = legacy::Ids::Lines;
  if (!words.unit.empty()) words.options.unit_mm = words.unit == "inch" ? 25.4 : 1.0;
  const std::array places{
      std::tuple{"approach", &words.approach, &words.options.approach_mm},
      std::tuple{"reference-point", &words.reference, &words.options.reference_mm},
      std::tuple{"second-reference-point", &words.second_reference, &words.options.second_reference_mm}};
  for (const auto& [name, text, point] : places) {
    if (text->empty()) continue;
    *point = read_point(*text);
    if (!*point) return fmt::format("--{} is three numbers in mm, as 0,0,50", name);
  }
  for (const auto& [name, texts, names] : {std::tuple{"output", &words.outputs, &words.options.outputs},
                                           std::tuple{"input", &words.inputs, &words.options.inputs}}) {
    for (const std::string& text : *texts) {
      if (!read_name(text, *names)) return fmt::format("--{} {}: it is a number and a name, as 3=Clamp", name, text);
    }
  }
  for (const auto& text : words.diameters) {
    if (!read_diameter(text, words.options.tool_diameters_mm))
      return fmt::format("--tool-diameter {}: it is the number of a tool and 0 to 1000 mm, as 3=10", text);
  }
  for (const auto& offset : words.offsets) {
    if (!read_offset(offset, further_systems(words), words.options.offsets))
      return fmt::format("--offset {}: it is a work system and three numbers in mm, as G54=100,50,-20", offset);
  }
  if (auto wrong = finish_rotary(words)) return wrong;
  if (auto wrong = finish_fanuc(words)) return wrong;
  if (words.output.empty())
    words.output = words.file == "-" ? "-" : fs::path(words.file).replace_extension(".rmac").string();
  if (std::error_code none; words.output != "-" && words.file != "-" && fs::equivalent(words.output, words.file, none))
    return "the output would replace its source; name another with -o";
  return std::nullopt;
}

/// The language, where it is not said: by the file's ending.
std::string dialect_of(const std::string& file) {
  static constexpr std::array<std::string_view, 3> kApt{".apt", ".cls", ".aptsource"};
  std::string ending = fs::path(file).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char letter) { return std::tolower(letter); });
  return std::ranges::find(kApt, ending) != kApt.end() ? "apt" : "rs274";
}

apt::Options apt_options(const Words& words) {
  apt::Options options;
  options.rapid_mm_min = words.options.rapid_mm_min;
  options.unit_mm = words.options.unit_mm;
  options.approach_mm = words.options.approach_mm;
  options.reference_mm = words.options.reference_mm;
  options.multax = words.multax;
  if (!words.circle_axis.empty()) {
    options.circle_axis =
        words.circle_axis == "clockwise" ? apt::CircleAxis::Clockwise : apt::CircleAxis::CounterClockwise;
  }
  options.ids = words.options.ids;
  return options;
}

/// Where subs of other files are: beside the program, and in --subroutines.
rs274::FindFile sub_files(const Words& words) {
  std::vector<std::string> folders = words.subroutines;
  if (words.file != "-") folders.insert(folders.begin(), fs::path(words.file).parent_path().string());
  return [folders, program = words.file](const std::string& name) { return legacy::find_file(folders, name, program); };
}

/// Whether a program begins as those of Fanuc-type controls do, O1234 or :1234 with no word behind it.
bool begins_with_number(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n", kDigits = "0123456789";
  std::size_t at = text.find_first_not_of(kBlank);
  if (at < text.size() && text[at] == '%') at = text.find_first_not_of(kBlank, text.find('\n', at));
  if (at >= text.size() || std::string_view("O:o").find(text[at]) == std::string_view::npos) return false;
  const std::size_t behind = std::min(text.find_first_not_of(kDigits, at + 1), text.size());
  const std::size_t rest = text.find_first_not_of(" \t", behind);
  return behind > at + 1 &&
         (rest >= text.size() || std::string_view("\r\n(;").find(text[rest]) != std::string_view::npos);
}

int import_file(const Words& words) {
  const auto text = legacy::read_file(words.file);
  const std::string file = words.file == "-" ? "standard input" : words.file;
  if (!text) return fail(fmt::format("{}: {}", file, text.error()));
  legacy::OutputFile output(words.output);
  if (!output.open()) return fail(words.output + ": cannot be written");
  const auto sink = [&output](std::string_view part) { output.write(part); };
  const auto summary = words.is_apt() ? apt::import_program(*text, apt_options(words), sink)
                       : words.is_fanuc()
                           ? fanuc::import_program(*text, words.options, sink,
                                                   words.is_haas() ? fanuc::Dialect::Haas : fanuc::Dialect::Fanuc)
                           : rs274::import_program(*text, words.options, sink, sub_files(words));
  if (!summary) {
    const auto& error = summary.error();
    const bool may_be_fanucs = !words.is_apt() && !words.is_fanuc() && begins_with_number(*text);
    return fail(fmt::format("{}:{}:{}: {}{}", error.file.empty() ? file : error.file, error.line, error.column,
                            error.message,
                            may_be_fanucs ? " (it begins as a program for a Fanuc or a Haas does; if it is one, give "
                                            "--dialect fanuc or --dialect haas)"
                                          : ""));
  }
  if (!output.finish()) return fail(words.output + ": cannot be written");
  if (words.output != "-") fmt::print("{}: {} moves from {} lines\n", words.output, summary->moves, summary->lines);
  return 0;
}

void declare(CLI::App& app, Words& words) {
  app.add_option("FILE", words.file, "the program, - for standard input")->required();
  app.add_option("-o", words.output, "the .rmac file, - for standard output; FILE with the ending .rmac unless given");
  app.add_option("--dialect", words.dialect,
                 "which language it is; unless given, apt of .apt, .cls and .aptsource, and rs274 of the others")
      ->check(CLI::IsMember({"rs274", "fanuc", "haas", "apt"}));
  app.add_flag("--block-delete", words.options.block_delete, "leave out blocks that begin with /");
  app.add_option("--unit", words.unit, "unit of a program without G20 and G21, or UNITS")
      ->check(CLI::IsMember({"mm", "inch"}));
  app.add_option("--rapid", words.options.rapid_mm_min,
                 "feed of G0 and RAPID, mm/min; at most the machine's MaxFeedrate")
      ->capture_default_str();
  app.add_option("--tolerance", words.options.tolerance_mm, "path tolerance of G64 without P, mm")
      ->check(CLI::Range(0.0, 1000.0));
  app.add_option("--approach", words.approach,
                 "X,Y,Z in mm: where the tool tip goes straight, at rapid, when the program begins, after a tool "
                 "change and a change of unknown "
                 "offsets, unless its next move is a G0 to X, Y and Z, or RAPID and a GOTO");
  app.add_flag("--assume-g43", words.options.assume_g43, "the tool's length counts from M6 on, though no G43 says so");
  app.add_flag("--assume-end", words.options.assume_end, "the program ends where its file does, as if M2 stood there");
  app.add_option("--offset", words.offsets,
                 "G54=X,Y,Z in mm: where a work system is in the machine; may be given for each; G54.1P3=... in fanuc, "
                 "G154P3=... in haas")
      ->allow_extra_args(false);
  app.add_option("--reference-point", words.reference,
                 "X,Y,Z in mm: where G28, or GOHOME, takes the tool tip, in the coordinates of the part");
  app.add_option("--second-reference-point", words.second_reference, "the same of G30");
  app.add_option("--output", words.outputs,
                 "3=NAME: the machine's output that M62 to M65 P3 switch; in haas 88=NAME, which M88 switches on")
      ->allow_extra_args(false);
  app.add_option("--input", words.inputs, "3=NAME: the machine's input that M66 P3 waits for")->allow_extra_args(false);
  app.add_option("--output-limit", words.options.bounds.output_mb,
                 "MB: a program with loops or subprograms that becomes more is one that does not end")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  app.add_option("--tool-diameter", words.diameters,
                 "3=10: the diameter of tool 3 in mm, for G41 and G42; of a fanuc or haas program, twice the radius in "
                 "the offset D3")
      ->allow_extra_args(false);
  app.add_option("--subroutines", words.subroutines,
                 "DIR[:DIR]: folders where the subs are that an rs274 program calls and does not have, each NAME in "
                 "NAME.ngc; its own folder is looked into first")
      ->delimiter(':')
      ->check(CLI::ExistingDirectory)
      ->allow_extra_args(false);
  app.add_flag("--ids-are-lines", words.ids_are_lines, "the id of each request is the line that it comes from");
}

void declare_rotary(CLI::App& app, Words& words) {
  app.add_option("--rotary", words.rotary,
                 "C,A: the axes of the program's machine that turn the tool about Z (C), Y (B) and X (A) of the part, "
                 "from the part to the tool; each counter-clockwise, or with - the other way")
      ->allow_extra_args(false);
  app.add_option("--rotary-centre", words.centres,
                 "X,Y,Z in mm: a point on the axes of --rotary, in the coordinates of the program's begin, where they "
                 "turn a table that carries the part; A=X,Y,Z of one of them")
      ->allow_extra_args(false);
  app.add_option("--rotary-way", words.rotary_way,
                 "how a table goes to an angle that is more than half a turn away: as written, or the shorter way "
                 "round; of a fanuc or haas program refused unless given, of others as written")
      ->check(CLI::IsMember({"written", "shorter"}));
  app.add_option("--rotary-diameter", words.options.rotary_diameter_mm,
                 "mm: that the degrees of a table count as ways on, in the F of a move that turns it")
      ->check(CLI::Range(0.001, 10'000.0));
}

void declare_fanuc(CLI::App& app, Words& words) {
  app.add_option("--whole-numbers", words.whole_numbers,
                 "what lengths and angles without a decimal point count in, in a fanuc or haas program: units (X10 is "
                 "10 mm) or increments (X10 is 0.010 mm); refused unless given")
      ->check(CLI::IsMember({"units", "increments"}));
  app.add_option("--variable", words.variables,
                 "500=12.5: what the machine has in a common variable that a fanuc or haas program reads")
      ->allow_extra_args(false);
  app.add_option(
         "--pass-over", words.passed,
         "M10: an M code of the machine's builder or owner that the program may go without; may be given for each")
      ->allow_extra_args(false);
}

void declare_apt(CLI::App& app, Words& words) {
  app.add_flag("--multax", words.multax, "tool axes of an apt program count though no MULTAX/ON says so");
  app.add_option(
         "--circle-axis", words.circle_axis,
         "which way arcs go about the axis of an apt program's CIRCLE, seen against it; unless given, clockwise "
         "of records of NX (eleven numbers), and refused of others without INDIRV")
      ->check(CLI::IsMember({"clockwise", "counter-clockwise"}));
}

/// The option that was given and is of another language than the file's, or nothing.
std::optional<std::string> foreign_option(const CLI::App& app, const Words& words) {
  /// A Haas takes what a Fanuc does, and what is its own.
  enum Languages { Rs274 = 1, Fanuc = 2, Apt = 4, Haas = 8 };
  static constexpr std::array<std::pair<const char*, int>, 20> kOf{{{"--block-delete", Rs274 | Fanuc},
                                                                    {"--tolerance", Rs274 | Fanuc},
                                                                    {"--assume-g43", Rs274 | Fanuc},
                                                                    {"--assume-end", Rs274 | Fanuc},
                                                                    {"--offset", Rs274 | Fanuc},
                                                                    {"--subroutines", Rs274},
                                                                    {"--output", Rs274 | Haas},
                                                                    {"--input", Rs274},
                                                                    {"--second-reference-point", Rs274 | Fanuc},
                                                                    {"--output-limit", Rs274 | Fanuc},
                                                                    {"--tool-diameter", Rs274 | Fanuc},
                                                                    {"--whole-numbers", Fanuc},
                                                                    {"--variable", Fanuc},
                                                                    {"--rotary", Rs274 | Fanuc},
                                                                    {"--rotary-centre", Rs274 | Fanuc},
                                                                    {"--rotary-way", Rs274 | Fanuc},
                                                                    {"--rotary-diameter", Rs274 | Fanuc},
                                                                    {"--pass-over", Rs274 | Fanuc},
                                                                    {"--multax", Apt},
                                                                    {"--circle-axis", Apt}}};
  const int language = words.is_apt() ? Apt : words.is_haas() ? Fanuc | Haas : words.is_fanuc() ? Fanuc : Rs274;
  for (const auto& [name, languages] : kOf) {
    if ((languages & language) != 0 || app.count(name) == 0) continue;
    return fmt::format("{} is not of {}, which {} is taken as; --dialect says otherwise", name, words.dialect,
                       words.file);
  }
  return std::nullopt;
}

}  // namespace

int main(int count, char** arguments) {
  CLI::App app{
      "Makes a .rmac program of one in another control's language. What is not understood stops it, with line and "
      "column."};
  app.name("rmac import");
  Words words;
  declare(app, words);
  declare_rotary(app, words);
  declare_fanuc(app, words);
  declare_apt(app, words);
  try {
    app.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (app.count("--dialect") == 0) words.dialect = dialect_of(words.file);
  auto wrong = foreign_option(app, words);
  if (!wrong) wrong = finish(words);
  if (wrong) {
    static_cast<void>(fail(*wrong));
    return 2;
  }
  return import_file(words);
}
