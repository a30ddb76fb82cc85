// The smallest useful program: a map goes in, a hexahedral mesh comes out.
#include <iostream>

#include <hexhex/hexhex.hpp>

int main(int argc, char** argv) {
  try {
    const hexhex::TetMap map = argc > 1 ? hexhex::readMap(argv[1])
                                        : hexhex::generateSample(hexhex::SampleKind::Sphere).map;
    const hexhex::HexMesh mesh = hexhex::extract(map);
    hexhex::writeHexMesh(mesh, argc > 2 ? argv[2] : "mesh.vtu");
    std::cout << map.tets.size() << " tets -> " << mesh.cells.size() << " hexahedra\n";
    return hexhex::verify(map, mesh).passed() ? 0 : 1;
  } catch (const hexhex::Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
