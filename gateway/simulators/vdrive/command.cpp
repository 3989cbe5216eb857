#include "gateway/simulators/vdrive/command.hpp"

#include <fmt/format.h>

#include <charconv>
#include <functional>
#include <sstream>

namespace rmac::vdrive {
namespace {

using Action = std::function<void(Node&)>;

tl::unexpected<Error> refusal(const std::string& what) {
  return failure(MinorCode::InvalidParameterValue, what);
}

template <typename Number>
Expected<Number> number(const std::string& text, Number least, Number most) {
  std::string_view digits = text;
  const bool hexadecimal = digits.starts_with("0x");
  if (hexadecimal) digits.remove_prefix(2);
  Number value{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, hexadecimal ? 16 : 10);
  if (error != std::errc() || end != digits.data() + digits.size() || value < least || value > most) {
    return refusal(fmt::format("\"{}\" is no whole number from {} to {}", text, least, most));
  }
  return value;
}

Expected<bool> on_or_off(const std::string& text) {
  if (text == "on") return true;
  if (text == "off") return false;
  return refusal(fmt::format("\"{}\" is neither on nor off", text));
}

Expected<Action> action_of(const std::string& what, const std::string& how, Time now) {
  constexpr int kMostDelayMs = 60000;
  constexpr int kMostBytes = 8;
  constexpr std::int32_t kMostCounts = 1'000'000'000;
  if (what == "mute") {
    return on_or_off(how).map([](bool on) -> Action { return [on](Node& node) { node.outlet().set_mute(on); }; });
  }
  if (what == "slow") {
    return number(how, 0, kMostDelayMs).map([](int ms) -> Action {
      return [ms](Node& node) { node.outlet().set_delay(std::chrono::milliseconds(ms)); };
    });
  }
  if (what == "pdo") {
    return number(how, -kMostBytes, kMostBytes).map([](int bytes) -> Action {
      return [bytes](Node& node) { node.set_pdo_length_change(bytes); };
    });
  }
  if (what == "jump") {
    return number(how, -kMostCounts, kMostCounts).map([](std::int32_t counts) -> Action {
      return [counts](Node& node) { node.axis().shift_encoder(counts); };
    });
  }
  if (what == "hot") {
    return on_or_off(how).map([](bool on) -> Action { return [on](Node& node) { node.axis().set_overheated(on); }; });
  }
  if (what == "touch") {
    return on_or_off(how).map([](bool on) -> Action { return [on](Node& node) { node.axis().touch(on); }; });
  }
  if (what == "trip") {
    return number(how, 1, 0xFFFF).map([](int code) -> Action {
      return [code](Node& node) { node.axis().trip(static_cast<std::uint16_t>(code)); };
    });
  }
  if (what == "power") {
    return on_or_off(how).map([now](bool on) -> Action {
      return [on, now](Node& node) {
        if (on && !node.powered()) node.power_on(now);
        if (!on) node.power_off();
      };
    });
  }
  return refusal(fmt::format(
      "\"{}\" is not understood; there are mute, slow, pdo, jump, hot, touch, trip, power, status and help", what));
}

const char* nmt_name(const Node& node) {
  if (!node.powered()) return "off";
  switch (node.nmt_state()) {
    case Node::NmtState::Operational:
      return "operational";
    case Node::NmtState::PreOperational:
      return "pre-operational";
    case Node::NmtState::Stopped:
      return "stopped";
    default:
      return "initialising";
  }
}

std::string status_of(const Node& node) {
  const Axis& axis = node.axis();
  if (node.id() == LssSlave::kUnconfigured) return "a node without an id";
  return fmt::format("node {} {} {} at {:.0f} counts, {:.0f} counts/s, shaft at {:.0f}", node.id(), nmt_name(node),
                     to_string(axis.state()), axis.position(), axis.velocity(), axis.shaft());
}

}  // namespace

std::string_view command_help() {
  return "NODE is a node id or \"all\".\n"
         "  NODE mute on|off    hears and moves, and sends nothing\n"
         "  NODE slow MS        sends everything so much later; 0 ends it\n"
         "  NODE pdo BYTES      its PDOs are so much longer (or shorter, below 0) than mapped; 0 ends it\n"
         "  NODE jump COUNTS    its encoder's reading jumps\n"
         "  NODE hot on|off     too hot: fault 4310h, which a reset cannot clear before it is off\n"
         "  NODE touch on|off   the contact at its touch probe 1 closes, or opens\n"
         "  NODE trip CODE      a fault of this error code (603Fh), for example 0x7305\n"
         "  NODE power off|on   off and on again: all but what was stored (1010h) is forgotten\n"
         "  NODE status         what it does now\n"
         "  help";
}

Expected<std::string> execute(std::string_view line, Nodes& nodes, Time now) {
  std::istringstream words{std::string(line)};
  std::string who;
  std::string what;
  std::string how;
  std::string more;
  words >> who >> what >> how >> more;
  if (who == "help" && what.empty()) return std::string(command_help());
  if (who.empty() || what.empty() || !more.empty()) return refusal("a command is NODE, what, and a value: 1 mute on");
  int id = 0;
  if (who != "all") {
    const auto read = number(who, 1, 127);
    if (!read) return refusal("the node: " + read.error().message);
    id = *read;
  }
  Action action;
  if (what != "status" || !how.empty()) {
    auto read = action_of(what, how, now);
    if (!read) return tl::unexpected(read.error());
    action = std::move(*read);
  }
  std::string answer;
  for (auto& node : nodes) {
    if (id != 0 && node->id() != id) continue;
    if (action) action(*node);
    answer += (answer.empty() ? "" : "\n") +
              (action ? fmt::format("node {} {} {}", node->id(), what, how) : status_of(*node));
  }
  if (answer.empty()) return refusal(fmt::format("there is no node {} here", id));
  return answer;
}

Expected<Scheduled> read_scheduled(std::string_view text) {
  double seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  constexpr double kMost_s = 1e6;
  if (error != std::errc() || !(seconds >= 0 && seconds <= kMost_s) || end == text.data() + text.size() ||
      *end != ' ') {
    return refusal(fmt::format("\"{}\" does not begin with seconds and a blank: write \"2.5 1 mute on\"", text));
  }
  return Scheduled{std::chrono::duration_cast<Time>(std::chrono::duration<double>(seconds)),
                   std::string(text.substr(static_cast<std::size_t>(end - text.data()) + 1))};
}

}  // namespace rmac::vdrive
