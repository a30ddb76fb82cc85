// `hexhex help`: prints the help of a subcommand.
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "command.hpp"
#include "expected_words.hpp"

namespace hexhex::command {
namespace {

struct HelpArguments {
  std::string subcommand;
};

int run(const CLI::App& app, const HelpArguments& arguments) {
  const CLI::App* asked = &app;
  std::string name = app.get_name();
  for (const CLI::App* parser : app.get_subcommands({})) {
    if (parser->get_name() != arguments.subcommand) continue;
    asked = parser;
    name += " " + arguments.subcommand;
  }
  // app.help() would print the help of the subcommand that was given, which is this one.
  fmt::print("{}", app.get_formatter()->make_help(asked, name, CLI::AppFormatMode::Normal));
  return kSuccess;
}

}  // namespace

Command addHelp(CLI::App& app) {
  const auto arguments = std::make_shared<HelpArguments>();
  std::vector<std::string> names = {"help"};
  for (const CLI::App* parser : app.get_subcommands({})) names.push_back(parser->get_name());
  CLI::App* const parser = app.add_subcommand("help", "Explain a subcommand and its options");
  addValue(*parser, "SUBCOMMAND", arguments->subcommand, "NAME",
           "Which one [all of them, in short]")
      ->check(oneOf(names));
  return {parser, [&app, arguments] { return run(app, *arguments); }};
}

}  // namespace hexhex::command
