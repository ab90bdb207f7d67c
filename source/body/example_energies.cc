// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/example_poses.h>
#include <exemplar/body/shell_strains.h>

#include <algorithm>

// What the strains of cells and the dilatations of patches add to the forms of the weights.

namespace Exemplar
{
  namespace
  {
    /// (1 - eta) / eta; 0 where eta is 0.
    double
    blended_share(const double eta)
    {
      return eta > 0. ? (1. - eta) / eta : 0.;
    }

    /// A form of one number, with a stiffness [J] at each point.
    std::function<void(unsigned int, const double *, double *)>
    times_stiffness(std::vector<double> stiffness)
    {
      return [stiffness = std::move(stiffness)](const unsigned int point, const double *a,
                                                double *T) { *T = stiffness[point] * *a; };
    }

    /// As TargetForm::dual of a function stress(point, strain).
    template <typename Stress>
    auto
    dual_by(const Stress &stress)
    {
      return [stress](const unsigned int point, const double *a, double *T)
      {
        SymmetricEntries<double> entries;
        std::copy_n(a, n_symmetric, entries.value);
        entries = pack(stress(point, unpack(entries)));
        std::copy_n(entries.value, n_symmetric, T);
      };
    }
  } // namespace

  void
  ExamplePoses::compute_dilatations(const Patches &patches)
  {
    dilatations.clear();
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      for (const unsigned int point : patches.points(patch))
        strains.for_each_weight(
            point,
            [&](const unsigned int weight, const unsigned int i, const double share)
            {
              const double fraction = fe_space.volume(point) / patches.volume(patch);
              dilatations.number(patch, weight, 0) += fraction * share * trace(strain(point, i));
            });
  }

  TargetEnergy
  ExamplePoses::energy_of_cells(const Material &material, const Patches &patches) const
  {
    TargetEnergy energy{ strains, {}, {} };
    energy.form.dual = dual_by(
        [this, &material](const unsigned int point, const Matrix3<double> &E)
        {
          const unsigned int cell = fe_space.cell_of(point);
          const auto         number
              = [&](const std::size_t k) { return material.number(laws[cell], cell, k); };
          return model_stress(laws[cell], number, E);
        });
    if (material.has_elasticity_of_examples())
    {
      std::vector<double> lambda(fe_space.n_points(), 0.); // that patches take
      for (unsigned int patch = 0; patch < patches.size(); ++patch)
        for (const unsigned int point : patches.points(patch))
          lambda[point] = material.blend(fe_space.cell_of(point)).excess_of_patches();
      energy.excess.dual = dual_by(
          [this, &material, lambda](const unsigned int point, const Matrix3<double> &D)
          {
            return combine(1., material.blend(fe_space.cell_of(point)).excess_stress(D),
                           -lambda[point] * trace(D), identity_matrix<double>());
          });
    }
    else if (fe_space.exchange().any(material.importance_varies()))
      energy.excess
          = { energy.form.dual, [this, &material](const unsigned int point) {
               return blended_share(importance() * material.importance(fe_space.cell_of(point)));
             } };
    return energy;
  }

  TargetEnergy
  ExamplePoses::energy_of_patches(const Material &material, const Patches &patches) const
  {
    std::vector<double> stiffness, excess(patches.size(), 0.), etas(patches.size(), 0.);
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      stiffness.push_back(patches.stiffness(patch));
      for (const unsigned int point : patches.points(patch))
      {
        const unsigned int cell   = fe_space.cell_of(point);
        const double       volume = fe_space.volume(point);
        etas[patch] += volume / patches.volume(patch) * importance() * material.importance(cell);
        if (material.has_elasticity_of_examples())
          excess[patch] += material.blend(cell).excess_of_patches() * volume;
      }
    }
    TargetEnergy energy{ dilatations, { times_stiffness(stiffness) }, {} };
    if (material.has_elasticity_of_examples())
      energy.excess.dual = times_stiffness(std::move(excess));
    else if (fe_space.exchange().any(material.importance_varies()))
      energy.excess = { energy.form.dual,
                        [etas](const unsigned int patch) { return blended_share(etas[patch]); } };
    return energy;
  }

  TargetEnergy
  ExamplePoses::energy_of_shell(const Material &material) const
  {
    const auto stress = [&material, kind = fe_space.shell().kind()](const unsigned int cell,
                                                                    const double *a, double *T)
    {
      ShellStrain strain;
      std::copy_n(a, n_shell_strains, strain.begin());
      strain = shell_elasticity(material, cell, kind).stress(strain);
      std::copy_n(strain.begin(), n_shell_strains, T);
    };
    TargetEnergy energy{ strains, { stress }, {} };
    if (material.importance_varies() || bending_importance != 1.)
      energy.excess.dual
          = [this, &material, stress](const unsigned int cell, const double *a, double *T)
      {
        stress(cell, a, T);
        const double eta = importance() * material.importance(cell);
        for (unsigned int k = 0; k < n_shell_strains; ++k)
          T[k] *= blended_share(eta * (k < n_shell_strains / 2 ? 1. : bending_importance));
      };
    return energy;
  }

  void
  ExamplePoses::compute_changes_of_volumes(const Material &material)
  {
    dilatations.clear();
    std::vector<double> changes(size(), 0.);
    for (unsigned int piece = 0; piece < volumes.size(); ++piece)
    {
      for (unsigned int i = first_strained(); i < size(); ++i)
        changes[i] = volumes.change(piece, pose(i));
      for (const unsigned int cell : volumes.triangles(piece))
      {
        const double eta = fe_space.shell().triangles()[cell].area / volumes.area(piece)
                           * importance() * material.importance(cell);
        strains.for_each_weight(
            cell, [&](const unsigned int weight, const unsigned int i, const double share)
            { dilatations.number(piece, weight, 0) += eta * share * changes[i]; });
      }
    }
  }

  TargetEnergy
  ExamplePoses::energy_of_volumes(const Material &material) const
  {
    std::vector<double> stiffness, etas(volumes.size(), 0.);
    for (unsigned int piece = 0; piece < volumes.size(); ++piece)
    {
      stiffness.push_back(material.volume_stiffness() * volumes.rest(piece));
      for (const unsigned int cell : volumes.triangles(piece))
        etas[piece] += fe_space.shell().triangles()[cell].area / volumes.area(piece) * importance()
                       * material.importance(cell);
    }
    TargetEnergy energy{ dilatations, { times_stiffness(stiffness) }, {} };
    energy.excess = { energy.form.dual,
                      [etas](const unsigned int piece) { return blended_share(etas[piece]); } };
    return energy;
  }

  void
  ExamplePoses::compute_energies(const Material &cell_material, const Patches &patches)
  {
    if (fe_space.is_shell())
    {
      compute_changes_of_volumes(cell_material);
      TargetEnergy of_volumes = energy_of_volumes(cell_material);
      TargetEnergy of_shell   = energy_of_shell(cell_material);
      if (!of_shell.excess.dual)
        of_volumes.excess = {};
      compute({ of_shell, of_volumes });
      return;
    }
    compute_dilatations(patches);
    compute({ energy_of_cells(cell_material, patches), energy_of_patches(cell_material, patches) });
  }
} // namespace Exemplar
