// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/exchange.h>
#include <exemplar/mesh/distributed_triangulation.h>

#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/grid/tria_description.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    namespace Description = dealii::TriangulationDescription;

    Description::CellData<3>
    info_of(const unsigned int cell_in_file, const unsigned int process)
    {
      Description::CellData<3> info;
      info.id                 = dealii::CellId(cell_in_file, {}).to_binary<3>();
      info.subdomain_id       = process;
      info.level_subdomain_id = process;
      info.manifold_id        = dealii::numbers::flat_manifold_id;
      info.manifold_line_ids.fill(dealii::numbers::flat_manifold_id);
      info.manifold_quad_ids.fill(dealii::numbers::flat_manifold_id);
      return info;
    }
  } // namespace

  std::unique_ptr<dealii::Triangulation<3>>
  make_distributed_triangulation(const MeshArrays                &part,
                                 const std::vector<unsigned int> &cells_in_file,
                                 const Exchange                  &exchange)
  {
    const MPI_Comm communicator = exchange.communicator();
    Description::Description<3, 3> description;
    description.comm                 = communicator;
    description.settings             = Description::default_setting;
    description.smoothing            = dealii::Triangulation<3>::none;
    description.coarse_cell_vertices = part.contents.nodes;
    description.cell_infos.resize(1);
    for (std::size_t cell = 0; cell < part.cells.size(); ++cell)
    {
      dealii::CellData<3> data(4);
      std::copy(part.cells[cell].begin(), part.cells[cell].end(), data.vertices.begin());
      data.material_id = part.material_ids[cell];
      description.coarse_cells.push_back(std::move(data));
      description.coarse_cell_index_to_coarse_cell_id.push_back(cells_in_file[cell]);
      description.cell_infos[0].push_back(info_of(cells_in_file[cell], exchange.process()));
    }
    auto triangulation
        = std::make_unique<dealii::parallel::fullydistributed::Triangulation<3>>(communicator);
    triangulation->create_triangulation(description);
    return triangulation;
  }
} // namespace Exemplar
