#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "clients/legacy/apt/statements/refusal.hpp"
#include "clients/legacy/apt/statements/statement.hpp"

namespace rmac::apt {

/// Reads the elements of a statement, or of a group, one behind the other. What is not as it was asked for is refused
/// at its place; end() refuses what nobody took, so that nothing is passed over.
class Arguments {
 public:
  explicit Arguments(const Statement& statement)
      : elements_(statement.elements), major_(statement.major), place_(statement.place) {}
  explicit Arguments(const Element& group) : elements_(group.inner), major_(group.word), place_(group.place) {}

  [[nodiscard]] const std::string& major() const noexcept { return major_; }
  /// Of the statement.
  [[nodiscard]] std::size_t place() const noexcept { return place_; }
  [[nodiscard]] bool done() const noexcept { return at_ == elements_.size(); }
  /// Of the next element, or of the statement where there is none.
  [[nodiscard]] std::size_t next_place() const noexcept { return done() ? place_ : elements_[at_].place; }
  /// Of the one that was taken last.
  [[nodiscard]] std::size_t last_place() const noexcept { return at_ == 0 ? place_ : elements_[at_ - 1].place; }

  [[nodiscard]] bool has_number() const noexcept { return is(Element::Kind::Number); }
  [[nodiscard]] bool has_word() const noexcept { return is(Element::Kind::Word); }
  /// Takes the word where it is the next one.
  [[nodiscard]] bool take(std::string_view word);
  /// The next word. `expected` tells what may stand here.
  const std::string& word(std::string_view expected);
  double number(std::string_view expected);
  /// A whole number within 0 and `most`.
  int integer(std::string_view expected, int most);
  /// A group of this major word.
  const Element& group(std::string_view word);
  /// The next element, whatever it is.
  const Element& any(std::string_view expected);
  /// All numbers that follow, of which there are as many as one of `counts`.
  std::vector<double> numbers(std::initializer_list<std::size_t> counts, std::string_view expected);
  void end() const;
  /// Leaves the rest unread: it describes, and changes nothing.
  void pass() noexcept { at_ = elements_.size(); }

 private:
  [[nodiscard]] bool is(Element::Kind kind) const noexcept { return !done() && elements_[at_].kind == kind; }
  [[noreturn]] void refuse_next(std::string_view expected) const;

  const std::vector<Element>& elements_;
  const std::string& major_;
  std::size_t place_, at_ = 0;
};

}  // namespace rmac::apt
