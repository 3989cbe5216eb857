#pragma once

#include <map>
#include <string>

#include "clients/legacy/apt/statements/arguments.hpp"

namespace rmac::apt {

/// SYN: other words for the language's.
class Synonyms {
 public:
  /// SYN/new,word,new,word,…
  void add(Arguments& arguments);
  /// Puts the language's words in the places of the others.
  void replace_in(Statement& statement) const;

 private:
  void replace(std::string& word) const;
  void replace_in(Element& element) const;

  std::map<std::string, std::string> words_;
};

}  // namespace rmac::apt
