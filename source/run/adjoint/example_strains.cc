// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/point_shape.h>
#include <exemplar/potential/patch_energy.h>
#include <exemplar/run/adjoint/example_strains.h>
#include <exemplar/run/adjoint/slope_terms.h>

namespace Exemplar
{
  Matrix3<double>
  pulled_back(const CellLaw law, const Matrix3<double> &F, const Matrix3<double> &by_strain)
  {
    const Matrix3<double> R = model_rotation(law, F);
    if (traits_of(law).has_rotations)
      return R * with_turn(symmetric_part(transpose_times(R, F)), by_strain);
    Matrix3<double> result{};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        Matrix3<double> dF{};
        dF[i][j]     = 1.;
        result[i][j] = contract(by_strain, model_strain_change(law, R, F, dF));
      }
    return result;
  }

  ExampleStrains::ExampleStrains(const Problem &problem)
      : fe_space(problem.body.fe_space), patches(problem.body.patches),
        poses(problem.examples.poses), laws(laws_of_cells(problem.parameters, problem.body))
  {
    if (fe_space.is_shell())
      return; // whose strains are others, see slope_of_shell.h
    strains.assign(fe_space.n_points() * poses.size(), {});
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
      for (unsigned int i = 0; i < poses.size(); ++i)
        if (poses.is_strained(i))
        {
          const CellLaw         law         = laws[fe_space.cell_of(point)];
          const Matrix3<double> F           = fe_space.deformation_gradient(point, poses.pose(i));
          strains[point * poses.size() + i] = pack(model_strain(law, model_rotation(law, F), F));
        }
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      bound_poses.push_back(find_pose_of_bound(patch));
  }

  Matrix3<double>
  ExampleStrains::stretch(const unsigned int point, const unsigned int i) const
  {
    return combine(1., strain(point, i), 1., identity_matrix<double>());
  }

  Matrix3<double>
  ExampleStrains::wish(const unsigned int point, const std::vector<double> &weights) const
  {
    SymmetricEntries<double> sum{};
    poses.get_strains().for_each_weight(
        point,
        [&](const unsigned int weight, const unsigned int i, const double share)
        {
          const SymmetricEntries<double> &strain = strains[point * poses.size() + i];
          for (std::size_t k = 0; k < n_symmetric; ++k)
            sum[k] += share * weights[weight] * strain[k];
        });
    return unpack(sum);
  }

  std::optional<ExampleStrains::Place>
  ExampleStrains::place_of_guard_bound() const
  {
    double               minimum = 2. * ExampleConstants().guard_bound;
    std::optional<Place> place;
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
      for (unsigned int i = 0; i < poses.size(); ++i)
      {
        if (!poses.is_strained(i) || !traits_of(laws[fe_space.cell_of(point)]).has_guard)
          continue;
        if (const double p = product_of_sums(stretch(point, i)); p < minimum)
        {
          minimum = p;
          place   = Place{ point, i };
        }
      }
    return place;
  }

  std::optional<unsigned int>
  ExampleStrains::find_pose_of_bound(const unsigned int patch) const
  {
    double                      bound = bound_of_guard(0.);
    std::optional<unsigned int> result;
    for (unsigned int i = 0; i < poses.size(); ++i)
    {
      double mean = 0.;
      for (const unsigned int point : patches.points(patch))
      {
        const Matrix3<double> F = fe_space.deformation_gradient(point, poses.pose(i));
        mean += fe_space.volume(point) / patches.volume(patch) * contract(F, F);
      }
      if (bound_of_guard(mean) > bound)
      {
        bound  = bound_of_guard(mean);
        result = i;
      }
    }
    return result;
  }

  void
  carry_strains_to_poses(const Problem &problem, SlopeDerivatives &sums)
  {
    const FESpace      &fe_space = problem.body.fe_space;
    const ExamplePoses &poses    = problem.examples.poses;
    const LawsOfCells   laws     = laws_of_cells(problem.parameters, problem.body);
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      const unsigned int cell = fe_space.cell_of(point);
      Matrix3<double>    by_gradients{};
      for (unsigned int i = 0; i < poses.size(); ++i)
        if (poses.is_strained(i))
        {
          const Matrix3<double> F = fe_space.deformation_gradient(point, poses.pose(i));
          const Matrix3<double> by_F
              = pulled_back(laws[cell], F, unpack(sums.by_strains[point * poses.size() + i]));
          add_forces(fe_space, point, by_F, sums.by_poses[i]);
          by_gradients = combine(1., by_gradients, 1., transpose_times(F, by_F));
        }
      sums.add_by_shape_gradients(cell, by_gradients);
    }
    sums.by_strains.clear();
  }
} // namespace Exemplar
