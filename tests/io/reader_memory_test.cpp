// Memory and time of readers, by the size of the file: large good files of all formats, and files
// that are made to be expensive, with counts beyond all measure, tiny parts without number, and
// numbers as short as can be. No reader may take more than twenty times the size of its file (of
// what it is decompressed to), or time out of proportion.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>
#include <support/compressions.hpp>
#include <support/status_bytes.hpp>

#include <hexhex/curved.hpp>
#include <hexhex/io.hpp>
#include <hexhex/samples.hpp>
#include <hexhex/summary.hpp>

#include <io/core/compressed_blocks.hpp>
#include <io/io_test_support.hpp>

namespace hexhex::test {

using namespace io;
namespace {

constexpr std::size_t kFactor = 20;
/// Buffers, slabs of pages and tables of fixed size.
constexpr std::size_t kConstant = std::size_t{16} << 20;

/// What a process took.
struct Cost {
  std::size_t bytes = 0;  ///< resident, at its peak, beyond what it began with
  double seconds = 0;     ///< of processors
};

double secondsOf(int who) {
  rusage usage{};
  ::getrusage(who, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Calls work() in a process of its own, where no memory that others have freed hides what it
/// takes.
Cost costOf(const std::function<void()>& work) {
  std::array<int, 2> ends{};
  EXPECT_EQ(::pipe(ends.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    std::ofstream("/proc/self/clear_refs") << "5" << std::flush;  // the peak begins anew
    const std::size_t before = statusBytes("VmRSS:");
    const double begin = secondsOf(RUSAGE_SELF);
    try {
      work();
    } catch (...) {
      ::_exit(1);
    }
    const Cost cost{statusBytes("VmHWM:") - before, secondsOf(RUSAGE_SELF) - begin};
    ::_exit(::write(ends[1], &cost, sizeof cost) == sizeof cost ? 0 : 1);
  }
  ::close(ends[1]);
  Cost cost;
  EXPECT_EQ(::read(ends[0], &cost, sizeof cost), static_cast<ssize_t>(sizeof cost));
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  return cost;
}

/// One public function that reads files.
struct Reader {
  const char* name;
  const char* extensions;  ///< of files that it knows
  std::function<void(const std::filesystem::path& file, Context& context)> read;
};

const std::vector<Reader>& readers() {
  constexpr const char* kMeshes = ".mesh .meshb .vtu .vtk .ovm .ovmb .msh .inp .exo";
  static const std::vector<Reader> kReaders = {
      {"map", ".hexex .vtu .vtk .ovm .ovmb",
       [](const auto& file, Context& context) { static_cast<void>(readMap(file, context)); }},
      {"mesh", kMeshes,
       [](const auto& file, Context& context) { static_cast<void>(readHexMesh(file, context)); }},
      {"tets", ".hexex .mesh .meshb .vtu .vtk .ovm .ovmb .msh .inp .exo",
       [](const auto& file, Context& context) {
         static_cast<void>(readTetMesh(file, {}, context));
       }},
      {"summary", kMeshes,
       [](const auto& file, Context& context) { static_cast<void>(summarizeFile(file, context)); }},
      {"lagrange", ".vtu .vtk .inp .exo", [](const auto& file, Context& context) {
         static_cast<void>(readLagrangeMesh(file, context));
       }}};
  return kReaders;
}

/// The cost of a reader; Errors are fine.
Cost costOf(const Reader& reader, const std::filesystem::path& file) {
  return costOf([&] {
    Context context(1);
    try {
      reader.read(file, context);
    } catch (const Error& error) {
      if (error.code() == ErrorCode::Internal || error.code() == ErrorCode::OutOfMemory) ::abort();
    }
  });
}

/// A file that is made to be expensive.
struct Bomb {
  std::string name;                                    ///< of the file
  std::function<std::string(std::size_t bytes)> make;  ///< with about as many bytes of content
};

std::string repeated(std::string_view unit, std::size_t bytes) {
  std::string text;
  text.reserve(bytes + unit.size());
  while (text.size() < bytes) text += unit;
  return text;
}

/// The lines unit(0), unit(1), ...
template <class Unit>
std::string numbered(std::size_t bytes, const Unit& unit) {
  std::string text;
  text.reserve(bytes + 100);
  for (std::size_t i = 0; text.size() < bytes; ++i) text += unit(std::to_string(i));
  return text;
}

std::string number(std::size_t n) { return std::to_string(n); }

/// The bytes of numbers, as they are in memory.
template <class... Numbers>
std::string bytesOf(Numbers... numbers) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&numbers), sizeof numbers), ...);
  return bytes;
}

void addHexexBombs(std::vector<Bomb>& bombs) {
  bombs.push_back(
      {"counts.hexex", [](std::size_t n) { return "99999999999\n" + repeated("0 0 0\n", n); }});
  bombs.push_back({"points.hexex", [](std::size_t n) {
                     return number(n / 6) + "\n" + repeated("0 0 0\n", n / 6 * 6) + "0\n";
                   }});
  bombs.push_back({"tets.hexex", [](std::size_t n) {
                     return "1\n0 0 0\n" + number(n / 32) + "\n" +
                            repeated("0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n", n / 32 * 32);
                   }});
  bombs.push_back({"walls.hexex", [](std::size_t n) {
                     return "1\n0 0 0\n0\n" + number(n / 8) + "\n" +
                            repeated("0 0 0 0\n", n / 8 * 8);
                   }});
  bombs.push_back({"features.hexex", [](std::size_t n) {
                     const std::size_t points = n / 16;
                     return number(points) + "\n" + repeated("0 0 0\n", 6 * points) + "0\n" +
                            number(points) + " 0 0\n" +
                            numbered(n / 2, [](const auto& i) { return i + "\n"; });
                   }});
  bombs.push_back({"edges.hexex", [](std::size_t n) {
                     const std::size_t points = n / 20;
                     std::string edges;
                     for (std::size_t i = 1; i < points; ++i) edges += "0 " + number(i) + "\n";
                     return number(points) + "\n" + repeated("0 0 0\n", 6 * points) + "0\n0 " +
                            number(points - 1) + " 0\n" + edges;
                   }});
  bombs.push_back({"line.hexex", [](std::size_t n) { return "1 0 0 " + repeated("1", n); }});
  bombs.push_back({"space.hexex", [](std::size_t n) { return "1 0 0 " + repeated(" ", n); }});
}

void addMeditBombs(std::vector<Bomb>& bombs) {
  const std::string head = "MeshVersionFormatted 2\nDimension 3\n";
  bombs.push_back({"counts.mesh", [=](std::size_t n) {
                     return head + "Vertices 99999999999\n" + repeated("0 0 0 0\n", n);
                   }});
  bombs.push_back({"points.mesh", [=](std::size_t n) {
                     return head + "Vertices " + number(n / 8) + "\n" +
                            repeated("0 0 0 1\n", n / 8 * 8) + "Hexahedra 0\nTetrahedra 0\n";
                   }});
  bombs.push_back({"cells.mesh", [=](std::size_t n) {
                     return head + "Vertices 1\n0 0 0 0\nHexahedra " + number(n / 18) + "\n" +
                            repeated("1 1 1 1 1 1 1 1 2\n", n / 18 * 18);
                   }});
  bombs.push_back({"edges.mesh", [=](std::size_t n) {
                     return head + "Vertices 1\n0 0 0 0\nEdges " + number(n / 6) + "\n" +
                            repeated("1 1 2\n", n / 6 * 6) + "Hexahedra 0\n";
                   }});
  bombs.push_back({"sections.mesh", [=](std::size_t n) {
                     return head + "Vertices 1\n0 0 0 0\nHexahedra 0\n" + repeated("Edges 0\n", n);
                   }});
  bombs.push_back({"full-sections.mesh", [=](std::size_t n) {
                     return head + "Vertices 1\n0 0 0 0\nHexahedra 0\n" +
                            repeated("Edges 1 1 1 7\n", n);
                   }});
  bombs.push_back({"unknown.mesh", [=](std::size_t n) { return head + repeated("Abc 1 2\n", n); }});
  bombs.push_back({"comments.mesh", [=](std::size_t n) {
                     return head + repeated("# a\n", n) + "Vertices 1\n0 0 0 0\nHexahedra 0\n";
                   }});
  bombs.push_back({"sections.meshb", [](std::size_t n) {
                     std::string bytes = bytesOf(1, 2);
                     bytes += bytesOf(3, static_cast<int>(bytes.size() + 12), 3);
                     while (bytes.size() < n) {
                       bytes += bytesOf(77, static_cast<int>(bytes.size() + 8));
                     }
                     return bytes;
                   }});
  bombs.push_back({"points.meshb", [](std::size_t n) {
                     std::string bytes = bytesOf(1, 1) + bytesOf(3, 20, 3);  // single precision
                     const std::size_t count = n / 16;
                     bytes +=
                         bytesOf(4, static_cast<int>(32 + 16 * count), static_cast<int>(count)) +
                         std::string(16 * count, '\1');
                     return bytes + bytesOf(10, 0, 0);
                   }});
  bombs.push_back({"counts.meshb", [](std::size_t n) {
                     return bytesOf(1, 2) + bytesOf(3, 20, 3) + bytesOf(4, 0, 2000000000) +
                            std::string(n, '\0');
                   }});
}

std::string vtu(const std::string& attributes, const std::string& piece, const std::string& rest) {
  return "<VTKFile type=\"UnstructuredGrid\" " + attributes + "><UnstructuredGrid><Piece " + piece +
         ">" + rest;
}

std::string asciiArray(const std::string& type, const std::string& name, const std::string& text) {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" format=\"ascii\">" + text +
         "</DataArray>";
}

/// Bytes as an array of a compressed `.vtu` file, in blocks of a megabyte.
std::string compressed(const std::string& bytes) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  const std::size_t blocks = (bytes.size() + kBlock - 1) / kBlock;
  std::string head =
      bytesOf(std::uint64_t{blocks}, std::uint64_t{kBlock}, std::uint64_t{bytes.size() % kBlock});
  Array<char> body;
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::size_t before = body.size();
    deflateBlock(std::span(bytes).subspan(i * kBlock, std::min(kBlock, bytes.size() - i * kBlock)),
                 body);
    head += bytesOf(std::uint64_t{body.size() - before});
  }
  return head.append(body.data(), body.size());
}

