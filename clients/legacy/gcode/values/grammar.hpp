#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

namespace rmac::gcode {

/// A value, or a vacant one, where a language has those.
using Maybe = std::optional<double>;

/// A binary operator. Of equal levels the left one comes first.
struct Operator {
  std::string_view word;
  int level = 0;  ///< 1 binds least
  double (*apply)(double left, double right, std::size_t place) = nullptr;
  /// What it is where a side is vacant; null where a vacant side is 0.
  double (*with_vacant)(bool both) = nullptr;
};

/// A function of one value (degrees where it has an angle), or of two with a comma between them.
struct Function {
  std::string_view word;
  double (*apply)(double value, std::size_t place) = nullptr;
  double (*apply_two)(double first, double second, std::size_t place) = nullptr;
};

/// How a language writes values. Of its words, one that another begins with stands behind it.
struct Grammar {
  std::span<const Operator> operators;
  std::span<const Function> functions;
  double (*atan)(double y, double x) = nullptr;  ///< of ATAN[y]/[x], in degrees
  bool named = false;                            ///< parameters may have names, and EXISTS asks for them
  bool atan_of_one = false;                      ///< ATAN[y] and ATAN[y,x] are there, too
  bool comparisons_stand_alone = false;          ///< no two operators of the least level without brackets
  int first = 1, last = 0;                       ///< numbers that a parameter may have
};

/// What stands behind a `#`: a number, or a name.
using Name = std::variant<int, std::string_view>;

/// The parameters of a program.
class Variables {
 public:
  Variables() = default;
  virtual ~Variables() = default;
  Variables(const Variables&) = delete;
  Variables& operator=(const Variables&) = delete;

  /// None where it is vacant. Throws a Refusal where it has no value that is known.
  [[nodiscard]] virtual Maybe value(const Name& name, std::size_t place) const = 0;
  [[nodiscard]] virtual bool is_set(const Name& name) const = 0;
};

}  // namespace rmac::gcode
