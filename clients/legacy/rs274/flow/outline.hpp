#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clients/legacy/rs274/flow/statement.hpp"

namespace rmac::rs274 {

/// The O words of a program, each with those that it belongs to. They are read once, before anything is carried out,
/// and as far as they can be understood: what cannot is the Trouble, which counts where a program comes to it.
class Outline {
 public:
  /// `block_delete`: lines that begin with / are left out. Never throws a Refusal.
  Outline(std::string_view program, bool block_delete);

  /// In the order of their lines. Where there is a Trouble, the last of them may miss what they belong to.
  [[nodiscard]] const std::vector<Statement>& statements() const noexcept { return statements_; }

  /// Index of what `o100 sub` or, where it is `numbered`, a bare `O100` begins.
  [[nodiscard]] std::optional<std::size_t> find(const std::string& label, bool numbered) const;

  struct Trouble {
    std::size_t line = 0, begin = 0;  ///< of the source, as in Statement
    std::size_t place = 0;            ///< in Line::text()
    std::string message;
  };
  [[nodiscard]] const std::optional<Trouble>& trouble() const noexcept { return trouble_; }

 private:
  struct Block {
    std::size_t begin = 0, last = 0;  ///< the latter of an if: its elseif or else that was read last
  };

  void read(std::string_view program, bool block_delete);
  void add(Statement statement);
  void open(std::size_t index);
  void close(std::size_t index, Keyword opening);
  void go_on_with_if(std::size_t index);
  void leave(std::size_t index);
  void require_none_open(const Statement& statement) const;
  [[nodiscard]] const Statement& around() const { return statements_[open_.back().begin]; }
  void declare(std::size_t index);
  void require_innermost(std::size_t index, Keyword opening) const;

  std::vector<Statement> statements_;
  std::vector<Block> open_;  ///< blocks that have no end yet, the innermost last
  std::map<std::string, std::size_t> subs_, programs_;
  std::optional<Trouble> trouble_;
};

}  // namespace rmac::rs274