/// A compressed mesh, which takes about a thousandth of its content without cells, and a thirtieth
/// with as many hexahedra as points.
std::string compressedMesh(std::size_t elements, bool cells) {
  const std::size_t cellCount = cells ? elements : 0;
  std::string offsets;
  for (std::size_t i = 0; i < cellCount; ++i) offsets += bytesOf(std::uint64_t{8 * (i + 1)});
  const std::array<std::string, 4> arrays = {
      compressed(std::string(24 * elements, '\0')), compressed(std::string(64 * cellCount, '\0')),
      compressed(offsets), compressed(std::string(cellCount, '\x0c'))};
  std::size_t at = 0;
  const auto array = [&](const char* type, const char* name, std::size_t i) {
    const std::string offset = number(at);
    at += arrays[i].size();
    return std::string("<DataArray type=\"") + type + "\" Name=\"" + name +
           "\" NumberOfComponents=\"" + (i == 0 ? "3" : "1") + "\" format=\"appended\" offset=\"" +
           offset + "\"/>";
  };
  std::string tags = "<Points>" + array("Float64", "Points", 0) + "</Points><Cells>";
  tags += array("Int64", "connectivity", 1);
  tags += array("Int64", "offsets", 2);
  tags += array("UInt8", "types", 3);
  return vtu("header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"",
             "NumberOfPoints=\"" + number(elements) + "\" NumberOfCells=\"" + number(cellCount) +
                 "\"",
             tags + "</Cells></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_") +
         arrays[0] + arrays[1] + arrays[2] + arrays[3];
}

