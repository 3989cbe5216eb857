#include "gateway/rmac/commands/command.hpp"

#include <CLI/CLI.hpp>

namespace rmac::cli {

namespace {

constexpr const char* kFilled = "filled";

/// Whose empty word a command would take for none at all: a shell makes one of a variable that is not set.
bool is_text(const Target& target) {
  return std::holds_alternative<std::string*>(target) || std::holds_alternative<std::filesystem::path*>(target) ||
         std::holds_alternative<std::optional<std::string>*>(target);
}

}  // namespace

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::takes(int values) {
  option_->expected(values);
  return *this;
}

Option& Option::repeats() {
  option_->allow_extra_args(false);
  return *this;
}

Option& Option::shows_default() {
  option_->capture_default_str();
  return *this;
}

Option& Option::reads_environment(const std::string& variable) {
  option_->envname(variable);
  return *this;
}

Option& Option::needs(const Option& other) {
  option_->needs(other.option_);
  return *this;
}

Option& Option::excludes(const std::vector<std::string>& others) {
  for (const std::string& other : others) option_->excludes(other);
  return *this;
}

Option& Option::within(int least, int most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option& Option::within(std::int64_t least, std::int64_t most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option& Option::within(double least, double most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option& Option::positive() {
  option_->check(CLI::PositiveNumber);
  return *this;
}

Option& Option::one_of(const std::vector<std::string>& words) {
  option_->check(CLI::IsMember(words));
  return *this;
}

Option& Option::existing_folder() {
  option_->check(CLI::ExistingDirectory);
  return *this;
}

Option& Option::may_be_empty() {
  option_->get_validator(kFilled)->active(false);
  return *this;
}

Command Command::add(const std::string& name, const std::string& meaning) {
  return {app_->add_subcommand(name, meaning), chosen_};
}

Option Command::option(const std::string& name, Target target, const std::string& meaning) {
  CLI::Option* const added = std::visit([&](auto* value) { return app_->add_option(name, *value, meaning); }, target);
  if (is_text(target)) {
    const auto filled = [](const std::string& word) -> std::string { return word.empty() ? "is empty" : ""; };
    added->check(CLI::Validator(filled, "", kFilled));
  }
  return Option(added);
}

Option Command::flag(const std::string& name, bool* target, const std::string& meaning) {
  return Option(app_->add_flag(name, *target, meaning));
}

Command Command::exactly_one(const std::string& name) {
  return {app_->add_option_group(name)->require_option(1), chosen_};
}

void Command::needs_command() {
  app_->require_subcommand(1);
}

void Command::may_have_command() {
  app_->require_subcommand(0, 1);
}

void Command::passes_on(std::vector<std::string>* words) {
  app_->set_help_flag();
  app_->fallthrough(false);
  app_->allow_extras();
  app_->prefix_command();
  app_->parse_complete_callback([app = app_, words] { *words = app->remaining(); });
}

void Command::does(Action action) {
  // A command within this one is told first.
  app_->callback([chosen = chosen_, action = std::move(action)] {
    if (!*chosen) *chosen = action;
  });
}

}  // namespace rmac::cli
