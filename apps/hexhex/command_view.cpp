// `hexhex view`: writes a page that shows a mesh in any browser.
#include <memory>

#include <hexhex/curved.hpp>

#include "command.hpp"
#include "expected_words.hpp"
#include "quantize_options.hpp"
#include "shared_options.hpp"
#include "view_page.hpp"

namespace hexhex::command {

Command addView(CLI::App& app) {
  const auto arguments = std::make_shared<ViewArguments>();
  CLI::App* const parser =
      app.add_subcommand("view", "Write a page that shows a mesh in any browser");
  addValue(*parser, "MESH", arguments->mesh, "FILE REQUIRED",
           "The mesh, in any format that `hexhex info` reads, .vtu also\nwith cells of higher "
           "order; or a map, whose mesh is\nextracted")
      ->required();
  addValue(*parser, "-o,--output", arguments->page, "FILE",
           "The page [the mesh's name with .html]");
  addValue(*parser, "--map", arguments->map, "FILE",
           "The map that the mesh came from: the page says whether\nthey agree");
  addHexesOnly(*parser, arguments->hexesOnly);
  addScale(*parser, arguments->options.scale,
           "The scale that the mesh was extracted with, or is to be");
  CLI::Option* const order =
      addValue(*parser, "--order", arguments->order, "INTEGER [1]",
               "Order of the cells that are extracted: curved from 2 on,\nup to 9")
          ->check(wholeNumberFrom(1))
          ->check(CLI::Range(1, kMaxOrder));
  addCurvedNodes(*parser, arguments->curvedNodes, order);
  addQuantization(*parser, arguments->quantize, arguments->quantizeOptions);
  addTolerance(*parser, arguments->options.tolerance);
  parser->add_flag("--open", arguments->open, "Open the page in the default browser");
  addRunOptions(*parser, arguments->run);
  parser->footer(
      "Exit code 4: the mesh does not agree with the map; the page is written and says so.\n\n"
      "Examples:\n  hexhex view sphere.vtu --map sphere.hexex --scale 2\n"
      "  hexhex view sphere.hexex --order 3 --open\n"
      "  hexhex view seamless.hexex --quantize --cells 5000");
  return {parser, [arguments] { return view(*arguments); }};
}

}  // namespace hexhex::command
