#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gateway/rmac/commands/call.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace rmac::cli {

/// Where the value of an option goes. What is not given stays as it is there.
using Target =
    std::variant<int*, std::int64_t*, std::uint16_t*, std::uint32_t*, double*, std::string*, std::filesystem::path*,
                 std::optional<int>*, std::optional<double>*, std::optional<std::string>*, std::optional<bool>*,
                 std::vector<double>*, std::vector<std::uint32_t>*, std::vector<std::string>*>;

/// One option of a command, or one of its words in order. A handle: the command line owns what it stands for.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option& required();
  /// Takes just so many values.
  Option& takes(int values);
  /// May be given often, with one value each time.
  Option& repeats();
  /// The help shows what it is unless given.
  Option& shows_default();
  Option& reads_environment(const std::string& variable);
  Option& needs(const Option& other);
  /// Refused beside options of these names.
  Option& excludes(const std::vector<std::string>& others);

  Option& within(int least, int most);
  Option& within(std::int64_t least, std::int64_t most);
  Option& within(double least, double most);
  Option& positive();
  Option& one_of(const std::vector<std::string>& words);
  Option& existing_folder();
  /// Otherwise an empty word is refused where a text is to stand.
  Option& may_be_empty();

 private:
  CLI::Option* option_;
};

/// One command of the command line, declared by who carries it out. A handle: the command line owns what it stands for,
/// and only `commands/` knows the library that parses it, which is slow to compile.
class Command {
 public:
  /// `chosen` gets the action of the command that is parsed.
  Command(CLI::App* app, Action* chosen) : app_(app), chosen_(chosen) {}

  /// A command within this one.
  [[nodiscard]] Command add(const std::string& name, const std::string& meaning);
  /// An option ("--joint", "-o,--output"), or a word in its place ("NAME"). The target must live as long as the action.
  Option option(const std::string& name, Target target, const std::string& meaning);
  Option flag(const std::string& name, bool* target, const std::string& meaning);
  /// Options of which just one must be given; the name shows in the help.
  [[nodiscard]] Command exactly_one(const std::string& name);
  /// It is called with one of its own commands, or with at most one.
  void needs_command();
  void may_have_command();

  /// Takes all words behind its name as they are, `--help` too: a program of its own reads them.
  void passes_on(std::vector<std::string>* words);

  /// What it does. Where a command within it is parsed too, that one is done instead.
  void does(Action action);

 private:
  CLI::App* app_;
  Action* chosen_;
};

/// Adds one command, or a family of them, to the command line.
using Registration = void (*)(Command& rmac);

}  // namespace rmac::cli
