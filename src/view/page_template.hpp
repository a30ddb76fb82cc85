// The page without title and mesh. Its definition is made by viewer/build.mjs from viewer/src.
#pragma once

#include <string_view>

namespace hexhex::view {

/// The parts of the page around what is filled in, in this order.
struct PageTemplate {
  std::string_view beforeConnect;  ///< sources of data in the syntax of a Content-Security-Policy
  std::string_view beforeTitle;    ///< text, escaped for HTML
  std::string_view beforeInfo;     ///< JSON without '<'
  std::string_view beforeData;     ///< script elements with the mesh
  std::string_view end;
};

[[nodiscard]] const PageTemplate* pageTemplate();

}  // namespace hexhex::view
