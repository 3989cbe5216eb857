// Texts name functions of the API: to tell which one refuses, and which one helps. The method table says what there is.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "gateway/api/methods/method_table.hpp"
#include "places.hpp"

namespace rmac::gateway {
namespace {

/// Words of texts that look like a function's name and are none: fields of device.json and of register maps, kinds of
/// events, names of settings, and beginnings of names.
const std::set<std::string> kOtherWords{"ControlMethod", "CycleDeadline", "CycleMode",      "CycleStateChanged",
                                        "CycleTime_s",   "HomeCounts",    "Machine_MoveIn", "Machine_MoveTo",
                                        "MoveAlong",     "MoveDone",      "MoveID",         "MoveStarted",
                                        "MoveTo",        "OpenRPC",       "ProbeReady",     "ProgramStopped",
                                        "ReadBack",      "ResetFault",    "ResetTime",      "SearchDistance"};

struct Names {
  std::set<std::string> methods, interfaces, functions, verbs, parameters;
};

/// "Set" of "SetFeedrate" and of "Machine_SetMechanismJointType"; empty for a word of one part, such as "Home".
std::string verb_of(std::string word) {
  if (word.starts_with("Machine_")) word.erase(0, std::string("Machine_").size());
  static const std::regex kFirstPart("^([A-Z][a-z]+)[A-Z]");
  std::smatch found;
  return std::regex_search(word, found, kFirstPart) ? found[1].str() : "";
}

const Names& names() {
  static const Names kNames = [] {
    Names result;
    for (const Method& method : method_table()) {
      const std::size_t dot = method.name.find('.');
      const std::string function = dot == std::string::npos ? method.name : method.name.substr(dot + 1);
      result.methods.insert(method.name);
      result.functions.insert(function);
      for (const auto& parameter : method.parameters) result.parameters.insert(parameter.name);
      if (dot != std::string::npos) result.interfaces.insert(method.name.substr(0, dot));
      if (const std::string verb = verb_of(function); !verb.empty()) result.verbs.insert(verb);
    }
    return result;
  }();
  return kNames;
}

/// The string literals of a source, comments and includes left out.
std::vector<std::string> literals_of(const std::string& source) {
  static const std::regex kToken(
      R"re(//[^\n]*|/\*[^]*?\*/|#include[^\n]*|'(?:\\.|[^'\\\n])'|R"(\w*)\(([^]*?)\)\1"|"((?:\\.|[^"\\\n])*)")re");
  std::vector<std::string> literals;
  for (std::sregex_iterator token(source.begin(), source.end(), kToken), end; token != end; ++token) {
    for (const std::size_t group : {std::size_t{2}, std::size_t{3}}) {
      if ((*token)[group].length() > 0) literals.push_back((*token)[group].str());
    }
  }
  return literals;
}

/// The words of a text that mean a function of the API which does not exist.
std::set<std::string> strangers_among(const std::string& text) {
  static const std::regex kWord(R"([A-Za-z_]\w*(?:\.[A-Za-z_]\w*)?)");
  std::set<std::string> strangers;
  for (std::sregex_iterator found(text.begin(), text.end(), kWord), end; found != end; ++found) {
    const std::string word = found->str();
    const std::size_t dot = word.find('.');
    const bool strange = dot != std::string::npos
                             ? names().interfaces.contains(word.substr(0, dot)) && !names().methods.contains(word)
                             : names().verbs.contains(verb_of(word)) && !names().functions.contains(word) &&
                                   !names().parameters.contains(word);
    if (strange && !kOtherWords.contains(word)) strangers.insert(word);
  }
  return strangers;
}

/// Words in the texts of a source that mean a function of the API which does not exist.
std::set<std::string> strangers_in(const std::string& source) {
  std::set<std::string> strangers;
  for (const std::string& text : literals_of(source)) strangers.merge(strangers_among(text));
  return strangers;
}

std::string contents_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(NamesInTexts, AreFoundWhenThereIsNoSuchFunction) {
  using testing::ElementsAre;
  EXPECT_THAT(strangers_in(R"(refuse("SetFeedrat: must be above 0");)"), ElementsAre("SetFeedrat"));
  EXPECT_THAT(strangers_in(R"(send("RMAC_CAM.Feedhold");)"), ElementsAre("RMAC_CAM.Feedhold"));
  EXPECT_THAT(strangers_in(R"(send("Device.SetFeedrate");)"), ElementsAre("Device.SetFeedrate"))
      << "it is another interface's";
  EXPECT_THAT(strangers_in(R"(refuse("hold it with FeedHold, then say \"RMAC_CAM.ParkProgram\"");)"), ElementsAre());
  EXPECT_THAT(strangers_in("call(\"SetFeedrate\");  // not \"SetFeedrat\"\n"), ElementsAre());
}

TEST(NamesInTexts, AreThoseOfTheMethodTable) {
  int sources = 0;
  for (const char* area : {"gateway", "drivers", "fieldbus", "motion"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(RMAC_SOURCE_DIR) + "/" + area)) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
      EXPECT_THAT(strangers_in(contents_of(entry.path())), testing::IsEmpty()) << entry.path();
      ++sources;
    }
  }
  EXPECT_GT(sources, 300);
}

TEST(NamesInDocs, AreThoseOfTheMethodTable) {
  static const std::regex kFullName(R"((\w+)\.([A-Z]\w*))");
  int named = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(RMAC_SOURCE_DIR) + "/docs")) {
    if (entry.path().extension() != ".md") continue;
    const std::string text = contents_of(entry.path());
    for (std::sregex_iterator found(text.begin(), text.end(), kFullName), end; found != end; ++found) {
      if (!names().interfaces.contains((*found)[1].str())) continue;
      EXPECT_TRUE(names().methods.contains(found->str())) << found->str() << " in " << entry.path();
      ++named;
    }
  }
  EXPECT_GT(named, 200);
}

}  // namespace
}  // namespace rmac::gateway
