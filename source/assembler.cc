// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/assembler.h>
#include <exemplar/corotational_consistent.h>
#include <exemplar/polar_decomposition.h>
#include <exemplar/prm_tools.h>

#include <algorithm>
#include <cmath>
#include <limits>

// The loops over the cells are "flattened", because the kernels are too large for the
// compiler to inline them by its own judgement and a call costs as much as some of them
// do; and compiled for three levels of instruction sets, of which the loader takes the
// best that the CPU has.
#ifdef __x86_64__
#define EXEMPLAR_HOT_LOOP                                                                          \
  [[gnu::flatten, gnu::target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")]]
#else
#define EXEMPLAR_HOT_LOOP [[gnu::flatten]]
#endif

namespace Exemplar
{
  namespace
  {
    const EnumTable<StrainMeasure> strain_measures
        = { { StrainMeasure::corotational, "corotational" } };
    const EnumTable<GradientKind> gradient_kinds
        = { { GradientKind::consistent, "consistent" }, { GradientKind::frozen, "frozen" } };

    double
    norm(const Matrix3<double> &A)
    {
      return std::sqrt(contract(A, A));
    }

    Matrix3<double>
    difference(const Matrix3<double> &A, const Matrix3<double> &B, const double factor)
    {
      Matrix3<double> C;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          C[i][j] = A[i][j] - factor * B[i][j];
      return C;
    }

    /// A = I + eta E(w).
    Matrix3<double>
    target_stretch(const Matrix3<double> &strain, const double eta)
    {
      return combine(1., identity_matrix<double>(), eta, strain);
    }

    void
    add_nodal(const std::array<unsigned int, 4> &nodes,
              const Vector3<double> (&values)[4],
              dealii::Vector<double> &field)
    {
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int c = 0; c < 3; ++c)
          field[3 * nodes[a] + c] += values[a][c];
    }
  } // namespace

  void
  ModelParameters::declare(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Model");
    declare_enum(prm, "Strain", strain, strain_measures,
                 "corotational: the strain of the deformation freed of the cell's rotation.");
    declare_enum(
        prm, "Gradient", gradient, gradient_kinds,
        "consistent: the force is the gradient of the energy; frozen: the paper's force R T, "
        "which holds the rotation fixed while it differentiates the energy.");
    prm.leave_subsection();
  }

  Assembler::Assembler(const ModelParameters &model,
                       const FESpace         &fe_space,
                       const Material        &material,
                       const ExamplePoses    *examples,
                       const Inertia         *inertia,
                       const FreeDofs        &free_dofs)
      : model(model), fe_space(fe_space), material(material), examples(examples), inertia(inertia),
        free_dofs(free_dofs), gradient_norms(fe_space.n_cells()),
        rotations(fe_space.n_cells(), identity_matrix<double>())
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
    dealii::Vector<double> force(fe_space.n_nodes());
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      const Lame<double> &lame   = material.lame(cell);
      const double        volume = fe_space.tetrahedron(cell).volume;
      const double        stress = 1e-14 * (std::abs(lame.lambda) + 2. * lame.mu);
      rounding_stress_norm += volume * stress * stress;
      for (unsigned int a = 0; a < 4; ++a)
        force[fe_space.nodes(cell)[a]] += volume * stress * gradient_norms[cell][a];
    }
    greatest_rounding_force = force.linfty_norm();
    rounding_stress_norm    = std::sqrt(rounding_stress_norm);
  }

  double
  Assembler::rounding_weight_gradient(const unsigned int i) const
  {
    return examples->importance() * rounding_stress_norm * examples->strain_norm(i);
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
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      rotations[cell] = closest_rotation(fe_space.deformation_gradient(cell, positions));
  }

  EXEMPLAR_HOT_LOOP void
  Assembler::evaluate(const dealii::Vector<double> &positions,
                      const std::vector<double>    &weights,
                      Evaluation                   &result) const
  {
    const double eta          = examples != nullptr ? examples->importance() : 0.;
    const bool   free_weights = examples != nullptr && !examples->weights_are_prescribed();
    const bool   consistent   = examples != nullptr && model.gradient == GradientKind::consistent;

    result.gradient.reinit(fe_space.n_dofs());
    result.force_scale.reinit(fe_space.n_nodes());
    result.weight_gradient.assign(free_weights ? weights.size() : 0, 0.);
    result.weight_scale   = 0.;
    result.energy_elastic = 0.;
    result.energy_example = 0.;
    result.min_det_F      = std::numeric_limits<double>::max();
    result.inverted_cells = 0;
    result.guarded_cells  = 0;
    double stress_square  = 0.; // sum V (|C:e| + eta |C:E(w)|)^2

    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      const Tetrahedron<double> &tet    = fe_space.tetrahedron(cell);
      const Lame<double>        &lame   = material.lame(cell);
      const Matrix3<double>      F      = fe_space.deformation_gradient(cell, positions);
      const Matrix3<double>      strain = corotated_strain(rotations[cell], F); // e
      const double               det_F  = determinant(F);

      Matrix3<double> T           = stress(lame, strain);
      const double    elastic     = 0.5 * tet.volume * contract(T, strain);
      double          force_scale = norm(T);
      result.min_det_F            = std::min(result.min_det_F, det_F);
      result.inverted_cells += (det_F <= 0.);
      result.energy_elastic += elastic;

      if (examples != nullptr)
      {
        const Matrix3<double> target    = examples->strain(cell, weights); // E(w)
        const Matrix3<double> deviation = difference(strain, target, eta);
        force_scale += eta * norm(stress(lame, target));
        stress_square += tet.volume * force_scale * force_scale;
        T = stress(lame, deviation);
        // the residual form: near an example the expanded one cancels
        double density = 0.5 * contract(T, deviation);
        // without a guard, C:(e - eta E(w)) is also what the weights' derivative contracts
        Matrix3<double> weight_stress = T;
        if (consistent)
        {
          const Matrix3<double>  A = target_stretch(target, eta);
          ConsistentCell<double> state(lame, rotations[cell], F, examples->guard_bound());
          state.set_target(A);
          T = state.force();
          if (state.is_guarded())
          {
            density       = state.energy(A);
            weight_stress = state.weight_stress(A);
            ++result.guarded_cells;
          }
        }
        result.energy_example += tet.volume * density - elastic;
        for (unsigned int i = examples->first_strained_example(); i < result.weight_gradient.size();
             ++i)
          result.weight_gradient[i]
              -= eta * tet.volume * contract(weight_stress, examples->strain(cell, i));
      }

      Vector3<double> force[4];
      frozen_forces(tet, rotations[cell], T, force);
      add_nodal(fe_space.nodes(cell), force, result.gradient);
      for (unsigned int a = 0; a < 4; ++a)
        result.force_scale[fe_space.nodes(cell)[a]]
            += tet.volume * force_scale * gradient_norms[cell][a];
    }

    for (unsigned int i = 0; i < result.weight_gradient.size(); ++i)
    {
      double penalty = 0.; // of the weights alone
      for (unsigned int j = 0; j < weights.size(); ++j)
        penalty += examples->penalty_matrix()(i, j) * weights[j];
      result.energy_example += 0.5 * penalty * weights[i];
      result.weight_gradient[i] += penalty;
      result.weight_scale
          = std::max(result.weight_scale,
                     eta * std::sqrt(stress_square) * examples->strain_norm(i) + std::abs(penalty));
    }
  }

  void
  Assembler::add_response_beside_held_nodes(const dealii::Vector<double> &displacement,
                                            Evaluation                   &result) const
  {
    for (const unsigned int cell : cells_beside_held_nodes)
    {
      const Tetrahedron<double> &tet = fe_space.tetrahedron(cell);
      const Matrix3<double>      dF  = fe_space.deformation_gradient(cell, displacement);
      const Matrix3<double>      dT
          = stress(material.lame(cell), symmetric_part(transpose_times(rotations[cell], dF)));
      Vector3<double> force[4];
      frozen_forces(tet, rotations[cell], dT, force);
      add_nodal(fe_space.nodes(cell), force, result.gradient);
      for (unsigned int i = examples != nullptr ? examples->first_strained_example() : 0;
           i < result.weight_gradient.size(); ++i)
        result.weight_gradient[i]
            -= examples->importance() * tet.volume * contract(dT, examples->strain(cell, i));
    }
  }

  void
  Assembler::start_matrix(std::vector<double> &matrix_values) const
  {
    if (inertia == nullptr)
      std::fill(matrix_values.begin(), matrix_values.end(), 0.);
    else
      for (std::size_t i = 0; i < matrix_values.size(); ++i)
        matrix_values[i] = inertia->matrix_factor() * mass_values[i];
  }

  EXEMPLAR_HOT_LOOP void
  Assembler::assemble_matrix(std::vector<double> &matrix_values) const
  {
    start_matrix(matrix_values);
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      const Tetrahedron<double> &tet = fe_space.tetrahedron(cell);
      Vector3<double>            g[4];
      rotate_gradients(tet, rotations[cell], g);
      CellMatrix cell_matrix;
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = 0; b <= a; ++b)
        {
          const Matrix3<double> block
              = stiffness_block(material.lame(cell), tet.volume, g[a], g[b]);
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int j = 0; j < 3; ++j)
              cell_matrix[3 * a + i][3 * b + j] = block[i][j];
        }
      add_cell_matrix(cell, cell_matrix, matrix_values);
    }
  }

  EXEMPLAR_HOT_LOOP void
  Assembler::assemble_coupling(std::vector<double> &columns) const
  {
    columns.assign(static_cast<std::size_t>(free_dofs.size()) * examples->size(), 0.);
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      for (unsigned int i = examples->first_strained_example(); i < examples->size(); ++i)
      {
        const Matrix3<double> T = stress(material.lame(cell), examples->strain(cell, i));
        Vector3<double>       force[4];
        frozen_forces(fe_space.tetrahedron(cell), rotations[cell], T, force);
        add_to_column(cell, force, i, columns);
      }
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
      const Matrix3<double> strain = corotated_strain(rotations[cell], F);
      Matrix3<double>       T      = stress(lame, strain);

      results.strain_energy_density[cell] = 0.5 * contract(T, strain);
      results.det_F[cell]                 = determinant(F);
      if (examples != nullptr)
        T = stress(lame,
                   difference(strain, examples->strain(cell, weights), examples->importance()));
      const double third = trace(T) / 3.;
      for (int i = 0; i < 3; ++i)
        T[i][i] -= third;
      results.von_mises_stress[cell] = std::sqrt(1.5 * contract(T, T));
    }
    return results;
  }
} // namespace Exemplar
