// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/patch_volumes.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <limits>

namespace Exemplar
{
  PatchVolumes::PatchVolumes(const Patches &patches, CellField &cells)
      : patches(patches), changes(patches.size(), 0.)
  {
    std::size_t n_points = 0;
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      n_points += patches.points(patch).size();
    cells.get_dilatation().volume.resize(n_points);
  }

  void
  PatchVolumes::find(const CellField &cells, const PatchScatter &scatter)
  {
    const double *of_points = cells.get_dilatation().volume.changes.data();
    for_each_part(cells.n_threads(), patches.size(), cells.n_threads(),
                  [&](std::size_t /*part*/, const std::size_t begin, const std::size_t end)
                  {
                    for (std::size_t patch = begin; patch < end; ++patch)
                      changes[patch] = scatter.mean(patch, of_points);
                  });
  }

  void
  PatchVolumes::write_pressures(CellField &cells) const
  {
    dealii::AlignedVector<double> &to = cells.get_dilatation().volume.pressures;
    for_each_part(cells.n_threads(), patches.size(), cells.n_threads(),
                  [&](std::size_t /*part*/, const std::size_t begin, const std::size_t end)
                  {
                    for (std::size_t patch = begin; patch < end; ++patch)
                      for (const unsigned int point : patches.points(patch))
                        to[point] = pressure(patch);
                  });
  }

  PatchProducts
  PatchVolumes::find_products(const double        share,
                              const Tangent       kind,
                              CellField          &cells,
                              const PatchScatter &scatter) const
  {
    PatchProducts products;
    const double  lowest = kind == Tangent::convex ? 0. : std::numeric_limits<double>::lowest();
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      products.factors.push_back(std::max(share * patches.stiffness(patch), lowest));
    scatter.find_gradients(cells, cells.get_dilatation().volume.cofactors.data(), products.vectors);
    return products;
  }

  std::size_t
  PatchVolumes::memory_consumption() const
  {
    return dealii::MemoryConsumption::memory_consumption(changes);
  }
} // namespace Exemplar
