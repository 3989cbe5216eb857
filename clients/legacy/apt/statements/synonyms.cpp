#include "clients/legacy/apt/statements/synonyms.hpp"

#include <fmt/format.h>

namespace rmac::apt {

void Synonyms::add(Arguments& arguments) {
  do {
    const std::string other = arguments.word("a new word");
    const std::size_t place = arguments.last_place();
    if (!words_.emplace(other, arguments.word("the word that it stands for")).second)
      refuse(place, fmt::format("SYN: {} stands for something already", other));
  } while (!arguments.done());
}

void Synonyms::replace(std::string& word) const {
  const auto found = words_.find(word);
  if (found != words_.end()) word = found->second;
}

void Synonyms::replace_in(Element& element) const {
  if (element.kind != Element::Kind::Assigned) replace(element.word);
  for (Element& inner : element.inner) replace_in(inner);
}

void Synonyms::replace_in(Statement& statement) const {
  if (words_.empty() || statement.is_text || statement.major == "SYN") return;
  replace(statement.major);
  for (Element& element : statement.elements) replace_in(element);
}

}  // namespace rmac::apt
