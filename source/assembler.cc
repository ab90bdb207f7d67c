// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/assembler.h>
#include <exemplar/hot_loop.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Exemplar
{
  namespace
  {
    double
    norm(const Matrix3<double> &A)
    {
      return std::sqrt(contract(A, A));
    }
  } // namespace

  Assembler::Assembler(const ModelParameters &model,
                       const FESpace         &fe_space,
                       const Material        &material,
                       const ExamplePoses    *examples,
                       const Inertia         *inertia,
                       const FreeDofs        &free_dofs)
      : model(model), fe_space(fe_space), material(material), examples(examples), inertia(inertia),
        free_dofs(free_dofs), guard_bound(model.is_frozen()     ? no_guard
                                          : examples == nullptr ? default_guard_bound
                                                                : examples->guard_bound()),
        gradient_norms(fe_space.n_cells()), rotations(fe_space.n_cells(), identity_matrix<double>())
  {
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      for (unsigned int a = 0; a < 4; ++a)
      {
        const Vector3<double> &g = fe_space.tetrahedron(cell).shape_gradient[a];
        gradient_norms[cell][a]  = std::sqrt(dot(g, g));
      }
    estimate_rounding();
    build_pattern();
    build_scatter();
    if (inertia != nullptr)
      build_mass_values();
  }

  void
  Assembler::estimate_rounding()
  {
    // F of Eq. (1) carries the rounding of the positions, divided by the cell's size
    const double rounding
        = 2. * std::numeric_limits<double>::epsilon() * fe_space.rest_positions().linfty_norm();
    dealii::Vector<double> force(fe_space.n_nodes());
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      const Lame<double> &lame   = material.lame(cell);
      const double        volume = fe_space.tetrahedron(cell).volume;
      const double        strain
          = rounding * *std::max_element(gradient_norms[cell].begin(), gradient_norms[cell].end());
      const double stress = strain * (std::abs(lame.lambda) + 2. * lame.mu);
      rounding_stress_norm += volume * stress * stress;
      for (unsigned int a = 0; a < 4; ++a)
        force[fe_space.nodes(cell)[a]] += std::pow(volume * stress * gradient_norms[cell][a], 2);
    }
    greatest_rounding_force = std::sqrt(force.linfty_norm()); // cells round independently
    rounding_stress_norm    = std::sqrt(rounding_stress_norm);
  }

  double
  Assembler::rounding_weight_gradient(const unsigned int weight) const
  {
    return examples->importance() * rounding_stress_norm * examples->strain_norm(weight);
  }

  void
  Assembler::build_pattern()
  {
    const dealii::SparsityPattern nodal = fe_space.nodal_pattern();
    pattern.column_start.push_back(0);
    for (const unsigned int dof : free_dofs.list())
    {
      const auto begin = pattern.row.size();
      for (auto entry = nodal.begin(dof / 3); entry != nodal.end(dof / 3); ++entry)
        for (unsigned int c = 0; c < 3; ++c)
          if (const unsigned int other = 3 * entry->column() + c; other >= dof)
            if (const int row = free_dofs.free_index(other); row != FreeDofs::held)
              pattern.row.push_back(row);
      std::sort(pattern.row.begin() + begin, pattern.row.end());
      pattern.column_start.push_back(pattern.row.size());
    }
  }

  void
  Assembler::build_scatter()
  {
    scatter.resize(fe_space.n_cells());
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      int dof[12];
      for (unsigned int p = 0; p < 12; ++p)
        dof[p] = free_dofs.free_index(3 * fe_space.nodes(cell)[p / 3] + p % 3);
      if (std::find(dof, dof + 12, FreeDofs::held) != dof + 12)
        cells_beside_held_nodes.push_back(cell);
      unsigned int entry = 0;
      for (unsigned int p = 0; p < 12; ++p)
        for (unsigned int q = 0; q <= p; ++q, ++entry)
          scatter[cell][entry]
              = dof[p] == FreeDofs::held || dof[q] == FreeDofs::held
                    ? FreeDofs::held
                    : pattern.position(std::max(dof[p], dof[q]), std::min(dof[p], dof[q]));
    }
  }

  void
  Assembler::build_mass_values()
  {
    mass_values.assign(pattern.row.size(), 0.);
    const dealii::SparseMatrix<double> &mass = inertia->nodal_mass();
    for (const unsigned int dof : free_dofs.list())
      for (auto entry = mass.begin(dof / 3); entry != mass.end(dof / 3); ++entry)
      {
        const unsigned int other = 3 * entry->column() + dof % 3;
        if (other >= dof && free_dofs.free_index(other) != FreeDofs::held)
          mass_values[pattern.position(free_dofs.free_index(other), free_dofs.free_index(dof))]
              = entry->value();
      }
  }

  EXEMPLAR_HOT_LOOP void
  Assembler::update_rotations(const dealii::Vector<double> &positions)
  {
    if (model.strain != StrainMeasure::corotational)
      return;
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      rotations[cell] = closest_rotation(fe_space.deformation_gradient(cell, positions));
  }

  void
  Assembler::set_damping(const double s, const std::vector<WeightedPositions> &history)
  {
    damping = s;
    cell_damping.assign(s > 0. ? fe_space.n_cells() : 0, s);
    damping_strains.assign(cell_damping.size(), Matrix3<double>{});
    for (unsigned int cell = 0; cell < cell_damping.size(); ++cell)
      for (const WeightedPositions &past : history)
      {
        const Matrix3<double> F = fe_space.deformation_gradient(cell, *past.positions);
        const Matrix3<double> R = model_rotation(model.strain, F);
        const Matrix3<double> e = model_strain(model.strain, R, F);
        damping_strains[cell]   = combine(1., damping_strains[cell], past.weight, e);
        if (model.strain == StrainMeasure::corotational
            && CorotationalCell<double>(material.lame(cell), R, F, guard_bound).is_guarded())
          cell_damping[cell] = 0.;
      }
  }

  Matrix3<double>
  Assembler::example_target(const unsigned int cell, const std::vector<double> &weights) const
  {
    if (examples == nullptr)
      return Matrix3<double>{};
    const Matrix3<double> E = examples->strain(cell, weights);
    return combine(examples->importance(), E, 0., E);
  }

  Lame<double>
  Assembler::damped_lame(const unsigned int cell) const
  {
    const Lame<double> &lame = material.lame(cell);
    return { (1. + damping_of(cell)) * lame.lambda, (1. + damping_of(cell)) * lame.mu };
  }

  Matrix3<double>
  Assembler::damped_target(const unsigned int cell, const Matrix3<double> &target) const
  {
    const double s = damping_of(cell);
    if (s == 0.)
      return target;
    return combine(1. / (1. + s), target, s / (1. + s), damping_strains[cell]);
  }

  template <typename Cell>
  void
  Assembler::evaluate_cells(const dealii::Vector<double> &positions,
                            const std::vector<double>    &weights,
                            Evaluation                   &result) const
  {
    const double eta           = examples != nullptr ? examples->importance() : 0.;
    const bool   frozen        = model.is_frozen();
    double       stress_square = 0.; // sum V (|C:e| + eta |C:E(w)|)^2

    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      const Tetrahedron<double> &tet   = fe_space.tetrahedron(cell);
      const Lame<double>        &lame  = material.lame(cell);
      const Matrix3<double>      F     = fe_space.deformation_gradient(cell, positions);
      const double               det_F = determinant(F);
      Cell                       state(lame, rotations[cell], F, guard_bound);
      const Matrix3<double>      elastic_stress = stress(lame, state.strain());
      const double elastic      = 0.5 * tet.volume * contract(elastic_stress, state.strain());
      double       stress_scale = norm(elastic_stress);
      result.min_det_F          = std::min(result.min_det_F, det_F);
      result.inverted_cells += (det_F <= 0.);
      result.energy_elastic += elastic;

      Matrix3<double> target{}; // eta E(w)
      if (examples != nullptr)
      {
        target = example_target(cell, weights);
        stress_scale += norm(stress(lame, target));
        stress_square += tet.volume * stress_scale * stress_scale;
        result.energy += tet.volume * state.energy(target);
        result.guarded_cells += state.is_guarded();
        if (!result.weight_gradient.empty())
        {
          const Matrix3<double> T = state.weight_stress(target);
          examples->for_each_weight(
              cell,
              [&](const unsigned int weight, const unsigned int i, const double share)
              {
                result.weight_gradient[weight]
                    -= share * eta * tet.volume * contract(T, examples->strain(cell, i));
              });
        }
      }
      else
        result.energy += elastic;
      const double s = damping_of(cell);
      if (s > 0.)
      {
        result.energy_damping += s * tet.volume * state.energy(damping_strains[cell]);
        stress_scale += s * (norm(elastic_stress) + norm(stress(lame, damping_strains[cell])));
        target = damped_target(cell, target);
        state  = Cell(damped_lame(cell), rotations[cell], F, guard_bound);
      }

      Matrix3<double> P; // R^T P
      if (examples == nullptr && s == 0.)
        P = state.elastic_force();
      else if (frozen)
        P = state.weight_stress(target);
      else
      {
        state.set_target(target);
        P = state.force();
      }
      add_force(cell, P, result.gradient);
      const double force_scale = tet.volume * state.force_factor() * stress_scale;
      for (unsigned int a = 0; a < 4; ++a)
        result.force_scale[fe_space.nodes(cell)[a]] += force_scale * gradient_norms[cell][a];
    }
    if (has_weights())
      add_penalty(weights, std::sqrt(stress_square), result);
  }

  void
  Assembler::add_penalty(const std::vector<double> &weights,
                         const double               stress_norm,
                         Evaluation                &result) const
  {
    for (unsigned int v = 0; v < weights.size(); ++v)
    {
      double penalty = 0.;
      for (unsigned int w = 0; w < weights.size(); ++w)
        penalty += examples->penalty_matrix()(v, w) * weights[w];
      result.energy += 0.5 * penalty * weights[v];
      result.weight_gradient[v] += penalty;
      result.weight_scale = std::max(result.weight_scale,
                                     examples->importance() * stress_norm * examples->strain_norm(v)
                                         + std::abs(penalty));
    }
  }

  EXEMPLAR_HOT_LOOP void
  Assembler::evaluate(const dealii::Vector<double> &positions,
                      const std::vector<double>    &weights,
                      Evaluation                   &result) const
  {
    result.gradient.reinit(fe_space.n_dofs());
    result.force_scale.reinit(fe_space.n_nodes());
    result.weight_gradient.assign(has_weights() ? weights.size() : 0, 0.);
    result.weight_scale   = 0.;
    result.energy_elastic = 0.;
    result.energy         = 0.;
    result.energy_damping = 0.;
    result.min_det_F      = std::numeric_limits<double>::max();
    result.inverted_cells = 0;
    result.guarded_cells  = 0;
    with_cell_model(
        model.strain, [&](auto cell_model)
        { evaluate_cells<typename decltype(cell_model)::type>(positions, weights, result); });
  }

  EXEMPLAR_HOT_LOOP std::vector<double>
                    Assembler::weight_target(const dealii::Vector<double> &positions) const
  {
    std::vector<double> c(examples->n_weights(), 0.);
    with_cell_model(
        model.strain,
        [&](auto cell_model)
        {
          using Cell = typename decltype(cell_model)::type;
          for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
          {
            const Cell            state(material.lame(cell), rotations[cell],
                                        fe_space.deformation_gradient(cell, positions), guard_bound);
            const Matrix3<double> T = state.weight_stress(Matrix3<double>{});
            const double factor     = examples->importance() * fe_space.tetrahedron(cell).volume;
            examples->for_each_weight(
                cell, [&](const unsigned int weight, const unsigned int i, const double share)
                { c[weight] += share * factor * contract(T, examples->strain(cell, i)); });
          }
        });
    return c;
  }

  CellResults
  Assembler::cell_results(const dealii::Vector<double> &positions,
                          const std::vector<double>    &weights) const
  {
    const unsigned int n = fe_space.n_cells();
    CellResults results{ std::vector<double>(n), std::vector<double>(n), std::vector<double>(n) };
    for (unsigned int cell = 0; cell < n; ++cell)
    {
      const Lame<double>   &lame   = material.lame(cell);
      const Matrix3<double> F      = fe_space.deformation_gradient(cell, positions);
      const Matrix3<double> strain = model_strain(model.strain, rotations[cell], F);
      Matrix3<double>       T      = stress(lame, strain);

      results.strain_energy_density[cell] = 0.5 * contract(T, strain);
      results.det_F[cell]                 = determinant(F);
      if (examples != nullptr)
        T = stress(lame, combine(1., strain, -1., example_target(cell, weights)));
      const double third = trace(T) / 3.;
      for (int i = 0; i < 3; ++i)
        T[i][i] -= third;
      results.von_mises_stress[cell] = std::sqrt(1.5 * contract(T, T));
    }
    return results;
  }
} // namespace Exemplar
