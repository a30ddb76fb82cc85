#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <locale>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fill/mesher.hpp>
#include <fill/program.hpp>
#include <fill_script.hpp>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>

#include <base/concat.hpp>
#include <base/vector3.hpp>

namespace hexhex::fill {
namespace {

/// edge^3 / volume of a regular tet.
const double kRegularTet = 6 * std::sqrt(2.0);

/// Writes numbers in the C locale, whatever the user's.
class Text {
 public:
  explicit Text(const std::filesystem::path& file) : out_(file) {
    constexpr int kExact = 17;
    out_.imbue(std::locale::classic());
    out_.precision(kExact);
  }
  template <class T>
  Text& operator<<(const T& value) {
    out_ << value;
    return *this;
  }
  void close(const std::filesystem::path& file) {
    out_.close();
    if (!out_) throw Error(ErrorCode::FileWrite, file.string() + ": the file cannot be written.");
  }

 private:
  std::ofstream out_;
};

/// Writes a text file with exact coordinates.
void writeStl(const TriangleMesh& surface, const std::filesystem::path& file) {
  Text out(file);
  out << "solid part\n";
  for (const std::array<Index, 3>& triangle : surface.triangles) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const Index v : triangle) {
      const Vec3& p = surface.points[v];
      out << "vertex " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
    }
    out << "endloop\nendfacet\n";
  }
  out << "endsolid part\n";
  out.close(file);
}

/// Begins what a mesher, or its script, says to the user.
constexpr const char* kNote = "note: ";

/// The Gmsh script for the task. Solids that touch are glued.
void writeGeo(const Task& task, const std::filesystem::path& file) {
  Text out(file);
  if (task.surface != nullptr) {
    out << "Merge \"part.stl\";\nClassifySurfaces{" << task.featureAngle
        << "*Pi/180, 1, 1, Pi};\nCreateGeometry;\nSurface Loop(1) = Surface{:};\nVolume(1) = {1};\n"
        << "size = " << task.tetSize << ";\n";
  } else {
    const auto addVolume = [&out](const char* sum) {
      out << "all() = Volume{:};\n"
          << sum << " = 0;\nFor i In {0:#all() - 1}\n"
          << "  mass() = Mass Volume{all(i)};\n  " << sum << " += mass(0);\nEndFor\n";
    };
    out << "SetFactory(\"OpenCASCADE\");\nMerge \"part.step\";\n";
    addVolume("apart");
    out << "If (#all() > 1)\n  BooleanFragments{ Volume{all()}; Delete; }{}\nEndIf\n";
    addVolume("volume");
    out << "If (volume < (1 - 1e-6) * apart)\n  Printf(\"" << kNote
        << "Solids overlap; what several have in common is a region of its own.\");\nEndIf\n"
        << "size = " << task.tetSize << ";\nIf (size == 0)\n  size = (" << kRegularTet
        << " * volume / " << task.tets << ")^(1/3);\nEndIf\n";
  }
  out << "Mesh.MeshSizeMax = size;\n";
  out.close(file);
}

/// The script's output file, which has names of groups; output of other runners has none.
constexpr const char* kNamed = "part.msh";

/// A way to run a mesher.
struct Runner {
  std::vector<std::string> words;
  std::string name;  ///< empty: the program reports it
  int codeIfMissing = ProgramEnd::kNotFound;
  std::string result = "part.mesh";
};

std::string python() {
  const char* const named = std::getenv("HEXHEX_PYTHON");
  if (named == nullptr || *named == '\0') return "python3";
  const std::string name = named;
  return name.find('/') == std::string::npos ? name : std::filesystem::absolute(name).string();
}

std::string asWord(double number) {
  std::array<char, 32> room{};
  const auto end = std::to_chars(room.data(), room.data() + room.size(), number);
  return {room.data(), end.ptr};
}

/// Whether parts of a STEP file are placed in an assembly.
bool isAssembly(const std::filesystem::path& step) {
  std::ifstream in(step, std::ios::binary);
  std::string line;
  while (std::getline(in, line)) {
    if (line.find("NEXT_ASSEMBLY_USAGE_OCCURRENCE") != std::string::npos) return true;
  }
  return false;
}

