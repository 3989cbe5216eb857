#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clients/legacy/gcode/blocks/line.hpp"

namespace rmac::fanuc {

/// A place between lines: where one begins in the text, and how many are before it.
struct Spot {
  std::size_t at = 0, lines = 0;
  auto operator<=>(const Spot&) const = default;
};

/// O1234, from its line to the next of this kind. What stands before the first is a program without a number.
struct FanucProgram {
  static constexpr int kUnnumbered = -1;

  int number = kUnnumbered;
  Spot begin, end;  ///< the former: of the line with its number
};

/// From WHILE or DO to its END.
struct Loop {
  std::size_t program = 0;
  int number = 0;
  Spot begin, behind, end;  ///< before and behind the line that begins it; behind the line of its END
};

/// Where the programs and loops of a file are. They are found before anything is carried out.
class Outline {
 public:
  explicit Outline(std::string_view text);

  struct Trouble {
    Spot line;
    std::size_t place = 0;  ///< in Line::text()
    std::string message;
  };
  /// Why the file is none; then the rest tells nothing.
  [[nodiscard]] const std::optional<Trouble>& trouble() const noexcept { return trouble_; }

  [[nodiscard]] const std::vector<FanucProgram>& programs() const noexcept { return programs_; }
  /// The program of a number.
  [[nodiscard]] std::optional<std::size_t> find(int number) const;
  [[nodiscard]] const Loop& loop(std::size_t index) const { return loops_.at(index); }
  /// The loop that the line at this spot begins.
  [[nodiscard]] std::optional<std::size_t> loop_at(const Spot& spot) const;
  /// The loops that a spot of a program is within, the outermost first.
  [[nodiscard]] std::vector<std::size_t> loops_around(std::size_t program, const Spot& spot) const;
  /// The line N of this number in a program: the next behind a spot, or from the program's begin.
  [[nodiscard]] std::optional<Spot> find_label(std::size_t program, int label, const Spot& from);
  /// How many lines of a program have this N.
  [[nodiscard]] std::size_t labels(std::size_t program, int label) { return labels_of(program).count(label); }

 private:
  void read(std::string_view text);
  void begin_program(const gcode::Line& line, std::size_t place, const Spot& spot);
  void begin_loop(const gcode::Line& line, std::size_t place, const Spot& spot, const Spot& behind);
  void end_loop(const gcode::Line& line, std::size_t place, const Spot& behind);
  void require_loops_ended() const;
  [[nodiscard]] const std::multimap<int, Spot>& labels_of(std::size_t program);

  std::string_view text_;
  std::vector<FanucProgram> programs_;
  std::map<int, std::size_t> by_number_;
  std::vector<Loop> loops_;
  std::map<Spot, std::size_t> loop_at_;
  std::vector<std::size_t> open_;
  std::map<std::size_t, std::multimap<int, Spot>> labels_;  ///< of programs that somebody asked for
  std::optional<Trouble> trouble_;
};

}  // namespace rmac::fanuc
