// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/potential/elastic_potential.h>
#include <exemplar/potential/weight_energy.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Exemplar
{
  namespace
  {
    void
    copy_sums(const CellSums &sums, ElasticEvaluation &result)
    {
      result.energy_elastic   = sums.energy_elastic;
      result.energy           = sums.energy;
      result.energy_damping   = sums.energy_damping;
      result.energy_inelastic = sums.energy_inelastic;
      result.min_det_F        = sums.min_det_F;
      result.inverted_cells   = sums.inverted_cells;
      result.guarded_cells    = sums.guarded_cells;
      result.stress_square    = sums.stress_square;
    }

    CellRounding
    estimate_rounding(const ElasticParts &parts)
    {
      // F of Eq. (1) carries the rounding of the positions, divided by the cell's size
      const FESpace  &fe_space = parts.fe_space;
      const Exchange &exchange = fe_space.exchange();
      CellRounding    rounding;
      rounding.rest_size        = exchange.max(fe_space.rest_positions().linfty_norm());
      const double of_positions = 2. * std::numeric_limits<double>::epsilon() * rounding.rest_size;
      Vector       force(fe_space.n_nodes());
      for (unsigned int point = 0; point < fe_space.n_points(); ++point)
      {
        const unsigned int  cell  = fe_space.cell_of(point);
        const auto          nodes = fe_space.nodes(cell);
        std::vector<double> norms;
        for (const Vector3<double> &g : fe_space.gradients(point))
          norms.push_back(std::sqrt(dot(g, g)));
        const double strain = of_positions * *std::max_element(norms.begin(), norms.end());
        const double stress = strain * parts.material.norm_estimate(cell);
        rounding.stress_norm += fe_space.volume(point) * stress * stress;
        for (unsigned int a = 0; a < nodes.size(); ++a)
          force[nodes[a]] += std::pow(fe_space.volume(point) * stress * norms[a], 2);
      }
      exchange.assemble(force.begin(), 1);
      rounding.force = std::sqrt(
          exchange.max(max_entry(force.begin(), force.end()))); // cells round independently
      rounding.stress_norm = std::sqrt(exchange.sum(rounding.stress_norm));
      return rounding;
    }
  } // namespace

  ElasticPotential::ElasticPotential(const ElasticParts &parts)
      : parts(parts), cells(parts.laws,
                            parts.examples.constants(),
                            parts.fe_space,
                            parts.cell_material,
                            parts.n_threads),
        rounding(estimate_rounding(parts))
  {
    if (parts.patches.size() > 0)
      blocks.push_back(std::make_unique<PatchDilatation>(parts.patches, parts.examples,
                                                         parts.fe_space, parts.material));
  }

  SymmetricPattern
  ElasticPotential::make_pattern(const NodePairs &more, const bool in_parts) const
  {
    NodePairs pairs = in_parts && couples_by_products()
                          ? NodePairs()
                          : PatchScatter::couplings(parts.patches, parts.fe_space);
    pairs.insert(pairs.end(), more.begin(), more.end());
    SymmetricPattern pattern   = Exemplar::make_pattern(parts.fe_space, pairs, parts.free_dofs);
    pattern.products_are_apart = in_parts;
    return pattern;
  }

  void
  ElasticPotential::attach(const SymmetricPattern &new_pattern)
  {
    pattern = &new_pattern;
    scatter.emplace(parts.fe_space, new_pattern, parts.free_dofs);
    for (const auto &block : blocks)
      block->attach(new_pattern, parts.free_dofs, cells);
  }

  void
  ElasticPotential::begin_step(const double s, const std::vector<WeightedPositions> &past)
  {
    cells.set_damping(s, past);
    for (const auto &block : blocks)
      block->begin_step();
  }

  void
  ElasticPotential::leave_step()
  {
    cells.set_damping(0., {});
    for (const auto &block : blocks)
      block->leave_step();
  }

  void
  ElasticPotential::follow_parameters()
  {
    cells.get_batches().set_constants(parts.cell_material, parts.examples.constants());
    rounding = estimate_rounding(parts);
  }

  double
  ElasticPotential::rounding_force(const double size) const
  {
    // both strains that damping compares have rounding of their own, the decomposition's, too
    const double of_strains = 1. + 8. * cells.get_damping().factor();
    // a body far from the origin has coarser positions than at rest
    return of_strains * rounding.force * std::max(1., size / rounding.rest_size);
  }

  double
  ElasticPotential::rounding_weight_gradient() const
  {
    double maximum = 0.;
    for (const double norm : parts.examples.norms())
      maximum = max_or_nan(maximum, rounding.stress_norm * norm);
    return maximum;
  }

  CellTask
  ElasticPotential::task(const Vector              &positions,
                         const std::vector<double> &weights,
                         const RotationUse          rotations)
  {
    CellTask task         = cells.task(positions, rotations);
    task.examples         = parts.examples.get_strains().arrays();
    task.weights          = weights.data();
    task.with_weight_sums = parts.weights.n_unknown() > 0;
    return task;
  }

  RotationUse
  ElasticPotential::find_pressures(const TermPoint &at, const RotationUse rotations)
  {
    if (blocks.empty())
      return rotations;
    cells.update_dilatations(at.positions, rotations);
    for (const auto &block : blocks)
    {
      block->read_dilatations(at.positions);
      block->write_pressures(at);
    }
    return RotationUse::keep;
  }

  void
  ElasticPotential::evaluate(const Vector              &positions,
                             const std::vector<double> &weights,
                             ElasticEvaluation         &result,
                             RotationUse                rotations,
                             const std::vector<double> *linear_term)
  {
    if (linear_term == nullptr)
      rotations = find_pressures({ positions, weights }, rotations);
    else
      for (const auto &block : blocks) // the loop of that term has found the dilatations
        block->write_pressures({ positions, weights });
    CellTask cell_task = task(positions, weights, rotations);
    cell_task.with_weight_sums &= linear_term == nullptr;
    NodalSums &nodal_sums = cells.get_nodal_sums();
    stripe_sums.assign(nodal_sums.n_stripes(), CellSums());
    weight_sums.reinit(stripe_sums.size(), parts.weights.n_unknown());
    nodal_sums.clear();
    nodal_sums.for_each_stripe(
        [&](const std::size_t stripe, const std::size_t begin, const std::size_t end, double *sums)
        {
          cells.for_each_law(cell_task,
                             [&](const CellTask &of_law)
                             {
                               cells.loops().evaluate(of_law, begin, end, sums,
                                                      weight_sums.of_stripe(stripe),
                                                      stripe_sums[stripe]);
                             });
        });
    CellSums sums;
    for (const CellSums &stripe : stripe_sums)
      sums += stripe;
    ElasticSums own(std::move(result)); // for its memory
    copy_sums(sums, *own);
    weight_sums.total(own->weight_gradient);
    own->weight_scale = 0.;
    for (const auto &block : blocks)
      block->add({ positions, weights }, own);
    nodal_sums.copy_to(own->gradient, own->force_scale);
    result = complete(parts.fe_space.exchange(), std::move(own));
    add_weight_energy(parts.weights, parts.examples.norms(), weights, result);
    if (linear_term != nullptr)
      set_weight_gradient(parts.weights, weights, *linear_term, result);
  }

  std::vector<double>
  ElasticPotential::weight_linear_term(const Vector &positions, const RotationUse rotations)
  {
    const CellTask cell_task = task(positions, {}, rotations);
    weight_sums.reinit(cells.get_nodal_sums().n_stripes(), parts.examples.n_weights());
    cells.get_dilatation().clear_flags();
    cells.get_nodal_sums().for_each_stripe(
        [&](const std::size_t stripe, const std::size_t begin, const std::size_t end, double *)
        {
          cells.for_each_law(cell_task,
                             [&](const CellTask &of_law) {
                               cells.loops().weight_linear_term(of_law, begin, end,
                                                                weight_sums.of_stripe(stripe));
                             });
        });
    std::vector<double> linear_term;
    weight_sums.total(linear_term);
    for (const auto &block : blocks)
    {
      block->read_dilatations(positions);
      block->add_weight_linear_term(linear_term);
    }
    parts.fe_space.exchange().sum(linear_term);
    parts.weights.get_memory().add_linear_term(linear_term);
    return linear_term;
  }

  CellResults
  ElasticPotential::cell_results(const Vector &positions, const std::vector<double> &weights)
  {
    find_pressures({ positions, weights }, RotationUse::keep);
    cells.refresh_rotations();
    const unsigned int  n        = parts.fe_space.n_cells();
    const unsigned int  n_points = parts.fe_space.n_points();
    std::vector<double> densities(n_points, 0.);
    for (const auto &block : blocks)
      block->add_densities(densities);
    const CellBatches &batches = cells.get_batches();
    CellResults results{ std::vector<double>(n), std::vector<double>(n), std::vector<double>(n),
                         std::vector<double>() };
    if (batches.has_trait(&ModelTraits::plastic_strain))
      results.plastic_strain.resize(n);
    for (unsigned int point = 0; point < n_points; ++point)
    {
      const unsigned int    cell = parts.fe_space.cell_of(point);
      const Matrix3<double> F    = parts.fe_space.deformation_gradient(point, positions);
      LawInput<double>      in   = cells.law_input(point, F);
      in.target                  = parts.examples.strain(point, weights);
      const auto      &law       = law_functions<double>(batches.law(point));
      LawValue<double> value;
      law.evaluate(in, false, value);
      const double energy
          = densities[point] + value.elastic + law.stretch_guard(in).energy_or_zero();
      Matrix3<double> T     = law.stress(in);
      const double    third = trace(T) / 3.;
      for (int i = 0; i < 3; ++i)
        T[i][i] -= third;
      const double von_mises = std::sqrt(1.5 * contract(T, T));
      const double det       = determinant(F);
      const double part      = parts.fe_space.volume(point) / parts.fe_space.cell_volume(cell);
      results.strain_energy_density[cell] += part * energy;
      results.von_mises_stress[cell] += part * von_mises;
      if (!results.plastic_strain.empty())
        results.plastic_strain[cell]
            += part * batches.history_number(point, traits_of(batches.law(point)).plastic_strain);
      const bool is_first = point == 0 || parts.fe_space.cell_of(point - 1) != cell;
      results.det_F[cell] = is_first ? det : min_or_nan(results.det_F[cell], det);
    }
    return results;
  }

  std::size_t
  ElasticPotential::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    std::size_t bytes = cells.memory_consumption() + memory_consumption(pattern->column_start)
                        + memory_consumption(pattern->row) + scatter->memory_consumption();
    for (const auto &block : blocks)
      bytes += block->memory_consumption();
    return bytes;
  }
} // namespace Exemplar
