// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/potential/patch_dilatation.h>

#include <deal.II/base/memory_consumption.h>

#include <cmath>

namespace Exemplar
{
  PatchDilatation::PatchDilatation(const Patches          &patches,
                                   const ExamplePoses     *examples,
                                   const FESpace          &fe_space,
                                   const Material         &material,
                                   const SymmetricPattern &pattern,
                                   const FreeDofs         &free_dofs)
      : patches(patches), examples(examples), free_dofs(free_dofs),
        scatter(patches, fe_space, pattern, free_dofs),
        guard(patches, fe_space, material, examples), fractions(fe_space.n_points()),
        means(patches.size(), 0.), mean_squares(patches.size(), 0.),
        traces(batched_size(fractions.size(), 1)), squares(traces.size()), pressures(traces.size()),
        scales(traces.size())
  {
    for (unsigned int point = 0; point < fractions.size(); ++point)
      fractions[point] = fe_space.volume(point) / patches.volume(patches.of_point(point));
  }

  DilatationArrays
  PatchDilatation::arrays()
  {
    return { traces.data(), squares.data(), pressures.data(), scales.data() };
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
    for (unsigned int point = 0; point < fractions.size(); ++point)
    {
      const unsigned int patch = patches.of_point(point);
      past_means[patch] += fractions[point] * trace(damping.past_strain(point));
      if (damping.factor(point) == 0.)
        damping_factors[patch] = 0.;
    }
  }

  void
  PatchDilatation::find_means()
  {
    std::fill(means.begin(), means.end(), 0.);
    std::fill(mean_squares.begin(), mean_squares.end(), 0.);
    for (unsigned int point = 0; point < fractions.size(); ++point)
    {
      const unsigned int patch = patches.of_point(point);
      means[patch] += fractions[point] * traces[point];
      mean_squares[patch] += fractions[point] * squares[point];
    }
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
  PatchDilatation::update(const CellField           &cells,
                          const Vector              &positions,
                          const std::vector<double> &weights)
  {
    find_means();
    guard.find(cells, positions, traces.data(), means, mean_squares);
    find_pressures(weights);
  }

  void
  PatchDilatation::find_pressures(const std::vector<double> &weights)
  {
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
    for (unsigned int point = 0; point < fractions.size(); ++point)
    {
      const unsigned int patch = patches.of_point(point);
      pressures[point]         = of_patch[patch];
      scales[point]            = scale[patch];
    }
    guard.add_pressures(pressures.data());
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
    const double of_guard = guard.energy();
    result.energy_elastic += of_guard;
    result.energy += of_guard;
  }

  double
  PatchDilatation::stress_square() const
  {
    double sum = 0.;
    for (unsigned int point = 0; point < fractions.size(); ++point)
      sum += fractions[point] * patches.volume(patches.of_point(point)) * scales[point]
             * scales[point];
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

  double
  PatchDilatation::tangent_factor(const unsigned int patch, const Tangent tangent) const
  {
    const double s = tangent == Tangent::convex ? whole_damping : damping_factor(patch);
    return (1. + s) * stiffness(patch);
  }

  void
  PatchDilatation::add_tangent(const CellField     &cells,
                               const Tangent        tangent,
                               std::vector<double> &values) const
  {
    std::vector<double> b;
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      scatter.gradient(patch, cells, b);
      scatter.add_square(patch, tangent_factor(patch, tangent), b, values);
      guard.for_each_product(patch, cells, scatter, tangent, b,
                             [&](const std::vector<double> &u, const std::vector<double> &v)
                             { scatter.add_product(patch, u, v, values); });
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
          scatter.add_column(
              patch,
              examples->importance() * stiffness(patch) * examples->patch_dilatation(patch, weight),
              b, &columns[free_dofs.local_list().size() * examples->strained_index(weight)]);
    }
  }

  void
  PatchDilatation::add_response(const CellField   &cells,
                                const Tangent      tangent,
                                const Vector      &displacement,
                                ElasticEvaluation &result) const
  {
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      if (!scatter.is_beside_held(patch))
        continue;
      const std::vector<unsigned int> &nodes = scatter.nodes(patch);
      std::vector<double>              u_of_patch, b;
      for (const unsigned int node : nodes)
        for (unsigned int c = 0; c < 3; ++c)
          u_of_patch.push_back(displacement[3 * node + c]);
      const auto add = [&](const double factor, const std::vector<double> &forces)
      {
        for (std::size_t i = 0; i < forces.size(); ++i)
          result.gradient[3 * nodes[i / 3] + i % 3] += factor * forces[i];
      };
      scatter.gradient(patch, cells, b);
      const double change = dot(b, u_of_patch.data());
      add(tangent_factor(patch, tangent) * change, b);
      guard.for_each_product(patch, cells, scatter, tangent, b,
                             [&](const std::vector<double> &u, const std::vector<double> &v)
                             {
                               add(dot(u, u_of_patch.data()), v);
                               add(dot(v, u_of_patch.data()), u);
                             });
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
           + memory_consumption(mean_squares) + memory_consumption(past_means)
           + memory_consumption(damping_factors) + traces.memory_consumption()
           + squares.memory_consumption() + pressures.memory_consumption()
           + scales.memory_consumption();
  }
} // namespace Exemplar
