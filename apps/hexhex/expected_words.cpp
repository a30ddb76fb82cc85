#include "expected_words.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/core.h>

namespace hexhex::command {
namespace {

/// Number of characters to insert, remove, replace or swap with a neighbour (Damerau-Levenshtein
/// distance, restricted to one edit per position).
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> beforeLast(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(beforeLast, last);
    std::swap(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      const bool isSwap = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (isSwap) row[j] = std::min(row[j], beforeLast[j - 2] + 1);
    }
  }
  return row.back();
}

/// The long names of a parser's options, with dashes.
std::vector<std::string> optionNames(const CLI::App& parser) {
  std::vector<std::string> names;
  for (const CLI::Option* option : parser.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

}  // namespace

std::string suggestionFor(std::string_view written, const std::vector<std::string>& words) {
  const std::string* nearest = nullptr;
  std::size_t least = std::max<std::size_t>(1, written.size() / 3) + 1;  // a third may be wrong
  for (const std::string& word : words) {
    const bool isBegun = written.size() >= 3 && word.starts_with(written);
    const std::size_t cost = isBegun ? 1 : distance(written, word);
    if (cost >= least) continue;
    least = cost;
    nearest = &word;
  }
  return nearest == nullptr ? std::string() : fmt::format(" Did you mean {}?", *nearest);
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const char* const before = i + 1 < words.size() ? ", " : " or ";
    text += (i == 0 ? "" : before) + words[i];
  }
  return text;
}

std::string wrapped(std::string text) {
  constexpr std::size_t kWidth = 62;
  std::size_t begin = 0;
  while (text.size() - begin > kWidth) {
    std::size_t end = text.find('\n', begin);
    if (end - begin > kWidth) end = text.rfind(' ', begin + kWidth);
    if (end == std::string::npos || end < begin) break;
    text[end] = '\n';
    begin = end + 1;
  }
  return text;
}

CLI::Validator oneOf(std::vector<std::string> words) {
  const auto check = [words = std::move(words)](const std::string& word) -> std::string {
    if (std::find(words.begin(), words.end(), word) != words.end()) return {};
    return fmt::format("there is no \"{}\"; choose {}.{}", word, listed(words),
                       suggestionFor(word, words));
  };
  return CLI::Validator(check, "");
}

std::string unexpectedAsText(const CLI::App& app) {
  const std::vector<std::string> rest = app.remaining(true);
  if (rest.empty()) return {};
  const auto isOption = [](const std::string& word) { return word.starts_with('-'); };
  const auto option = std::find_if(rest.begin(), rest.end(), isOption);
  const std::vector<CLI::App*> given = app.get_subcommands();
  if (option != rest.end()) {
    // "--sclae=2" is about "--sclae".
    const std::string name = option->substr(0, option->find('='));
    const CLI::App& parser = given.empty() ? app : *given.front();
    return fmt::format("There is no option {}.{}", name, suggestionFor(name, optionNames(parser)));
  }
  if (!given.empty()) return fmt::format("Unexpected argument \"{}\".", rest.front());
  std::vector<std::string> names;
  for (const CLI::App* parser : app.get_subcommands({})) names.push_back(parser->get_name());
  return fmt::format("There is no subcommand \"{}\".{}", rest.front(),
                     suggestionFor(rest.front(), names));
}

}  // namespace hexhex::command