/// Runners in order of preference. Netgen reads names of faces and solids, but none in assemblies;
/// Gmsh reads those of an assembly's parts.
std::vector<Runner> runnersFor(const Task& task, Mesher mesher, int threads) {
  const bool isStep = task.surface == nullptr;
  std::vector<Runner> runners;
  const auto isWanted = [&](Mesher each) { return mesher == Mesher::Auto || mesher == each; };
  const auto addPackage = [&](const char* name) {
    constexpr int kNotThere = 3;  // exit code of the script
    runners.push_back({{python(), "-c", kScript, name, isStep ? "part.step" : "part.stl",
                        asWord(task.tetSize), asWord(task.tets), std::to_string(threads)},
                       "",
                       kNotThere});
  };
  if (isWanted(Mesher::TetWild) && !isStep) addPackage("tetwild");
  const bool isNetgenLast = isStep && mesher == Mesher::Auto && isAssembly(task.step);
  if (isWanted(Mesher::Netgen) && !isNetgenLast) addPackage("netgen");
  if (isWanted(Mesher::Gmsh)) {
    addPackage("gmsh");
    if (isNetgenLast) addPackage("netgen");
    runners.push_back({{"gmsh", "-nopopup", "-3", "part.geo", "-o", "part.mesh"}, "gmsh"});
  }
  if (isWanted(Mesher::TetGen) && !isStep) {
    const double volume = std::pow(task.tetSize, 3) / kRegularTet;
    runners.push_back({{"tetgen", "-pqgQa" + asWord(volume), "part.stl"}, "tetgen"});
    runners.back().result = "part.1.mesh";
  }
  return runners;
}

/// The last lines of a program's output, joined into one.
std::string lastLines(std::string_view said) {
  constexpr std::size_t kLines = 12;
  std::string text;
  for (std::size_t i = 0; i < kLines && !said.empty(); ++i) {
    const std::size_t end = said.rfind('\n');
    const bool isFirst = end == std::string_view::npos;
    const std::string_view line = isFirst ? said : said.substr(end + 1);
    said = isFirst ? std::string_view() : said.substr(0, end);
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    text.insert(0, text.empty() ? "" : " | ").insert(0, line);
  }
  return text.empty() ? "It said nothing." : "It said: " + text;
}

/// @param said  output of the runners that failed to start
[[noreturn]] void failWithoutMesher(const Task& task, Mesher mesher, const std::string& said) {
  const bool isStep = task.surface == nullptr;
  const std::array<std::string, 5> advice = {
      isStep ? "none is installed that reads STEP. Try `pip install netgen-mesher` or `pip install "
               "gmsh`"
             : "none is installed. Try `pip install pytetwild`; netgen-mesher, gmsh and the "
               "program tetgen do, too",
      "pytetwild is not installed. Try `pip install pytetwild`",
      "netgen-mesher is not installed. Try `pip install netgen-mesher`",
      "gmsh is not installed. Try `pip install gmsh`", "the program tetgen is not installed"};
  throw Error(ErrorCode::FileUnsupported,
              task.name + ": a mesher has to fill it with tets, and " +
                  advice[static_cast<std::size_t>(mesher)] +
                  ". Python packages are looked for with " + python() +
                  " (the variable HEXHEX_PYTHON names another Python)." +
                  (said.empty() ? "" : " " + lastLines(said)));
}

[[noreturn]] void failBy(const std::string& mesher, const std::string& problem,
                         const std::string& said) {
  throw Error(ErrorCode::NotMeshable,
              concat("The mesher ", mesher, " ", problem, ". ", lastLines(said)));
}

/// Gives each tet a positive volume, and removes unused points.
TetMesh tidied(TetMesh read) {
  TetMesh mesh;
  mesh.regions = std::move(read.regions);
  std::vector<Index> vertices(read.points.size(), kNone);
  for (Tet tet : read.tets) {
    for (Index& v : tet) {
      if (vertices[v] == kNone) {
        vertices[v] = static_cast<Index>(mesh.points.size());
        mesh.points.push_back(read.points[v]);
      }
      v = vertices[v];
    }
    if (volumeOf(mesh, tet) < 0) std::swap(tet[2], tet[3]);
    mesh.tets.push_back(tet);
  }
  mesh.features = std::move(read.features);
  const auto isLost = [&vertices](const auto& feature) {
    return std::any_of(feature.vertices.begin(), feature.vertices.end(),
                       [&](Index v) { return vertices[v] == kNone; });
  };
  std::erase_if(mesh.features.faces, isLost);
  for (FeatureFace& face : mesh.features.faces) {
    for (Index& v : face.vertices) v = vertices[v];
  }
  return mesh;
}