void addVtuBombs(std::vector<Bomb>& bombs) {
  const std::string none = "NumberOfPoints=\"0\" NumberOfCells=\"0\"";
  bombs.push_back({"deep.vtu", [=](std::size_t n) { return vtu("", none, repeated("<a>", n)); }});
  bombs.push_back({"open.vtu", [=](std::size_t n) { return vtu("", none, repeated("<", n)); }});
  bombs.push_back({"before.vtu", [](std::size_t n) { return repeated("<?a?>", n); }});
  bombs.push_back(
      {"comments.vtu", [=](std::size_t n) { return vtu("", none, repeated("<!---->", n)); }});
  bombs.push_back({"attributes.vtu",
                   [=](std::size_t n) { return vtu(repeated("a='' ", n), none, "</Piece>"); }});
  bombs.push_back({"piece-attributes.vtu", [=](std::size_t n) {
                     return vtu("", repeated("a='' ", n) + none, "</Piece>");
                   }});
  for (const char* section : {"PointData", "CellData", "FieldData", "Cells"}) {
    bombs.push_back({std::string("arrays-") + section + ".vtu", [=](std::size_t n) {
                       return vtu("", none,
                                  "<" + std::string(section) + ">" + repeated("<DataArray/>", n));
                     }});
    bombs.push_back({std::string("named-arrays-") + section + ".vtu", [=](std::size_t n) {
                       return vtu("", none,
                                  "<" + std::string(section) + ">" +
                                      repeated("<DataArray Name='12345678901234567'/>", n));
                     }});
  }
  bombs.push_back(
      {"ascii.vtu", [](std::size_t n) {
         const std::size_t cells = n / 40;
         const std::string count = number(cells);
         return vtu("", "NumberOfPoints=\"" + count + "\" NumberOfCells=\"" + count + "\"",
                    "<Points>" + asciiArray("Float64", "Points", repeated("0 ", 6 * cells)) +
                        "</Points><Cells>" +
                        asciiArray("Int64", "connectivity", repeated("0 ", 16 * cells)) +
                        asciiArray("Int64", "offsets",
                                   numbered(8 * cells, [](const auto& i) { return i + " "; })) +
                        asciiArray("UInt8", "types", repeated("12 ", 3 * cells)) + "</Cells>");
       }});
  bombs.push_back({"empty-cells.vtu", [](std::size_t n) {
                     const std::size_t cells = n / 4;
                     return vtu("", "NumberOfPoints=\"0\" NumberOfCells=\"" + number(cells) + "\"",
                                "<Cells>" + asciiArray("Int64", "connectivity", "") +
                                    asciiArray("Int64", "offsets", repeated("0 ", 2 * cells)) +
                                    asciiArray("UInt8", "types", repeated("1 ", 2 * cells)) +
                                    "</Cells>");
                   }});
  // Arrays that are the same bytes of the file.
  bombs.push_back(
      {"same-bytes.vtu", [](std::size_t n) {
         const std::string count = number(n);
         const auto array = [](const std::string& type, const std::string& name) {
           return "<DataArray type=\"" + type + "\" Name=\"" + name +
                  "\" format=\"appended\" offset=\"0\"/>";
         };
         return vtu("header_type=\"UInt64\"",
                    "NumberOfPoints=\"0\" NumberOfCells=\"" + count + "\"",
                    "<CellData>" + array("UInt8", "region") + "</CellData><Cells>" +
                        array("UInt8", "types") + array("UInt8", "offsets") +
                        array("UInt8", "connectivity") +
                        "</Cells></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_") +
                bytesOf(std::uint64_t{n}) + std::string(n, '\0');
       }});
  bombs.push_back(
      {"many-blocks.vtu", [](std::size_t n) {
         const std::uint64_t blocks = n / 8;
         std::string bytes = bytesOf(blocks, std::uint64_t{1}, std::uint64_t{0});
         bytes += repeated(bytesOf(std::uint64_t{0}), 8 * blocks);
         return vtu("header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"",
                    "NumberOfPoints=\"9\" NumberOfCells=\"0\"",
                    "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
                    "format=\"appended\" offset=\"0\"/></Points></Piece></UnstructuredGrid>"
                    "<AppendedData encoding=\"raw\">_") +
                bytes;
       }});
  if (!hasZlib()) return;
  bombs.push_back({"zip-points.vtu", [](std::size_t n) { return compressedMesh(n / 24, false); }});
  bombs.push_back({"zip-cells.vtu", [](std::size_t n) { return compressedMesh(n / 97, true); }});
  // Promises of much, and none of it is there.
  bombs.push_back(
      {"zip-lies.vtu", [](std::size_t n) {
         const std::uint64_t size = 1032 * n;
         return vtu("header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"",
                    "NumberOfPoints=\"" + number(size / 24) + "\" NumberOfCells=\"0\"",
                    "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
                    "format=\"appended\" offset=\"0\"/></Points></Piece></UnstructuredGrid>"
                    "<AppendedData encoding=\"raw\">_") +
                bytesOf(std::uint64_t{1}, size / 24 * 24, std::uint64_t{0}, std::uint64_t{n}) +
                std::string(n, '\7');
       }});
}

