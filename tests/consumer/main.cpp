#include <cstring>
#include <iostream>

#include <hexhex/hexhex.hpp>

int main() {
  try {
    if (std::strcmp(hexhex::version(), HEXHEX_VERSION) != 0) return 1;
    const hexhex::Sample sample = hexhex::generateSample(hexhex::SampleKind::Sphere);
    const hexhex::HexMesh mesh = hexhex::extract(sample.map);
    hexhex::Extractor extractor(sample.map);
    const hexhex::HexMesh fine = extractor.extract(2);
    if (hexhex::canQuantize()) {  // with what the library links or loads for it
      hexhex::Context context;
      const hexhex::MeshOptions options = {
          .shape = {}, .quantize = {.cells = 500, .densify = true}, .improve = {}};
      const hexhex::MeshedPart part =
          hexhex::meshFromTets({sample.map.points, sample.map.tets}, options, context);
      if (!part.improvement.after.allPositive()) return 1;
    }
    std::cout << mesh.cells.size() << " and " << fine.cells.size() << " hexahedra\n";
    return hexhex::verify(sample.map, mesh).passed() && fine.cells.size() == 8 * mesh.cells.size()
               ? 0
               : 1;
  } catch (const hexhex::Error& error) {  // thrown by the library, caught by its name here
    std::cerr << error.what() << '\n';
    return 1;
  }
}
