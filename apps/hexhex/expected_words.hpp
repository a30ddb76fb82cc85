// Options with values, and "Did you mean ...?"
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

/// The same text with longer lines broken at spaces, as --help shows them.
[[nodiscard]] std::string wrapped(std::string text);

/// An option or argument.
/// @param hint  what --help says of its value: "FILE REQUIRED", "NUMBER [0.3]"
template <class Value>
CLI::Option* addValue(CLI::App& parser, const std::string& name, Value& value,
                      const std::string& hint, const std::string& description) {
  return parser.add_option(name, value, wrapped(description))->option_text(hint);
}

/// An option whose values have names.
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

/// What the command line of a parser holds that nothing expects, as a sentence; empty if all was
/// expected.
[[nodiscard]] std::string unexpectedAsText(const CLI::App& app);

}  // namespace hexhex::command