void addVtkBombs(std::vector<Bomb>& bombs) {
  const std::string head = "# vtk DataFile Version 2.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\n";
  const std::string small = head + "POINTS 1 double\n0 0 0\nCELLS 0 0\nCELL_TYPES 0\n";
  bombs.push_back({"points.vtk", [=](std::size_t n) {
                     return head + "POINTS " + number(n / 6) + " float\n" +
                            repeated("0 0 0\n", n / 6 * 6) + "CELLS 0 0\nCELL_TYPES 0\n";
                   }});
  bombs.push_back({"empty-cells.vtk", [=](std::size_t n) {
                     const std::string count = number(n / 4);
                     return head + "POINTS 0 float\nCELLS " + count + " " + count + "\n" +
                            repeated("0\n", n / 4 * 2) + "CELL_TYPES " + count + "\n" +
                            repeated("1\n", n / 4 * 2);
                   }});
  bombs.push_back({"uneven-cells.vtk", [=](std::size_t n) {
                     const std::size_t cells = n / 10;
                     return head + "POINTS 1 float\n0 0 0\nCELLS " + number(2 * cells) + " " +
                            number(3 * cells) + "\n" + repeated("0\n1 0\n", 6 * cells) +
                            "CELL_TYPES " + number(2 * cells) + "\n" + repeated("1\n", 4 * cells);
                   }});
  bombs.push_back({"fields.vtk", [=](std::size_t n) {
                     return small + "FIELD a " + number(n / 12) + "\n" +
                            repeated("b 1 0 double\n", n);
                   }});
  bombs.push_back({"fields-of-points.vtk", [=](std::size_t n) {
                     return small + "POINT_DATA 1\nFIELD a " + number(n / 15) + "\n" +
                            repeated("b 1 1 float\n1\n", n);
                   }});
  bombs.push_back({"fields-before.vtk", [=](std::size_t n) {
                     return head + "FIELD a " + number(n / 12) + "\n" + repeated("b 1 0 int\n", n);
                   }});
  bombs.push_back({"scalars.vtk", [=](std::size_t n) {
                     return head + "POINTS 0 double\nCELLS 0 0\nCELL_TYPES 0\nPOINT_DATA 0\n" +
                            repeated("SCALARS a int\n", n);
                   }});
  bombs.push_back({"vectors.vtk", [=](std::size_t n) {
                     return head + "POINTS 0 double\nCELLS 0 0\nCELL_TYPES 0\nPOINT_DATA 0\n" +
                            repeated("VECTORS a float\n", n);
                   }});
  bombs.push_back(
      {"data.vtk", [=](std::size_t n) { return small + repeated("CELL_DATA 0\n", n); }});
  bombs.push_back(
      {"metadata.vtk", [=](std::size_t n) { return small + repeated("METADATA\n\n", n); }});
  bombs.push_back({"types.vtk", [](std::size_t n) {
                     return "# vtk DataFile Version 2.0\n\nBINARY\nDATASET UNSTRUCTURED_GRID\n"
                            "POINTS 0 float\nCELLS " +
                            number(n / 8) + " " + number(n / 8) + "\n" +
                            std::string(n / 8 * 4, '\0') + "\nCELL_TYPES " + number(n / 8) + "\n" +
                            std::string(n / 8 * 4, '\0');
                   }});
}

