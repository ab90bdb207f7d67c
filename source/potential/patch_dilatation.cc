// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/patch_dilatation.h>

#include <deal.II/base/memory_consumption.h>

#include <cmath>

namespace Exemplar
{
  PatchDilatation::PatchDilatation(const Patches          &patches,
                                   const ExamplePoses     *examples,
                                   const FESpace          &fe_space,
                                   const SymmetricPattern &pattern,
                                   const FreeDofs         &free_dofs)
      : patches(patches), examples(examples), free_dofs(free_dofs),
        scatter(patches, fe_space, pattern, free_dofs), fractions(fe_space.n_cells()),
        means(patches.size(), 0.), traces(batched_size(fe_space.n_cells(), 1)),
        pressures(traces.size()), scales(traces.size())
  {
    for (unsigned int cell = 0; cell < fractions.size(); ++cell)
      fractions[cell] = fe_space.tetrahedron(cell).volume / patches.volume(patches.of_cell(cell));
  }

  DilatationArrays
  PatchDilatation::arrays()
  {
    return { traces.data(), pressures.data(), scales.data() };
  }

  void
  PatchDilatation::set_damping(const StrainDamping &damping)
  {
    whole_damping = damping.factor();
    if (whole_damping == 0.)
    {
      past_means.clear();
      return;
    }
    past_means.assign(patches.size(), 0.);
    damping_factors.assign(patches.size(), whole_damping);
    for (unsigned int cell = 0; cell < fractions.size(); ++cell)
    {
      const unsigned int patch = patches.of_cell(cell);
      past_means[patch] += fractions[cell] * trace(damping.past_strain(cell));
      if (damping.factor(cell) == 0.)
        damping_factors[patch] = 0.;
    }
  }

  void
  PatchDilatation::find_means()
  {
    std::fill(means.begin(), means.end(), 0.);
    for (unsigned int cell = 0; cell < fractions.size(); ++cell)
      means[patches.of_cell(cell)] += fractions[cell] * traces[cell];
  }

  double
  PatchDilatation::target(const unsigned int patch, const std::vector<double> &weights) const
  {
    if (examples == nullptr)
      return 0.;
    double sum = 0.;
    for (unsigned int weight = 0; weight < weights.size(); ++weight)
      sum += weights[weight] * examples->patch_dilatation(patch, weight);
    return examples->importance() * sum;
  }

  void
  PatchDilatation::set_pressures(const std::vector<double> &weights)
  {
    find_means();
    std::vector<double> of_patch(patches.size()), scale(patches.size());
    const double        root = std::sqrt(3.); // |p I| = sqrt(3) |p|
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      const double lambda = patches.lambda(patch), D = target(patch, weights);
      of_patch[patch] = lambda * (means[patch] - D);
      scale[patch]    = root * std::abs(lambda) * (std::abs(means[patch]) + std::abs(D));
      if (const double s = damping_factor(patch); s > 0.)
      {
        of_patch[patch] += s * lambda * (means[patch] - past_means[patch]);
        scale[patch]
            += s * root * std::abs(lambda) * (std::abs(means[patch]) + std::abs(past_means[patch]));
      }
    }
    for (unsigned int cell = 0; cell < fractions.size(); ++cell)
    {
      pressures[cell] = of_patch[patches.of_cell(cell)];
      scales[cell]    = scale[patches.of_cell(cell)];
    }
  }

  void
  PatchDilatation::add_energies(const std::vector<double> &weights, ElasticEvaluation &result) const
  {
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      const double deviation = means[patch] - target(patch, weights);
      result.energy_elastic += 0.5 * stiffness(patch) * means[patch] * means[patch];
      result.energy += 0.5 * stiffness(patch) * deviation * deviation;
      for (unsigned int weight = 0; weight < result.weight_gradient.size(); ++weight)
        result.weight_gradient[weight] -= examples->importance() * stiffness(patch) * deviation
                                          * examples->patch_dilatation(patch, weight);
      if (const double s = damping_factor(patch); s > 0.)
      {
        const double change = means[patch] - past_means[patch];
        result.energy_damping += 0.5 * s * stiffness(patch) * change * change;
      }
    }
  }

  double
  PatchDilatation::stress_square() const
  {
    double sum = 0.;
    for (unsigned int cell = 0; cell < fractions.size(); ++cell)
      sum += fractions[cell] * patches.volume(patches.of_cell(cell)) * scales[cell] * scales[cell];
    return sum;
  }

  void
  PatchDilatation::add_linear_term(std::vector<double> &linear_term)
  {
    find_means();
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      for (unsigned int weight = 0; weight < linear_term.size(); ++weight)
        linear_term[weight] += examples->importance() * stiffness(patch) * means[patch]
                               * examples->patch_dilatation(patch, weight);
  }

  void
  PatchDilatation::add_tangent(const CellField     &cells,
                               const bool           damp_all,
                               std::vector<double> &values) const
  {
    std::vector<double> b;
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      scatter.gradient(patch, cells, b);
      const double s = damp_all ? whole_damping : damping_factor(patch);
      scatter.add_product(patch, (1. + s) * stiffness(patch), b, values);
    }
  }

  void
  PatchDilatation::add_coupling(const CellField &cells, std::vector<double> &columns) const
  {
    std::vector<double> b;
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      scatter.gradient(patch, cells, b);
      for (unsigned int weight = 0; weight < examples->n_weights(); ++weight)
        if (examples->is_strained(weight))
          scatter.add_column(patch,
                             examples->importance() * stiffness(patch)
                                 * examples->patch_dilatation(patch, weight),
                             b, &columns[free_dofs.size() * examples->strained_index(weight)]);
    }
  }

  void
  PatchDilatation::add_response(const CellField   &cells,
                                const Vector      &displacement,
                                ElasticEvaluation &result) const
  {
    std::vector<double> b;
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      if (!scatter.is_beside_held(patch))
        continue;
      scatter.gradient(patch, cells, b);
      const std::vector<unsigned int> &nodes  = scatter.nodes(patch);
      double                           change = 0.;
      for (std::size_t i = 0; i < b.size(); ++i)
        change += b[i] * displacement[3 * nodes[i / 3] + i % 3];
      const double factor = (1. + damping_factor(patch)) * stiffness(patch) * change;
      for (std::size_t i = 0; i < b.size(); ++i)
        result.gradient[3 * nodes[i / 3] + i % 3] += factor * b[i];
      for (unsigned int weight = 0; weight < result.weight_gradient.size(); ++weight)
        result.weight_gradient[weight] -= examples->importance() * stiffness(patch) * change
                                          * examples->patch_dilatation(patch, weight);
    }
  }

  std::size_t
  PatchDilatation::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    return patches.memory_consumption() + scatter.memory_consumption()
           + memory_consumption(fractions) + memory_consumption(means)
           + memory_consumption(past_means) + memory_consumption(damping_factors)
           + traces.memory_consumption() + pressures.memory_consumption()
           + scales.memory_consumption();
  }
} // namespace Exemplar
