// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/patch_dilatation.h>
#include <exemplar/potential/stretch_stiffness.h>

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
      const auto thin = ThinTrace<double>::of_strain(strain);
      return trace(strain) + (thin.acts() ? thin.supplement() : 0.);
    }

    /// The means over the patches of numbers of the points.
    void
    find_means(const PatchScatter  &scatter,
               const unsigned int   n_threads,
               const double        *of_points,
               std::vector<double> &means)
    {
      for_each_part(n_threads, means.size(), n_threads,
                    [&](std::size_t /*part*/, const std::size_t begin, const std::size_t end)
                    {
                      for (std::size_t patch = begin; patch < end; ++patch)
                        means[patch] = scatter.mean(patch, of_points);
                    });
    }
  } // namespace

  PatchDilatation::PatchDilatation(const Patches      &patches,
                                   const ExamplePoses &examples,
                                   const FESpace      &fe_space,
                                   const Material     &material)
      : patches(patches), examples(examples), fe_space(fe_space),
        guard(patches, fe_space, material, examples), means(patches.size(), 0.),
        damping(patches.size())
  {
  }

  void
  PatchDilatation::attach(const SymmetricPattern &pattern,
                          const FreeDofs         &all_free_dofs,
                          CellField              &field)
  {
    cells     = &field;
    free_dofs = &all_free_dofs;
    scatter.emplace(patches, fe_space, pattern, all_free_dofs, field,
                    !(pattern.products_are_apart && couples_by_products(fe_space)));
    field.get_dilatation().resize(fe_space.n_points());
    if (field.get_batches().has_volumetric_energy())
      volumes.emplace(patches, field);
  }

  void
  PatchDilatation::begin_step()
  {
    const StrainDamping &of_cells = cells->get_damping();
    leave_step();
    if (of_cells.factor() == 0.)
      return;
    damping.factors.assign(patches.size(), of_cells.factor());
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      const unsigned int patch = patches.of_point(point);
      damping.past_means[patch] += fe_space.volume(point) / patches.volume(patch)
                                   * past_trace(of_cells.past_strain(point));
      if (of_cells.factor(point) == 0.)
        damping.factors[patch] = 0.;
    }
  }

  void
  PatchDilatation::read_dilatations(const Vector &positions)
  {
    const DilatationField &dilatation = cells->get_dilatation();
    find_means(*scatter, cells->n_threads(), dilatation.traces.data(), means);
    mean_squares.assign(patches.size(), 0.);
    if (dilatation.has(long_cells))
      find_means(*scatter, cells->n_threads(), dilatation.squares.data(), mean_squares);
    guard.find(*cells, positions, means, mean_squares, share());
    if (volumes)
      volumes->find(*cells, *scatter);
  }

  void
  PatchDilatation::write_pressures(const TermPoint &at)
  {
    pressures.resize(patches.size());
    const double root = std::sqrt(3.); // |p I| = sqrt(3) |p|
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      const double      lambda = patches.lambda(patch), mean = means[patch];
      const double      D  = examples.patch_dilatation(patch, at.weights);
      PressureOnPoints &to = pressures[patch];
      to                   = { pressure_of_mean(lambda, share(), mean, D),
                               root * std::abs(lambda) * (share() * std::abs(mean) + std::abs(D)) };
      if (volumes)
        to.scale += root * std::abs(volumes->pressure(patch));
      if (const double s = damping.factors[patch]; s > 0.)
      {
        const double past = damping.past_means[patch];
        to.pressure += pressure_of_mean(s * lambda, 1., mean, past);
        to.scale += s * root * std::abs(lambda) * (std::abs(mean) + std::abs(past));
      }
    }
    DilatationField &dilatation = cells->get_dilatation();
    for_each_part(cells->n_threads(), fe_space.n_points(), cells->n_threads(),
                  [&](std::size_t /*part*/, const std::size_t begin, const std::size_t end)
                  {
                    for (std::size_t point = begin; point < end; ++point)
                    {
                      const PressureOnPoints &told = pressures[patches.of_point(point)];
                      dilatation.pressures[point]  = told.pressure;
                      dilatation.scales[point]     = told.scale;
                    }
                  });
    guard.add_pressures(dilatation);
    if (volumes)
      volumes->write_pressures(*cells);
  }

  void
  PatchDilatation::add(const TermPoint &at, ElasticSums &sums)
  {
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      const double stiffness = patches.stiffness(patch),
                   D         = examples.patch_dilatation(patch, at.weights);
      sums->energy_elastic += energy_of_mean(stiffness, means[patch], 0.);
      sums->energy += energy_of_mean(stiffness, means[patch], D);
      for (unsigned int weight = 0; weight < sums->weight_gradient.size(); ++weight)
        sums->weight_gradient[weight] -= pressure_of_mean(stiffness, 1., means[patch], D)
                                         * examples.patch_dilatation(patch, weight);
      if (const double s = damping.factors[patch]; s > 0.)
        sums->energy_damping
            += energy_of_mean(s * stiffness, means[patch], damping.past_means[patch]);
    }
    if (volumes)
      add_energies_of_volumes(sums);
    const double of_guard = guard.energy();
    sums->energy_elastic += of_guard;
    sums->energy += of_guard;
  }

  void
  PatchDilatation::add_energies_of_volumes(ElasticSums &sums) const
  {
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      const double of_trace  = energy_of_mean(patches.stiffness(patch), means[patch], 0.);
      const double of_volume = patches.volume(patch) * volumes->density(patch);
      sums->energy_elastic += of_volume - of_trace;
      sums->energy += (1. - share()) * (of_volume - of_trace);
    }
  }

  void
  PatchDilatation::add_weight_linear_term(std::vector<double> &c) const
  {
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      for (unsigned int weight = 0; weight < c.size(); ++weight)
        c[weight]
            += patches.stiffness(patch) * means[patch] * examples.patch_dilatation(patch, weight);
  }

  double
  PatchDilatation::tangent_factor(const unsigned int patch, const Tangent kind) const
  {
    const double s
        = kind == Tangent::convex ? cells->get_damping().factor() : damping.factors[patch];
    return (share() + s) * patches.stiffness(patch);
  }

  void
  PatchDilatation::find_gradients(const Vector &positions, PatchVectors &b) const
  {
    scatter->find_gradients(*cells, b);
    if (!cells->get_dilatation().has(thin_cells))
      return;
    std::vector<double> forces;
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      if (!has_special_patch(*cells, point))
        continue;
      const PatchCell<double> cell
          = patch_cell(*cells, point, fe_space.deformation_gradient(point, positions));
      const unsigned int patch = patches.of_point(point);
      fe_space.nodal_forces(point, cells->rotation(point) * cell.get_thin().gradient(), forces);
      scatter->add_at_cell(patch, point, 1. / patches.volume(patch), forces, b);
    }
  }

  PatchProducts
  PatchDilatation::find_products(const Vector &positions, const Tangent kind) const
  {
    PatchProducts products;
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      products.factors.push_back(tangent_factor(patch, kind));
    find_gradients(positions, products.vectors);
    guard.find_products(*cells, positions, kind, *scatter, products);
    return products;
  }

  void
  PatchDilatation::add_columns(const PatchVectors &b, std::vector<double> &columns) const
  {
    for (unsigned int weight = 0; weight < examples.n_weights(); ++weight)
      for (unsigned int patch = 0; examples.is_strained(weight) && patch < patches.size(); ++patch)
        scatter->add_column(
            patch, patches.stiffness(patch) * examples.patch_dilatation(patch, weight), b,
            &columns[free_dofs->local_list().size() * examples.strained_index(weight)]);
  }

  void
  PatchDilatation::add_tangent(const TermPoint     &at,
                               const Tangent        kind,
                               std::vector<double> &values,
                               std::vector<double> &columns,
                               OuterProducts       *apart)
  {
    const auto add_products = [&](PatchProducts products)
    {
      if (apart != nullptr && couples_by_products(fe_space))
        scatter->add_products(products, *apart);
      else
        scatter->add_products(*cells, products, values);
    };
    if (has_traces())
    {
      PatchProducts products = find_products(at.positions, kind);
      if (!columns.empty())
        add_columns(products.vectors, columns);
      add_products(std::move(products));
    }
    if (volumes)
      add_products(find_products_of_volumes(kind));
  }

  void
  PatchDilatation::add_densities(std::vector<double> &of_points) const
  {
    for (unsigned int point = 0; point < of_points.size(); ++point)
    {
      const unsigned int patch = patches.of_point(point);
      of_points[point] += volumes ? volumes->density(patch)
                                  : energy_of_mean(patches.lambda(patch), means[patch], 0.);
    }
    guard.add_densities(*cells, of_points);
  }

  std::size_t
  PatchDilatation::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    return patches.memory_consumption() + scatter->memory_consumption() + memory_consumption(means)
           + memory_consumption(mean_squares) + pressures.capacity() * sizeof(PressureOnPoints)
           + memory_consumption(damping.past_means) + memory_consumption(damping.factors)
           + (volumes ? volumes->memory_consumption() : 0);
  }

  // What displacements of held degrees of freedom change by the tangent of patches.

  namespace
  {
    /// R^T dP of what couples the nodes of one cell, for a change dF of F.
    Matrix3<double>
    response_of_point(CellField             &cells,
                      const unsigned int     point,
                      const Tangent          kind,
                      const Matrix3<double> &F,
                      const Matrix3<double> &dF)
    {
      const Matrix3<double> R = cells.rotation(point);
      const Matrix3<double> M = transpose_times(R, dF);
      Matrix3<double>       dP
          = patch_cell(cells, point, F)
                .response(M, cells.get_dilatation().pressure(point), kind == Tangent::convex);
      if (kind == Tangent::convex && traits_of(cells.get_batches().law(point)).has_stretch_guard
          && is_strongly_stretched(cells, point, F))
      {
        const StretchModes modes = stretch_modes(cells, point, R, F);
        for (std::size_t m = 0; m < modes.stiffness.size(); ++m)
          dP = combine(1., dP, modes.stiffness[m] * contract(modes.direction[m], M),
                       modes.direction[m]);
      }
      return dP;
    }

    /// Add it for all points of a patch.
    void
    add_response_of_points(const std::vector<unsigned int> &points,
                           const FESpace                   &fe_space,
                           const Tangent                    kind,
                           const TermPoint                 &at,
                           const Vector                    &displacement,
                           CellField                       &cells,
                           Vector                          &gradient)
    {
      std::vector<double> forces;
      for (const unsigned int point : points)
      {
        if (!has_special_patch(cells, point))
          continue;
        const Matrix3<double> dP = response_of_point(
            cells, point, kind, fe_space.deformation_gradient(point, at.positions),
            fe_space.deformation_gradient(point, displacement));
        fe_space.nodal_forces(point, cells.rotation(point) * dP, forces);
        const auto nodes = fe_space.nodes(fe_space.cell_of(point));
        for (std::size_t i = 0; i < forces.size(); ++i)
          gradient[3 * nodes[i / 3] + i % 3] += forces[i];
      }
    }
  } // namespace

  void
  PatchDilatation::add_response(const TermPoint &at,
                                const Tangent    kind,
                                const Vector    &displacement,
                                ElasticSums     &sums)
  {
    const PatchProducts products = find_products(at.positions, kind);
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      if (scatter->is_beside_held(patch))
      {
        add_response_of(patch, products, displacement, sums);
        add_response_of_points(patches.points(patch), fe_space, kind, at, displacement, *cells,
                               sums->gradient);
      }
    if (!volumes)
      return;
    const PatchProducts of_volumes = find_products_of_volumes(kind);
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      if (scatter->is_beside_held(patch))
        scatter->add(patch,
                     of_volumes.factors[patch]
                         * scatter->product(patch, of_volumes.vectors, displacement),
                     of_volumes.vectors, sums->gradient);
  }

  void
  PatchDilatation::add_response_of(const unsigned int   patch,
                                   const PatchProducts &products,
                                   const Vector        &displacement,
                                   ElasticSums         &sums) const
  {
    const double change = scatter->product(patch, products.vectors, displacement);
    scatter->add(patch, products.factors[patch] * change, products.vectors, sums->gradient);
    for (unsigned int weight = 0; weight < sums->weight_gradient.size(); ++weight)
      sums->weight_gradient[weight]
          -= patches.stiffness(patch) * change * examples.patch_dilatation(patch, weight);
    if (products.squares.empty())
      return;
    const double of_square = scatter->product(patch, products.squares, displacement);
    const double of_sum    = scatter->product(patch, products.sums, displacement);
    const double a = products.of_squares[patch], b = products.of_products[patch];
    scatter->add(patch, a * of_square + b * of_sum, products.squares, sums->gradient);
    scatter->add(patch, b * of_square, products.sums, sums->gradient);
  }
} // namespace Exemplar
