#include "rmac/fieldbus/gpio/gpio_config.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>

#include "parameters.hpp"

namespace rmac::fieldbus::gpio {
namespace {

constexpr std::size_t kBits = 64;

Time milliseconds(double count) {
  return Time(std::llround(count * 1e6));
}

/// The bit of a parameter `input_3`; none for other names.
std::optional<std::size_t> bit_of(const std::string& parameter, const std::string& prefix) {
  if (!parameter.starts_with(prefix)) return {};
  std::size_t bit = kBits;
  const char* const begin = parameter.data() + prefix.size();
  const char* const end = parameter.data() + parameter.size();
  const auto [rest, trouble] = std::from_chars(begin, end, bit);
  if (trouble != std::errc() || rest != end || bit >= kBits) return {};
  return bit;
}

class Reader {
 public:
  Reader(const std::map<std::string, std::vector<double>>& numbers, const std::map<std::string, std::string>& texts)
      : texts_(texts), parameters_("GPIOInterface", "", "", numbers, texts), chip_(parameters_.text("chip", "")) {}

  Expected<GpioConfig> read() {
    GpioConfig config;
    config.disagreement = milliseconds(parameters_.number("contact_ms", 100, 1, 10'000, Parameters::Kind::Any));
    const double debounce_ms = parameters_.number("debounce_ms", 20, 0, 10'000, Parameters::Kind::Any);
    for (const auto& [name, ignored] : texts_) {
      if (const auto bit = bit_of(name, "input_")) {
        const double own_ms =
            parameters_.number(fmt::format("debounce_ms_{}", *bit), debounce_ms, 0, 10'000, Parameters::Kind::Any);
        config.inputs.push_back({*bit, lines(name, 2), milliseconds(own_ms)});
      } else if (const auto output = bit_of(name, "output_")) {
        auto line = lines(name, 1);
        if (!line.empty() && line.front().bias != Bias::AsIs) {
          parameters_.refuse(fmt::format("{}: pull-up, pull-down and no-bias are for inputs", name));
        }
        if (!line.empty()) config.outputs.push_back({*output, std::move(line.front())});
      }
    }
    if (config.inputs.empty() && config.outputs.empty()) {
      parameters_.refuse(
          "no line is named; give input_0 to input_63 and output_0 to output_63, for example \"input_0\": \"estop\"");
    }
    parameters_.refuse_unknown();
    if (!parameters_.sound()) return failure(MinorCode::InvalidParameterValue, parameters_.problem());
    return config;
  }

 private:
  /// `[!][chip:]name[/bias]`, as many as `most` with spaces between.
  std::vector<LineSpec> lines(const std::string& parameter, std::size_t most) {
    std::vector<LineSpec> found;
    std::istringstream words(parameters_.text(parameter, ""));
    for (std::string word; words >> word;) {
      LineSpec line = read_line(parameter, word);
      if (!taken_.emplace(line.chip, line.name).second) {
        parameters_.refuse(fmt::format("{}: line {} of chip {} is named twice", parameter, line.name, line.chip));
      }
      found.push_back(std::move(line));
    }
    if (found.empty() || found.size() > most) {
      parameters_.refuse(fmt::format("{} names {} lines; it takes {}", parameter, found.size(),
                                     most == 1 ? "one" : "one, or the two contacts of one switch"));
    }
    return found;
  }

  LineSpec read_line(const std::string& parameter, std::string word) {
    LineSpec line;
    line.inverted = word.starts_with('!');
    if (line.inverted) word.erase(0, 1);
    if (const std::size_t slash = word.rfind('/'); slash != std::string::npos) {
      static const std::map<std::string, Bias> kBiases{
          {"pull-up", Bias::PullUp}, {"pull-down", Bias::PullDown}, {"no-bias", Bias::None}};
      // A slash may be part of a chip's path.
      if (const auto bias = kBiases.find(word.substr(slash + 1)); bias != kBiases.end()) {
        line.bias = bias->second;
        word.erase(slash);
      }
    }
    const std::size_t colon = word.rfind(':');
    line.chip = colon == std::string::npos ? chip_ : word.substr(0, colon);
    line.name = colon == std::string::npos ? word : word.substr(colon + 1);
    if (line.chip.empty()) {
      parameters_.refuse(
          fmt::format("{}: the chip of line \"{}\" is not named; give \"chip\", or CHIP:LINE; gpiodetect "
                      "lists the chips",
                      parameter, line.name));
    }
    if (line.name.empty()) parameters_.refuse(fmt::format("{}: the line is not named; gpioinfo lists them", parameter));
    return line;
  }

  const std::map<std::string, std::string>& texts_;
  Parameters parameters_;
  std::string chip_;
  std::set<std::pair<std::string, std::string>> taken_;
};

}  // namespace

Expected<GpioConfig> read_gpio_config(const std::map<std::string, std::vector<double>>& numbers,
                                      const std::map<std::string, std::string>& texts) {
  return Reader(numbers, texts).read();
}

}  // namespace rmac::fieldbus::gpio