void addOvmBombs(std::vector<Bomb>& bombs) {
  const auto sections = [](const std::string& vertices, const std::string& edges,
                           const std::string& faces, const std::string& cells) {
    return "OVM ASCII\nVertices\n" + vertices + "Edges\n" + edges + "Faces\n" + faces +
           "Polyhedra\n" + cells;
  };
  bombs.push_back({"points.ovm", [=](std::size_t n) {
                     return sections(number(n / 6) + "\n" + repeated("0 0 0\n", n / 6 * 6), "0\n",
                                     "0\n", "0\n");
                   }});
  bombs.push_back({"edges.ovm", [=](std::size_t n) {
                     return sections("1\n0 0 0\n",
                                     number(n / 4) + "\n" + repeated("0 0\n", n / 4 * 4), "0\n",
                                     "0\n");
                   }});
  bombs.push_back({"faces.ovm", [=](std::size_t n) {
                     return sections("1\n0 0 0\n", "1\n0 0\n",
                                     number(n / 8) + "\n" + repeated("3 0 0 0\n", n / 8 * 8),
                                     "0\n");
                   }});
  bombs.push_back({"large-face.ovm", [=](std::size_t n) {
                     return sections("1\n0 0 0\n", "1\n0 0\n",
                                     "1\n" + number(n / 2) + " " + repeated("0 ", n / 2 * 2),
                                     "\n0\n");
                   }});
  bombs.push_back({"cells.ovm", [=](std::size_t n) {
                     return sections("1\n0 0 0\n", "1\n0 0\n", "1\n3 0 0 0\n",
                                     number(n / 10) + "\n" + repeated("4 0 0 0 0\n", n / 10 * 10));
                   }});
  bombs.push_back({"hexes.ovm", [=](std::size_t n) {
                     return sections(
                         "1\n0 0 0\n", "1\n0 0\n", "1\n4 0 0 0 0\n",
                         number(n / 14) + "\n" + repeated("6 0 0 0 0 0 0\n", n / 14 * 14));
                   }});
  bombs.push_back({"uneven.ovm", [=](std::size_t n) {
                     return sections(
                         "1\n0 0 0\n", "1\n0 0\n",
                         number(n / 18 * 2) + "\n" + repeated("3 0 0 0\n4 0 0 0 0\n", n / 18 * 18),
                         "0\n");
                   }});
  const std::string small = sections("1\n0 0 0\n", "0\n", "0\n", "0\n");
  bombs.push_back({"properties.ovm",
                   [=](std::size_t n) { return small + repeated("VProp int \"a\"\n0\n", n); }});
  bombs.push_back({"known-properties.ovm", [=](std::size_t n) {
                     return small + repeated("VProp int \"AlgoHex::FeatureVertices\"\n1\n", n);
                   }});
  bombs.push_back({"empty-properties.ovm",
                   [=](std::size_t n) { return small + repeated("CProp int \"\"\n", n); }});
  bombs.push_back({"strings.ovm",
                   [=](std::size_t n) { return small + repeated("VProp string \"a\"\n0:\n", n); }});
  bombs.push_back({"comments.ovm", [=](std::size_t n) { return repeated("#\n", n) + small; }});
}

/// A chunk of an `.ovmb` file, whose length is a multiple of 8.
std::string chunk(const std::string& type, std::string body) {
  const std::size_t padding = (8 - body.size() % 8) % 8;
  body.append(padding, '\0');
  return type + std::string{'\0', static_cast<char>(padding), '\0', '\1'} +
         bytesOf(std::uint64_t{body.size()}) + body;
}

std::string ovmb(std::uint64_t vertices, std::uint64_t edges, std::uint64_t faces,
                 std::uint64_t cells, const std::string& chunks) {
  return std::string("OVMB\n\r\n\xff", 8) + std::string{'\1', '\1', '\3', '\0'} +
         std::string(4, '\0') + bytesOf(vertices, edges, faces, cells) + chunks + chunk("EOF ", "");
}

/// @param valence  of all elements
std::string topology(char entity, std::uint32_t count, std::uint8_t valence) {
  return chunk("TOPO", bytesOf(std::uint64_t{0}, count) + std::string{entity} + bytesOf(valence) +
                           std::string{'\0', '\1'} + bytesOf(std::uint64_t{0}) +
                           std::string(std::size_t{count} * valence, '\0'));
}

std::string directoryEntry(char entity, const std::string& name, const std::string& type,
                           const std::string& value) {
  const auto text = [](const std::string& what) {
    return bytesOf(static_cast<std::uint32_t>(what.size())) + what;
  };
  return std::string{entity} + text(name) + text(type) + text(value);
}

