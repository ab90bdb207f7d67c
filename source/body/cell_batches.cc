// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/cell_batches.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <numeric>

namespace Exemplar
{
  CellBatches::CellBatches(const FESpace          &fe_space,
                           const Material         &material,
                           LawsOfCells             laws_of_cells,
                           const ExampleConstants &examples)
      : fe_space(fe_space), laws(std::move(laws_of_cells)), examples(examples),
        n_points(fe_space.n_points()), n_nodes(nodes_per_cell(fe_space.element())),
        nodes(batched_size(n_points, n_nodes)), gradients(batched_size(n_points, 3 * n_nodes - 3)),
        volumes(batched_size(n_points, 1)), rotations(batched_size(n_points, 9))
  {
    std::vector<unsigned int> order(n_nodes);
    // slots behind the last point repeat it with volume 0
    for (std::size_t slot = 0; slot < volumes.size(); ++slot)
    {
      const auto point      = static_cast<unsigned int>(std::min(slot, n_points - 1));
      const auto cell       = fe_space.cell_of(point);
      const auto cell_nodes = fe_space.nodes(cell);
      const auto shape      = fe_space.gradients(point);
      std::iota(order.begin(), order.end(), 0u);
      std::sort(order.begin(), order.end(),
                [&](const unsigned int a, const unsigned int b)
                { return cell_nodes[a] < cell_nodes[b]; });
      for (std::size_t a = 0; a < n_nodes; ++a)
      {
        nodes[batch_index(slot, n_nodes, a)] = static_cast<int>(cell_nodes[order[a]]);
        for (std::size_t i = 0; i < 3 && a > 0; ++i)
          gradients[batch_index(slot, 3 * n_nodes - 3, 3 * (a - 1) + i)] = shape[order[a]][i];
      }
      volumes[slot] = slot < n_points ? fe_space.volume(point) : 0.;
      for (const unsigned int diagonal : { 0, 4, 8 })
        rotations[batch_index(slot, 9, diagonal)] = 1.;
    }
    for (const CellLaw law : laws.present())
      of_laws.push_back(make(law, material));
  }

  CellBatches::OfLaw
  CellBatches::make(const CellLaw law, const Material &material) const
  {
    OfLaw of_law;
    of_law.law                = law;
    const std::size_t n       = n_constants(law);
    const bool        has_own = laws.present().size() > 1;
    of_law.constants.resize(batched_size(n_points, n));
    of_law.history.resize(batched_size(n_points, traits_of(law).n_history), 0.);
    if (has_own)
      of_law.volumes.resize(volumes.size(), 0.);
    for (std::size_t slot = 0; slot < volumes.size(); ++slot)
    {
      const unsigned int cell = cell_of_slot(slot);
      if (has_own && laws[cell] == law)
        of_law.volumes[slot] = volumes[slot];
    }
    fill_constants(material, of_law);
    return of_law;
  }

  void
  CellBatches::fill_constants(const Material &material, OfLaw &of_law) const
  {
    const std::size_t n = n_constants(of_law.law);
    for (std::size_t slot = 0; slot < volumes.size(); ++slot)
      for (std::size_t k = 0; k < n; ++k)
        of_law.constants[batch_index(slot, n, k)]
            = material.number(of_law.law, cell_of_slot(slot), k);
  }

  void
  CellBatches::set_constants(const Material &material, const ExampleConstants &new_examples)
  {
    examples = new_examples;
    for (OfLaw &of_law : of_laws)
      fill_constants(material, of_law);
  }

  CellArrays
  CellBatches::arrays()
  {
    OfLaw &first = of_laws.front();
    return { n_points,         nodes.data(), gradients.data(),       volumes.data(),
             rotations.data(), first.law,    first.constants.data(), first.history.data(),
             examples,         step_size };
  }

  std::size_t
  CellBatches::n_history() const
  {
    std::size_t n = 0;
    for (const OfLaw &of_law : of_laws)
      n = std::max(n, traits_of(of_law.law).n_history);
    return n;
  }

  std::vector<double>
  CellBatches::history() const
  {
    const std::size_t   n = n_history();
    std::vector<double> history(n * n_points, 0.);
    for (const OfLaw &of_law : of_laws)
      for (std::size_t point = 0, m = traits_of(of_law.law).n_history; m > 0 && point < n_points;
           ++point)
        if (law(point) == of_law.law)
          for (std::size_t k = 0; k < m; ++k)
            history[n * point + k] = of_law.history[batch_index(point, m, k)];
    return history;
  }

  void
  CellBatches::set_history(const std::vector<double> &history)
  {
    const std::size_t n = n_history();
    for (OfLaw &of_law : of_laws)
      for (std::size_t slot = 0, m = traits_of(of_law.law).n_history;
           m > 0 && slot < volumes.size(); ++slot)
        for (std::size_t k = 0; k < m; ++k)
          of_law.history[batch_index(slot, m, k)]
              = history.empty() ? 0. : history[n * std::min(slot, n_points - 1) + k];
  }

  std::size_t
  CellBatches::memory_consumption() const
  {
    std::size_t memory_of_laws = 0;
    for (const OfLaw &of_law : of_laws)
      memory_of_laws += of_law.volumes.memory_consumption() + of_law.constants.memory_consumption()
                        + of_law.history.memory_consumption();
    return dealii::MemoryConsumption::memory_consumption(nodes) + gradients.memory_consumption()
           + volumes.memory_consumption() + rotations.memory_consumption() + memory_of_laws;
  }
} // namespace Exemplar
