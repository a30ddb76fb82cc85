// Loads the parts of a mesh as a distributed triangulation of deal.II, with ghosts, and prints how
// many cells, faces at the boundary, and unknowns of trilinear elements (one per vertex) it counts.
//
//     mpirun -n R dealii_parts FOLDER
//
// FOLDER has rank0.bin and so on, as read_with_others.py writes them.
#include <array>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <deal.II/base/mpi.h>
#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>

namespace {

using Description = dealii::TriangulationDescription::Description<3, 3>;

template <class Value>
Value read(std::istream& file) {
  Value value{};
  if (!file.read(reinterpret_cast<char*>(&value), sizeof(Value)))
    throw std::runtime_error("a short file");
  return value;
}

/// What a rank tells deal.II: its own cells and those around them, each with the rank that owns it.
Description describe(std::istream& file, MPI_Comm communicator) {
  Description mesh;
  mesh.comm = communicator;
  mesh.settings = dealii::TriangulationDescription::default_setting;
  mesh.smoothing = dealii::Triangulation<3>::none;
  const auto counts = read<std::array<std::int64_t, 3>>(file);
  std::map<std::int64_t, unsigned> local;
  for (std::int64_t i = 0; i < counts[0]; ++i) {
    local.emplace(read<std::int64_t>(file), static_cast<unsigned>(i));
    const auto position = read<std::array<double, 3>>(file);
    mesh.coarse_cell_vertices.emplace_back(position[0], position[1], position[2]);
  }
  mesh.cell_infos.resize(1);
  for (std::int64_t c = 0; c < counts[2]; ++c) {
    const auto number = static_cast<dealii::types::coarse_cell_id>(read<std::int64_t>(file));
    const auto owner = static_cast<unsigned>(read<std::int64_t>(file));
    const auto corners = read<std::array<std::int64_t, 8>>(file);
    dealii::CellData<3> cell(8);
    // deal.II counts corners by coordinates.
    constexpr std::array<std::size_t, 8> order{0, 1, 3, 2, 4, 5, 7, 6};
    for (std::size_t k = 0; k < 8; ++k) cell.vertices[k] = local.at(corners[order[k]]);
    mesh.coarse_cells.push_back(cell);
    mesh.coarse_cell_index_to_coarse_cell_id.push_back(number);
    dealii::TriangulationDescription::CellData<3> info;
    info.id = dealii::CellId(number, {}).to_binary<3>();
    info.subdomain_id = owner;
    info.level_subdomain_id = owner;
    info.manifold_id = dealii::numbers::flat_manifold_id;
    info.manifold_line_ids.fill(dealii::numbers::flat_manifold_id);
    info.manifold_quad_ids.fill(dealii::numbers::flat_manifold_id);
    mesh.cell_infos[0].push_back(info);
  }
  return mesh;
}

}  // namespace

int main(int argc, char** argv) {
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const MPI_Comm all = MPI_COMM_WORLD;
  const unsigned rank = dealii::Utilities::MPI::this_mpi_process(all);
  std::ifstream file(std::string(argv[1]) + "/rank" + std::to_string(rank) + ".bin",
                     std::ios::binary);
  dealii::parallel::fullydistributed::Triangulation<3> mesh(all);
  mesh.create_triangulation(describe(file, all));
  std::uint64_t boundary = 0;
  for (const auto& cell : mesh.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    for (const unsigned face : cell->face_indices()) boundary += cell->at_boundary(face) ? 1 : 0;
  }
  dealii::DoFHandler<3> unknowns(mesh);
  unknowns.distribute_dofs(dealii::FE_Q<3>(1));
  boundary = dealii::Utilities::MPI::sum(boundary, all);
  if (rank == 0) {
    std::cout << mesh.n_global_active_cells() << ' ' << unknowns.n_dofs() << ' ' << boundary
              << '\n';
  }
}