void addOvmbBombs(std::vector<Bomb>& bombs) {
  const std::string point = chunk("VERT", bytesOf(std::uint64_t{0}, std::uint32_t{1}) +
                                              std::string{'\2', 0, 0, 0} + std::string(24, '\0'));
  const auto points = [](std::uint32_t count) {
    return chunk("VERT", bytesOf(std::uint64_t{0}, count) + std::string{'\1', 0, 0, 0} +
                             std::string(std::size_t{12} * count, '\0'));
  };
  bombs.push_back({"counts.ovmb", [=](std::size_t n) {
                     const std::uint64_t many = (std::uint64_t{1} << 31) - 2;
                     return ovmb(many, many, many, many, std::string(n, '\0'));
                   }});
  bombs.push_back({"points.ovmb", [=](std::size_t n) {
                     return ovmb(n / 12, 0, 0, 0, points(static_cast<std::uint32_t>(n / 12)));
                   }});
  bombs.push_back(
      {"chunks.ovmb", [=](std::size_t n) {
         return ovmb(
             1, 0, 0, 0,
             point + repeated(chunk("DIRP", "").replace(0, 4, "ABCD").replace(7, 1, 1, '\0'), n));
       }});
  bombs.push_back({"empty-chunks.ovmb", [=](std::size_t n) {
                     return ovmb(
                         0, 0, 0, 0,
                         repeated(chunk("VERT", bytesOf(std::uint64_t{0}, std::uint32_t{0}) +
                                                    std::string{'\1', 0, 0, 0}),
                                  n));
                   }});
  bombs.push_back({"payload-free-chunks.ovmb", [=](std::size_t n) {
                     return ovmb(0, 0, 0, 0, repeated(chunk("PROP", ""), n));
                   }});
  bombs.push_back({"point-chunks.ovmb", [=](std::size_t n) {
                     std::string chunks;
                     std::uint64_t count = 0;
                     while (chunks.size() < n) {
                       chunks +=
                           chunk("VERT", bytesOf(count++, std::uint32_t{1}) +
                                             std::string{'\1', 0, 0, 0} + std::string(12, '\0'));
                     }
                     return ovmb(count, 0, 0, 0, chunks);
                   }});
  bombs.push_back({"directory.ovmb", [=](std::size_t n) {
                     return ovmb(1, 0, 0, 0,
                                 point + chunk("DIRP", repeated(directoryEntry(0, "", "", ""), n)));
                   }});
  bombs.push_back({"edges.ovmb", [=](std::size_t n) {
                     const auto count = static_cast<std::uint32_t>(n / 2);
                     return ovmb(1, count, 0, 0, point + topology('\1', count, 2));
                   }});
  const auto withDefaults = [=](std::uint32_t faces, std::uint32_t cells, std::uint8_t valence,
                                const std::string& map) {
    const std::string zeros(24, '\0');
    return ovmb(
        1, 1, faces, cells,
        point + topology('\1', 1, 2) + topology('\2', faces, valence) +
            topology('\3', cells, valence == 3 ? 4 : 6) +
            chunk("DIRP", directoryEntry('\5', map, "3d", zeros) +
                              directoryEntry('\2', "AlgoHex::FeatureFaces", "i32", bytesOf(1)) +
                              directoryEntry('\1', "AlgoHex::FeatureEdges", "i32", bytesOf(1)) +
                              directoryEntry('\3', "hexhex::region", "i32", bytesOf(1))));
  };
  const std::string map = "HexHex::Parametrization";
  for (const std::uint8_t valence : {std::uint8_t{3}, std::uint8_t{4}}) {
    bombs.push_back({"faces-" + number(valence) + ".ovmb", [=](std::size_t n) {
                       return withDefaults(static_cast<std::uint32_t>(n / valence), 0, valence,
                                           map);
                     }});
    bombs.push_back({"cells-" + number(valence) + ".ovmb", [=](std::size_t n) {
                       return withDefaults(
                           1, static_cast<std::uint32_t>(n / (valence == 3 ? 4 : 6)), valence, map);
                     }});
  }
}