TetMesh readResult(const Runner& runner, const std::string& mesher, const Task& task,
                   const std::filesystem::path& folder, const ProgramEnd& end, Context& context) {
  if (end.code != 0) failBy(mesher, concat("failed with exit code ", end.code), end.said);
  const bool hasNames = std::filesystem::exists(folder / kNamed);
  const std::filesystem::path result = folder / (hasNames ? kNamed : runner.result);
  if (!std::filesystem::exists(result)) failBy(mesher, "wrote no mesh", end.said);
  try {
    TetMesh read = readTetMesh(result, {}, context);
    // Names are those of faces and solids of a STEP file; other tags are the mesher's own.
    if (task.surface != nullptr || !hasNames) {
      read.regions.clear();
      read.features = {};
    }
    read.features.vertices.clear();
    read.features.edges.clear();
    TetMesh mesh = tidied(std::move(read));
    if (!mesh.tets.empty()) return mesh;
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Cancelled || error.code() == ErrorCode::OutOfMemory) throw;
    failBy(mesher, concat("wrote a mesh that cannot be read (", error.what(), ")"), end.said);
  }
  failBy(mesher, "made no tets", end.said);
}

void addNotes(const std::string& said, std::vector<std::string>& notes) {
  const std::size_t begin = said.find(kNote);
  if (begin == std::string::npos) return;
  const std::size_t text = begin + std::string_view(kNote).size();
  notes.push_back(said.substr(text, said.find_first_of("\r\n", text) - text));
}

}  // namespace

double volumeOf(const TetMesh& mesh, const Tet& tet) {
  const Vec3& origin = mesh.points[tet[0]];
  constexpr double kSix = 6;
  return tripleProduct(minus(mesh.points[tet[1]], origin), minus(mesh.points[tet[2]], origin),
                       minus(mesh.points[tet[3]], origin)) /
         kSix;
}

Meshed runMesher(const Task& task, Mesher mesher, const std::function<void(Meshed&)>& check,
                 Context& context) {
  const TemporaryFolder temporary;
  const std::filesystem::path& folder = temporary.path();
  if (task.surface != nullptr) {
    writeStl(*task.surface, folder / "part.stl");
  } else {
    std::error_code problem;
    std::filesystem::copy_file(task.step, folder / "part.step", problem);
    if (problem) {
      throw Error(ErrorCode::FileNotFound,
                  task.name + ": the file cannot be read: " + problem.message() + ".");
    }
  }
  writeGeo(task, folder / "part.geo");
  std::string said;
  std::vector<std::string> refused;
  for (const Runner& runner : runnersFor(task, mesher, context.threads())) {
    for (const std::string& old : {std::string(kNamed), runner.result}) {
      std::filesystem::remove(folder / old);
    }
    const ProgramEnd end = runProgram(runner.words, folder, context);
    if (end.code == ProgramEnd::kNotFound || end.code == runner.codeIfMissing) {
      said += end.said;
      continue;
    }
    const std::string name =
        runner.name.empty() ? end.said.substr(0, end.said.find('\n')) : runner.name;
    try {
      Meshed meshed{readResult(runner, name, task, folder, end, context), name, {}};
      check(meshed);
      meshed.warnings = std::move(refused);
      addNotes(end.said, meshed.warnings);
      return meshed;
    } catch (const Error& error) {
      if (error.code() == ErrorCode::Cancelled || error.code() == ErrorCode::OutOfMemory) throw;
      refused.emplace_back(error.what());
    }
  }
  if (refused.empty()) failWithoutMesher(task, mesher, said);
  std::string sentence = task.name + ":";
  for (const std::string& each : refused) sentence += " " + each;
  throw Error(ErrorCode::NotMeshable,
              sentence + " Try another mesher (--mesher netgen or gmsh), or a smaller --tet-size.");
}

}  // namespace hexhex::fill
