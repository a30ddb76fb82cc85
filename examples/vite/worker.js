// The library, away from the page, which stays fluid meanwhile.
import { load } from "hexhex";

const library = load();

self.onmessage = async ({ data }) => {
  const hexhex = await library;
  try {
    const map = data ? hexhex.readMap(data.bytes, data.name) : hexhex.generate("sphere");
    const mesh = hexhex.extract(map);
    const { passed } = hexhex.verify(mesh, map);
    self.postMessage(`${mesh.cells.length / 8} hexahedra, ${passed ? "verified" : "not those of the map"}`);
    mesh.free();
    map.free();
  } catch (error) {
    self.postMessage(error.message);
  }
};