void addGmshBombs(std::vector<Bomb>& bombs) {
  const std::string head41 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  const std::string head22 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  const std::string node41 = "$Nodes\n1 1 1 1\n0 1 0 1\n1\n0 0 0\n$EndNodes\n";
  const std::string node22 = "$Nodes\n1\n1 0 0 0\n$EndNodes\n";
  bombs.push_back({"names.msh", [=](std::size_t n) {
                     return head41 + "$PhysicalNames\n1\n" +
                            numbered(n, [](const auto& i) { return "0 " + i + "\"region_1\"\n"; }) +
                            "$EndPhysicalNames\n" + node41;
                   }});
  bombs.push_back({"entities.msh", [=](std::size_t n) {
                     const std::string entities =
                         numbered(n, [](const auto& i) { return i + " 0 0 0 0\n"; });
                     return head41 + "$Entities\n" +
                            number(static_cast<std::size_t>(
                                std::count(entities.begin(), entities.end(), '\n'))) +
                            " 0 0 0\n" + entities + "$EndEntities\n" + node41;
                   }});
  bombs.push_back({"nodes41.msh", [=](std::size_t n) {
                     const std::string count = number(n / 8);
                     return head41 + "$Nodes\n1 " + count + " 1 1\n0 1 0 " + count + "\n" +
                            repeated("1\n", n / 8 * 2) + repeated("0 0 0\n", n / 8 * 6) +
                            "$EndNodes\n";
                   }});
  bombs.push_back({"sparse41.msh", [=](std::size_t n) {
                     const std::size_t count = n / 15;
                     std::string tags;
                     for (std::size_t i = 0; i < count; ++i)
                       tags += number(9000000000000000000U - 977 * i).substr(0, 8 + i % 9) + "\n";
                     return head41 + "$Nodes\n1 " + number(count) + " 1 1\n0 1 0 " + number(count) +
                            "\n" + tags + repeated("0 0 0\n", count * 6) + "$EndNodes\n";
                   }});
  bombs.push_back({"node-blocks.msh", [=](std::size_t n) {
                     return head41 + "$Nodes\n" + number(n / 8) + " 0 0 0\n" +
                            repeated("0 1 0 0\n", n / 8 * 8) + "$EndNodes\n";
                   }});
  bombs.push_back({"one-node-blocks.msh", [=](std::size_t n) {
                     std::string blocks;
                     std::size_t count = 0;
                     while (blocks.size() < n)
                       blocks += "0 1 0 1\n" + number(++count) + "\n0 0 0\n";
                     return head41 + "$Nodes\n" + number(count) + " " + number(count) + " 1 9\n" +
                            blocks + "$EndNodes\n" + "$Elements\n0 0 0 0\n$EndElements\n";
                   }});
  bombs.push_back({"element-blocks.msh", [=](std::size_t n) {
                     return head41 + node41 + "$Elements\n" + number(n / 9) + " 0 0 0\n" +
                            repeated("3 1 5 0\n", n / 8 * 8) + "$EndElements\n";
                   }});
  bombs.push_back({"one-element-blocks.msh", [=](std::size_t n) {
                     const std::size_t count = n / 26;
                     return head41 + node41 + "$Elements\n" + number(count) + " " + number(count) +
                            " 1 1\n" + repeated("3 1 5 1\n1 1 1 1 1 1 1 1 1\n", 26 * count) +
                            "$EndElements\n";
                   }});
  bombs.push_back({"points41.msh", [=](std::size_t n) {
                     const std::size_t count = n / 4;
                     return head41 + node41 + "$Elements\n1 " + number(count) + " 1 1\n0 1 15 " +
                            number(count) + "\n" + repeated("1 1\n", 4 * count) + "$EndElements\n";
                   }});
  bombs.push_back({"nodes22.msh", [=](std::size_t n) {
                     return head22 + "$Nodes\n" + number(n / 8) + "\n" +
                            repeated("1 0 0 0\n", n / 8 * 8) + "$EndNodes\n";
                   }});
  bombs.push_back({"elements22.msh", [=](std::size_t n) {
                     return head22 + node22 + "$Elements\n" + number(n / 22) + "\n" +
                            repeated("1 5 0 1 1 1 1 1 1 1 1\n", n / 22 * 22) + "$EndElements\n";
                   }});
  bombs.push_back({"points22.msh", [=](std::size_t n) {
                     return head22 + node22 + "$Elements\n" + number(n / 12) + "\n" +
                            repeated("1 15 1 2 1\n", n / 11 * 11) + "$EndElements\n";
                   }});
  bombs.push_back({"tags22.msh", [=](std::size_t n) {
                     return head22 + node22 + "$Elements\n1\n1 5 " + number(n / 2) +
                            repeated(" 1", n / 2 * 2) + "\n$EndElements\n";
                   }});
  bombs.push_back(
      {"sections.msh", [=](std::size_t n) { return head41 + repeated("$A\n$EndA\n", n); }});
  bombs.push_back(
      {"nameless.msh", [=](std::size_t n) { return head41 + repeated("$ $End\n", n); }});
}

void addAbaqusBombs(std::vector<Bomb>& bombs) {
  const std::string cube =
      "*Part, "
      "name=P\n*Node\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
      "*Element, type=C3D8\n1,1,2,3,4,5,6,7,8\n";
  const auto instances = [](std::size_t count) {
    std::string text = "*End Part\n*Assembly\n";
    for (std::size_t i = 0; i < count; ++i) {
      text += "*Instance, name=" + std::to_string(i) + ", part=P\n*End Instance\n";
    }
    return text;
  };
  constexpr std::size_t kCopies = 100;
  bombs.push_back({"copies.inp", [=](std::size_t n) {
                     return cube + repeated("9,1,2,3,4,5,6,7,8\n", n / kCopies) +
                            instances(kCopies);
                   }});
  bombs.push_back({"instances.inp", [=](std::size_t n) { return cube + instances(n / 150); }});
  bombs.push_back({"dots.inp", [=](std::size_t n) {
                     return cube + instances(1) + "*Elset, elset=a\n" + repeated(".", n) + "\n";
                   }});
  bombs.push_back({"parts.inp", [=](std::size_t n) {
                     return repeated("*Part\n", n / 2) + cube + instances(n / 300);
                   }});
}

std::vector<Bomb> allBombs() {
  std::vector<Bomb> bombs;
  addHexexBombs(bombs);
  addMeditBombs(bombs);
  addVtuBombs(bombs);
  addVtkBombs(bombs);
  addOvmBombs(bombs);
  addOvmbBombs(bombs);
  addGmshBombs(bombs);
  addAbaqusBombs(bombs);
  return bombs;
}

