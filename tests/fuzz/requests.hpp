#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "gateway/api/dispatch/dispatcher.hpp"

namespace rmac::fuzz {

/// Requests to a machine, one a line. The last byte of a line, where it is none of JSON's, says how many cycles pass
/// after it.
class Requests {
 public:
  Requests(std::string_view text, int most_cycles) : text_(text), most_cycles_(most_cycles) {}

  /// `call` for each that is a request, with method and parameters, and `pass` after each line, with the cycles.
  template <typename Call, typename Pass>
  void for_each(Call&& call, Pass&& pass) const {
    std::string_view rest = text_;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      std::string_view text = rest.substr(0, end);
      rest.remove_prefix(std::min(end + 1, rest.size()));
      int cycles = 1;
      if (!text.empty() && text.back() != '}' && text.back() != ']') {
        cycles = static_cast<unsigned char>(text.back()) % most_cycles_;
        text.remove_suffix(1);
      }
      const auto message = gateway::parse_line(text);
      if (message && message->is_object() && message->contains("method") && (*message)["method"].is_string())
        call((*message)["method"].get<std::string>(), message->value("params", nlohmann::json()));
      pass(cycles);
    }
  }

 private:
  std::string_view text_;
  int most_cycles_;
};

}  // namespace rmac::fuzz
