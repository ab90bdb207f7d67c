// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/potential/patch_dilatation.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// tr S - 3, continued in thin cells, of a strain S - I.
    double
    past_trace(const Matrix3<double> &strain)
    {
      Matrix3<double> S = strain;
      for (int i = 0; i < 3; ++i)
        S[i][i] += 1.;
      return trace(strain) + ThinCells::trace_supplement(S);
    }
  } // namespace

  PatchDilatation::PatchDilatation(const Patches          &patches,
                                   const ExamplePoses     *examples,
                                   const FESpace          &fe_space,
                                   const Material         &material,
                                   const SymmetricPattern &pattern,
                                   const FreeDofs         &free_dofs)
      : patches(patches), examples(examples), fe_space(fe_space), free_dofs(free_dofs),
        scatter(patches, fe_space, pattern, free_dofs), thin(fe_space),
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
      past_means[patch] += fractions[point] * past_trace(damping.past_strain(point));
      if (damping.factor(point) == 0.)
        damping_factors[patch] = 0.;
    }
  }

  void
  PatchDilatation::find_means(const CellField &cells, const Vector &positions)
  {
    thin.find(cells, positions, traces.data(), squares.data());
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
    return sum;
  }

  void
  PatchDilatation::update(const CellField           &cells,
                          const Vector              &positions,
                          const std::vector<double> &weights)
  {
    find_means(cells, positions);
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
        result.weight_gradient[weight]
            -= stiffness(patch) * deviation * examples->patch_dilatation(patch, weight);
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
  PatchDilatation::add_linear_term(const CellField     &cells,
                                   const Vector        &positions,
                                   std::vector<double> &linear_term)
  {
    find_means(cells, positions);
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      for (unsigned int weight = 0; weight < linear_term.size(); ++weight)
        linear_term[weight]
            += stiffness(patch) * means[patch] * examples->patch_dilatation(patch, weight);
  }

  double
  PatchDilatation::tangent_factor(const unsigned int patch, const Tangent tangent) const
  {
    const double s = tangent == Tangent::convex ? whole_damping : damping_factor(patch);
    return (1. + s) * stiffness(patch);
  }

  void
  PatchDilatation::find_gradient(const unsigned int   patch,
                                 const CellField     &cells,
                                 std::vector<double> &b) const
  {
    scatter.gradient(patch, cells, b);
    if (thin.empty())
      return;
    const unsigned int *places = scatter.places(patch);
    for (const unsigned int point : patches.points(patch))
    {
      const auto gradients = fe_space.gradients(point);
      if (thin.has(point))
      {
        const Matrix3<double> by_F = cells.rotation(point) * thin.trace_gradient(point);
        for (unsigned int a = 0; a < gradients.size(); ++a)
        {
          const Vector3<double> of_node = by_F * gradients[a];
          for (unsigned int c = 0; c < 3; ++c)
            b[3 * places[a] + c] += fractions[point] * of_node[c];
        }
      }
      places += gradients.size();
    }
  }

  bool
  PatchDilatation::is_special(const unsigned int patch) const
  {
    const std::vector<unsigned int> &points = patches.points(patch);
    return guard.acts_in(patch)
           || (!thin.empty()
               && std::any_of(points.begin(), points.end(),
                              [&](const unsigned int point) { return thin.has(point); }));
  }

  void
  PatchDilatation::add_special_tangent(const unsigned int          patch,
                                       const CellField            &cells,
                                       const Tangent               tangent,
                                       const std::vector<double>  &b,
                                       dealii::FullMatrix<double> &matrix) const
  {
    if (guard.acts_in(patch))
      guard.add_tangent(patch, cells, scatter, thin, tangent, b, matrix);
    const unsigned int *places = scatter.places(patch);
    for (const unsigned int point : patches.points(patch))
    {
      if (tangent == Tangent::exact && thin.has(point))
        thin.add_tangent(point, cells.rotation(point), pressures[point], places, matrix);
      places += fe_space.gradients(point).size();
    }
  }

  void
  PatchDilatation::add_tangent(const CellField     &cells,
                               const Tangent        tangent,
                               std::vector<double> &values) const
  {
    std::vector<double> b;
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      find_gradient(patch, cells, b);
      scatter.add_square(patch, tangent_factor(patch, tangent), b, values);
      if (!is_special(patch))
        continue;
      dealii::FullMatrix<double> matrix(b.size());
      add_special_tangent(patch, cells, tangent, b, matrix);
      scatter.add_matrix(patch, matrix, values);
    }
  }

  void
  PatchDilatation::add_coupling(const CellField &cells, std::vector<double> &columns) const
  {
    std::vector<double> b;
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      find_gradient(patch, cells, b);
      for (unsigned int weight = 0; weight < examples->n_weights(); ++weight)
        if (examples->is_strained(weight))
          scatter.add_column(
              patch, stiffness(patch) * examples->patch_dilatation(patch, weight), b,
              &columns[free_dofs.local_list().size() * examples->strained_index(weight)]);
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
      find_gradient(patch, cells, b);
      const double change = dot(b, u_of_patch.data());
      add(tangent_factor(patch, tangent) * change, b);
      if (is_special(patch))
      {
        dealii::FullMatrix<double> matrix(b.size());
        add_special_tangent(patch, cells, tangent, b, matrix);
        std::vector<double> forces(b.size(), 0.);
        for (std::size_t i = 0; i < b.size(); ++i)
          for (std::size_t j = 0; j < b.size(); ++j)
            forces[i] += matrix(i, j) * u_of_patch[j];
        add(1., forces);
      }
      for (unsigned int weight = 0; weight < result.weight_gradient.size(); ++weight)
        result.weight_gradient[weight]
            -= stiffness(patch) * change * examples->patch_dilatation(patch, weight);
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
