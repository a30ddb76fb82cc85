// `hexhex view`: a page that shows a mesh in any browser.
#include <memory>

#include <hexhex/curved.hpp>

#include "command.hpp"
#include "quantize_options.hpp"
#include "shared_options.hpp"
#include "view_page.hpp"

namespace hexhex::command {

Command addView(CLI::App& app) {
  const auto arguments = std::make_shared<ViewArguments>();
  CLI::App* const parser =
      app.add_subcommand("view", "Write a page that shows a mesh in any browser");
  parser
      ->add_option(
          "MESH", arguments->mesh,
          "The mesh, in any format that `hexhex info` reads, .vtu also\nwith cells of higher "
          "order; or a map, whose mesh is\nextracted")
      ->required()
      ->option_text("FILE REQUIRED");
  parser->add_option("-o,--output", arguments->page, "The page [the mesh's name with .html]")
      ->option_text("FILE");
  parser
      ->add_option("--map", arguments->map,
                   "The map that the mesh came from: the page tells\nwhether they agree")
      ->option_text("FILE");
  addHexesOnly(*parser, arguments->hexesOnly);
  addScale(*parser, arguments->options.scale,
           "The scale that the mesh was extracted with, or shall be");
  CLI::Option* const order =
      parser
          ->add_option("--order", arguments->order,
                       "Order of the cells that are extracted: curved from 2 on,\nup to 9")
          ->check(wholeNumberFrom(1))
          ->check(CLI::Range(1, kMaxOrder))
          ->option_text("INTEGER [1]");
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
