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

  PatchDilatation::PatchDilatation(const Patches      &patches,
                                   const ExamplePoses &examples,
                                   const FESpace      &fe_space,
                                   const Material     &material)
      : patches(patches), examples(examples), fe_space(fe_space), thin(fe_space),
        guard(patches, fe_space, material, examples), fractions(fe_space.n_points()),
        means(patches.size(), 0.)
  {
    for (unsigned int point = 0; point < fractions.size(); ++point)
      fractions[point] = fe_space.volume(point) / patches.volume(patches.of_point(point));
  }

  void
  PatchDilatation::attach(const SymmetricPattern &pattern,
                          const FreeDofs         &all_free_dofs,
                          CellField              &field)
  {
    cells     = &field;
    free_dofs = &all_free_dofs;
    scatter.emplace(patches, fe_space, pattern, all_free_dofs,
                    !(pattern.products_are_apart && couples_by_products()));
    field.get_dilatation().resize(fe_space.n_points());
  }

  void
  PatchDilatation::begin_step(const State & /*start*/)
  {
    const StrainDamping &of_cells = cells->get_damping();
    damping                       = {};
    if (of_cells.factor() == 0.)
      return;
    damping.past_means.assign(patches.size(), 0.);
    damping.factors.assign(patches.size(), of_cells.factor());
    for (unsigned int point = 0; point < fractions.size(); ++point)
    {
      const unsigned int patch = patches.of_point(point);
      damping.past_means[patch] += fractions[point] * past_trace(of_cells.past_strain(point));
      if (of_cells.factor(point) == 0.)
        damping.factors[patch] = 0.;
    }
  }

  void
  PatchDilatation::find_means(const Vector &positions)
  {
    DilatationField &dilatation = cells->get_dilatation();
    thin.find(*cells, positions, dilatation.traces.data(), dilatation.squares.data());
    std::vector<double> mean_squares(patches.size(), 0.);
    std::fill(means.begin(), means.end(), 0.);
    for (unsigned int point = 0; point < fractions.size(); ++point)
    {
      const unsigned int patch = patches.of_point(point);
      means[patch] += fractions[point] * dilatation.traces[point];
      mean_squares[patch] += fractions[point] * dilatation.squares[point];
    }
    guard.find(*cells, positions, dilatation.traces.data(), means, mean_squares);
  }

  double
  PatchDilatation::target(const unsigned int patch, const std::vector<double> &weights) const
  {
    double sum = 0.;
    for (unsigned int weight = 0; weight < weights.size(); ++weight)
      sum += weights[weight] * examples.patch_dilatation(patch, weight);
    return sum;
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
      if (const double s = damping.factor(patch); s > 0.)
      {
        of_patch[patch] += s * lambda * (means[patch] - damping.past_means[patch]);
        scale[patch] += s * root * std::abs(lambda)
                        * (std::abs(means[patch]) + std::abs(damping.past_means[patch]));
      }
    }
    DilatationField &dilatation = cells->get_dilatation();
    for (unsigned int point = 0; point < fractions.size(); ++point)
    {
      const unsigned int patch    = patches.of_point(point);
      dilatation.pressures[point] = of_patch[patch];
      dilatation.scales[point]    = scale[patch];
    }
    guard.add_pressures(dilatation.pressures.data());
  }

  void
  PatchDilatation::tell_cells(const TermPoint &at)
  {
    cells->update_dilatations(at.positions);
    find_means(at.positions);
    find_pressures(at.weights);
  }

  void
  PatchDilatation::add(const TermPoint &at, ElasticSums &sums)
  {
    find_means(at.positions);
    find_pressures(at.weights);
    const CellTask task = cells->task(at.positions, RotationUse::keep);
    cells->get_nodal_sums().for_each_stripe(
        [&](std::size_t, const std::size_t begin, const std::size_t end, double *nodal_sums)
        { cells->loops().add_pressure_forces(task, begin, end, nodal_sums); });
    add_energies(at.weights, sums);
    add_forces_of_few_cells(sums->gradient);
    sums->stress_square += stress_square();
  }

  void
  PatchDilatation::add_forces_of_few_cells(Vector &gradient) const
  {
    guard.add_forces(*cells, gradient);
    thin.add_forces(*cells, cells->get_dilatation().pressures.data(), gradient);
  }

  void
  PatchDilatation::add_energies(const std::vector<double> &weights, ElasticSums &sums) const
  {
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      const double deviation = means[patch] - target(patch, weights);
      sums->energy_elastic += 0.5 * patches.stiffness(patch) * means[patch] * means[patch];
      sums->energy += 0.5 * patches.stiffness(patch) * deviation * deviation;
      for (unsigned int weight = 0; weight < sums->weight_gradient.size(); ++weight)
        sums->weight_gradient[weight]
            -= patches.stiffness(patch) * deviation * examples.patch_dilatation(patch, weight);
      if (const double s = damping.factor(patch); s > 0.)
      {
        const double change = means[patch] - damping.past_means[patch];
        sums->energy_damping += 0.5 * s * patches.stiffness(patch) * change * change;
      }
    }
    const double of_guard = guard.energy();
    sums->energy_elastic += of_guard;
    sums->energy += of_guard;
  }

  double
  PatchDilatation::stress_square() const
  {
    const dealii::AlignedVector<double> &scales = cells->get_dilatation().scales;
    double                               sum    = 0.;
    for (unsigned int point = 0; point < fractions.size(); ++point)
      sum += fractions[point] * patches.volume(patches.of_point(point)) * scales[point]
             * scales[point];
    return sum;
  }

  void
  PatchDilatation::add_weight_linear_term(const Vector &positions, std::vector<double> &c)
  {
    find_means(positions);
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      for (unsigned int weight = 0; weight < c.size(); ++weight)
        c[weight]
            += patches.stiffness(patch) * means[patch] * examples.patch_dilatation(patch, weight);
  }

  double
  PatchDilatation::tangent_factor(const unsigned int patch, const Tangent kind) const
  {
    const double s
        = kind == Tangent::convex ? cells->get_damping().factor() : damping.factor(patch);
    return (1. + s) * patches.stiffness(patch);
  }

  void
  PatchDilatation::find_gradient(const unsigned int patch, std::vector<double> &b) const
  {
    scatter->gradient(patch, *cells, b);
    if (thin.empty())
      return;
    const unsigned int *places = scatter->places(patch);
    for (const unsigned int point : patches.points(patch))
    {
      const auto gradients = fe_space.gradients(point);
      if (thin.has(point))
      {
        const Matrix3<double> by_F = cells->rotation(point) * thin.trace_gradient(point);
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
                                       const Tangent               kind,
                                       const std::vector<double>  &b,
                                       dealii::FullMatrix<double> &matrix,
                                       OuterProducts              *products) const
  {
    if (guard.acts_in(patch))
      guard.add_tangent(patch, *cells, *scatter, thin, kind, b, matrix, products);
    const unsigned int *places = scatter->places(patch);
    for (const unsigned int point : patches.points(patch))
    {
      if (kind == Tangent::exact && thin.has(point))
        thin.add_tangent(point, cells->rotation(point), cells->pressure(point), places, matrix);
      places += fe_space.gradients(point).size();
    }
  }

  void
  PatchDilatation::add_columns(const unsigned int         patch,
                               const std::vector<double> &b,
                               std::vector<double>       &columns) const
  {
    for (unsigned int weight = 0; weight < examples.n_weights(); ++weight)
      if (examples.is_strained(weight))
        scatter->add_column(
            patch, patches.stiffness(patch) * examples.patch_dilatation(patch, weight), b,
            &columns[free_dofs->local_list().size() * examples.strained_index(weight)]);
  }

  void
  PatchDilatation::add_tangent(const TermPoint & /*at*/,
                               const Tangent        kind,
                               std::vector<double> &values,
                               std::vector<double> &columns)
  {
    std::vector<double> b;
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      find_gradient(patch, b);
      scatter->add_square(patch, tangent_factor(patch, kind), b, values);
      if (!columns.empty())
        add_columns(patch, b, columns);
      if (!is_special(patch))
        continue;
      dealii::FullMatrix<double> matrix(b.size());
      add_special_tangent(patch, kind, b, matrix);
      scatter->add_matrix(patch, matrix, values);
    }
  }

  void
  PatchDilatation::add_tangent_in_parts(const TermPoint & /*at*/,
                                        const Tangent        kind,
                                        std::vector<double> &values,
                                        std::vector<double> &columns,
                                        OuterProducts       &products)
  {
    std::vector<double> b;
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      find_gradient(patch, b);
      products.add(tangent_factor(patch, kind), scatter->nodes(patch), b);
      if (!columns.empty())
        add_columns(patch, b, columns);
      if (!is_special(patch))
        continue;
      dealii::FullMatrix<double> of_cells(b.size());
      add_special_tangent(patch, kind, b, of_cells, &products);
      scatter->add_cells(patch, of_cells, values);
    }
  }

  void
  PatchDilatation::add_response(const TermPoint & /*at*/,
                                const Tangent kind,
                                const Vector &displacement,
                                ElasticSums  &sums)
  {
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      if (scatter->is_beside_held(patch))
        add_response_of(patch, kind, displacement, sums);
  }

  void
  PatchDilatation::add_response_of(const unsigned int patch,
                                   const Tangent      kind,
                                   const Vector      &displacement,
                                   ElasticSums       &sums) const
  {
    const std::vector<unsigned int> &nodes = scatter->nodes(patch);
    std::vector<double>              u, b; // of the patch
    for (const unsigned int node : nodes)
      for (unsigned int c = 0; c < 3; ++c)
        u.push_back(displacement[3 * node + c]);
    find_gradient(patch, b);
    const double        change = dot(b, u.data());
    std::vector<double> forces = b;
    for (double &force : forces)
      force *= tangent_factor(patch, kind) * change;
    if (is_special(patch))
    {
      dealii::FullMatrix<double> matrix(b.size());
      add_special_tangent(patch, kind, b, matrix);
      for (std::size_t i = 0; i < b.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j)
          forces[i] += matrix(i, j) * u[j];
    }
    for (std::size_t i = 0; i < forces.size(); ++i)
      sums->gradient[3 * nodes[i / 3] + i % 3] += forces[i];
    for (unsigned int weight = 0; weight < sums->weight_gradient.size(); ++weight)
      sums->weight_gradient[weight]
          -= patches.stiffness(patch) * change * examples.patch_dilatation(patch, weight);
  }

  void
  PatchDilatation::add_densities(std::vector<double> &of_points) const
  {
    for (unsigned int point = 0; point < of_points.size(); ++point)
    {
      const unsigned int patch = patches.of_point(point);
      of_points[point]
          += 0.5 * patches.lambda(patch) * means[patch] * means[patch] + guard.density(point);
    }
  }

  std::size_t
  PatchDilatation::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    return patches.memory_consumption() + scatter->memory_consumption()
           + memory_consumption(fractions) + memory_consumption(means)
           + memory_consumption(damping.past_means) + memory_consumption(damping.factors);
  }
} // namespace Exemplar
