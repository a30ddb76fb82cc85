// "Did you mean ...?"
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

namespace hexhex::command {

/// " Did you mean extract?", if one of the words is near to what was written; otherwise nothing.
[[nodiscard]] std::string suggestionFor(std::string_view written,
                                        const std::vector<std::string>& words);

/// "atlas or propeller"
[[nodiscard]] std::string listed(const std::vector<std::string>& words);

/// Accepts these words only; otherwise says which there are.
[[nodiscard]] CLI::Validator oneOf(std::vector<std::string> words);

/// An option whose values have names.
template <class Value>
CLI::Option* addChoice(CLI::App& parser, const std::string& name, Value& value,
                       const std::map<std::string, Value>& choices,
                       const std::string& description) {
  std::vector<std::string> words;
  words.reserve(choices.size());
  for (const auto& choice : choices) words.push_back(choice.first);
  const auto take = [&value, choices](const std::string& word) { value = choices.at(word); };
  return parser.add_option_function<std::string>(name, take, description)->check(oneOf(words));
}

/// What the command line of a parser holds that nothing expects, as a sentence; empty if all was
/// expected.
[[nodiscard]] std::string unexpectedAsText(const CLI::App& app);

}  // namespace hexhex::command
