// Options with values, and suggestions for misspelt words.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

namespace hexhex::command {

/// " Did you mean extract?" if one of the words is close to what was written; otherwise empty.
[[nodiscard]] std::string suggestionFor(std::string_view written,
                                        const std::vector<std::string>& words);

/// Joins words: "atlas or propeller".
[[nodiscard]] std::string listed(const std::vector<std::string>& words);

/// Accepts only these words; the error lists them.
[[nodiscard]] CLI::Validator oneOf(std::vector<std::string> words);

/// Breaks longer lines at spaces, for --help.
[[nodiscard]] std::string wrapped(std::string text);

/// Adds an option or argument.
/// @param hint  shown by --help after its name: "FILE REQUIRED", "NUMBER [0.3]"
template <class Value>
CLI::Option* addValue(CLI::App& parser, const std::string& name, Value& value,
                      const std::string& hint, const std::string& description) {
  return parser.add_option(name, value, wrapped(description))->option_text(hint);
}

/// Adds an option with named values.
template <class Value>
CLI::Option* addChoice(CLI::App& parser, const std::string& name, Value& value,
                       const std::string& hint, const std::map<std::string, Value>& choices,
                       const std::string& description) {
  std::vector<std::string> words;
  words.reserve(choices.size());
  for (const auto& choice : choices) words.push_back(choice.first);
  const auto take = [&value, choices](const std::string& word) { value = choices.at(word); };
  return parser.add_option_function<std::string>(name, take, wrapped(description))
      ->check(oneOf(words))
      ->option_text(hint);
}

/// A sentence about unexpected words on the command line; empty if there are none.
[[nodiscard]] std::string unexpectedAsText(const CLI::App& app);

}  // namespace hexhex::command