#if defined(HEXHEX_SANITIZED)
constexpr bool kSanitized = true;  // which takes memory and time of its own
#else
constexpr bool kSanitized = false;
#endif

/// Reads a file with all readers of its format; `small` is the same with a quarter of the content.
void expectInProportion(const std::filesystem::path& file, std::size_t content,
                        const std::filesystem::path& small) {
  const std::size_t allowed =
      kConstant + kFactor * std::max(content, std::filesystem::file_size(file));
  for (const Reader& reader : readers()) {
    if ((std::string(reader.extensions) + ' ').find(file.extension().string() + ' ') ==
        std::string::npos)
      continue;
    const Cost cost = costOf(reader, file);
    EXPECT_LE(cost.bytes, allowed) << file.filename() << ", " << reader.name;
    // Four times as much takes four times as long; if it grew with the square, sixteen times. What
    // takes no time shall not fail because of another process.
    const Cost less = costOf(reader, small);
    EXPECT_LE(cost.seconds, 8 * less.seconds + 0.2) << file.filename() << ", " << reader.name;
    if (std::getenv("HEXHEX_PRINT_COSTS") == nullptr) continue;
    std::printf("%-28s %-8s %5.1f bytes per byte, %6.1f MB/s\n", file.filename().c_str(),
                reader.name, static_cast<double>(cost.bytes) / static_cast<double>(content),
                1e-6 * static_cast<double>(content) / std::max(cost.seconds, 1e-6));
  }
}

TEST(ReaderCost, OfBombs) {
  if (kSanitized) GTEST_SKIP();
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "small");
  constexpr std::size_t kContent = std::size_t{2} << 20;
  for (const Bomb& bomb : allBombs()) {
    const std::filesystem::path small = folder.path() / "small" / bomb.name;
    writeText(folder / bomb.name, bomb.make(kContent));
    writeText(small, bomb.make(kContent / 4));
    expectInProportion(folder / bomb.name, kContent, small);
    std::filesystem::remove(folder / bomb.name);
    std::filesystem::remove(small);
  }
}

// Its first bytes tell that a file is no mesh; the rest of it is not read. Holes take no disk.
TEST(ReaderCost, OfLargeFilesThatAreNoMeshes) {
  if (kSanitized) GTEST_SKIP();
  constexpr std::size_t kSize = std::size_t{1} << 28;
  const TemporaryFolder folder;
  for (const std::string& head : {std::string(), std::string("PK\x03\x04"), std::string("<\0", 2),
                                  std::string(std::size_t{1} << 17, ' ')}) {
    for (const Reader& reader : readers()) {
      std::istringstream extensions(std::string(reader.extensions) + " .pvtu");
      for (std::string extension; extensions >> extension;) {
        const std::filesystem::path file = folder / ("large" + extension);
        writeText(file, head);
        std::filesystem::resize_file(file, kSize);
        EXPECT_LE(costOf(reader, file).bytes, kSize / 8) << file << ", " << reader.name;
      }
    }
  }
}

TEST(ReaderCost, OfGoodFiles) {
  if (kSanitized) GTEST_SKIP();
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "small");
  const HexMesh mesh = gridMesh(48, 32, 32);
  const HexMesh lessMesh = gridMesh(12, 32, 32);
  const auto mapOf = [](int refine) {
    SampleOptions options;
    options.refine = refine;
    options.charts = ChartStyle::Random;
    options.jitter = 0.05;
    options.features = true;
    return generateSample(SampleKind::Sphere, options).map;
  };
  const TetMap largeMap = mapOf(8);  // 43,008 tets
  const TetMap lessMap = mapOf(5);   // a quarter
  std::size_t files = 0;
  Context context;
  for (const FileFormat& format : fileFormats()) {
    for (const Compression compress : compressions()) {
      if (compress != Compression::None && !format.compresses) continue;
      const std::string name = std::string(format.name) + endingOf(compress);
      WriteOptions options;
      options.format = format.name;
      options.compress = compress;
      const auto fileOf = [&](const char* what) {
        return folder / (name + "-" + what + std::string(format.extension));
      };
      const auto smallOf = [&](const char* what) {
        return folder.path() / "small" / fileOf(what).filename();
      };
      if (format.readsMaps && format.writesMaps) {
        writeMap(largeMap, fileOf("map"), options, context);
        writeMap(lessMap, smallOf("map"), options, context);
        expectInProportion(fileOf("map"), std::filesystem::file_size(fileOf("map")),
                           smallOf("map"));
        ++files;
      }
      if (format.readsHexMeshes && format.writesHexMeshes) {
        writeHexMesh(mesh, fileOf("mesh"), options, context);
        writeHexMesh(lessMesh, smallOf("mesh"), options, context);
        expectInProportion(fileOf("mesh"), std::filesystem::file_size(fileOf("mesh")),
                           smallOf("mesh"));
        ++files;
      }
    }
  }
  EXPECT_GE(files, 15U);
}

}  // namespace
}  // namespace hexhex::test
