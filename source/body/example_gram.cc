// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/example_gram.h>
#include <exemplar/body/example_poses.h>

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

    /// blended_share() of each patch, by the mean of eta over its volume.
    std::vector<double>
    blended_shares(const double    importance,
                   const FESpace  &fe_space,
                   const Material &material,
                   const Patches  &patches)
    {
      std::vector<double> etas(patches.size(), 0.);
      for (unsigned int point = 0; patches.size() > 0 && point < fe_space.n_points(); ++point)
      {
        const unsigned int patch    = patches.of_point(point);
        const double       fraction = fe_space.volume(point) / patches.volume(patch);
        etas[patch] += fraction * importance * material.importance(fe_space.cell_of(point));
      }
      for (double &eta : etas)
        eta = blended_share(eta);
      return etas;
    }
  } // namespace

  void
  ExampleGram::compute(const ExamplePoses &poses,
                       const FESpace      &fe_space,
                       const LawsOfCells  &laws,
                       const Material     &cell_material,
                       const Patches      &patches)
  {
    importance = poses.constants().importance;
    compute_patch_dilatations(poses, fe_space, patches);
    const unsigned int n      = poses.n_weights();
    const bool         varies = fe_space.exchange().any(cell_material.importance_varies())
                        && !cell_material.has_elasticity_of_examples();
    gram.reinit(n, n);
    blended.reinit(varies ? n : 0, varies ? n : 0);
    add_cells(poses, fe_space, laws, cell_material);
    add_patches(fe_space, cell_material, patches);
    if (cell_material.has_elasticity_of_examples())
      compute_excess(poses, fe_space, cell_material, patches);
    for (auto *const matrix : { &gram, &blended })
      if (matrix->m() > 0)
        fe_space.exchange().sum(&(*matrix)(0, 0), matrix->m() * matrix->n());
  }

  void
  ExampleGram::add_cells(const ExamplePoses &poses,
                         const FESpace      &fe_space,
                         const LawsOfCells  &laws,
                         const Material     &cell_material)
  {
    const bool varies = blended.m() > 0;
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
      poses.for_each_weight(
          point,
          [&](const unsigned int v, const unsigned int i, const double share_v)
          {
            const unsigned int    cell = fe_space.cell_of(point);
            const Matrix3<double> T    = model_stress(
                   laws[cell],
                   [&](const std::size_t k) { return cell_material.number(laws[cell], cell, k); },
                   poses.strain(point, i));
            const double more
                = varies ? blended_share(importance * cell_material.importance(cell)) : 0.;
            poses.for_each_weight(
                point,
                [&](const unsigned int w, const unsigned int j, const double share_w)
                {
                  const double energy = fe_space.volume(point) * share_v * share_w
                                        * contract(T, poses.strain(point, j));
                  gram(v, w) += energy;
                  if (varies)
                    blended(v, w) += more * energy;
                });
          });
  }

  void
  ExampleGram::compute_patch_dilatations(const ExamplePoses &poses,
                                         const FESpace      &fe_space,
                                         const Patches      &patches)
  {
    patch_dilatations.reinit(patches.size(), poses.n_weights());
    if (patches.size() == 0)
      return;
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      const unsigned int patch    = patches.of_point(point);
      const double       fraction = fe_space.volume(point) / patches.volume(patch);
      poses.for_each_weight(
          point,
          [&](const unsigned int weight, const unsigned int i, const double share) {
            patch_dilatations(patch, weight) += fraction * share * trace(poses.strain(point, i));
          });
    }
  }

  void
  ExampleGram::compute_excess(const ExamplePoses &poses,
                              const FESpace      &fe_space,
                              const Material     &cell_material,
                              const Patches      &patches)
  {
    blended.reinit(gram.m(), gram.m());
    std::vector<double> of_patches(patches.size(), 0.); // lambda V of each patch
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      const unsigned int cell = fe_space.cell_of(point);
      const double lambda = patches.size() > 0 ? cell_material.blend(cell).excess_of_patches() : 0.;
      if (patches.size() > 0)
        of_patches[patches.of_point(point)] += lambda * fe_space.volume(point);
      poses.for_each_weight(
          point,
          [&](const unsigned int v, const unsigned int i, const double share_v)
          {
            const Matrix3<double> D = poses.strain(point, i);
            const Matrix3<double> T = combine(1., cell_material.blend(cell).excess_stress(D),
                                              -lambda * trace(D), identity_matrix<double>());
            poses.for_each_weight(
                point,
                [&](const unsigned int w, const unsigned int j, const double share_w)
                {
                  blended(v, w) += fe_space.volume(point) * share_v * share_w
                                   * contract(T, poses.strain(point, j));
                });
          });
    }
    for (unsigned int patch = 0; patch < patch_dilatations.m(); ++patch)
      for (unsigned int v = 0; v < gram.m(); ++v)
        for (unsigned int w = 0; w < gram.m(); ++w)
          blended(v, w)
              += of_patches[patch] * patch_dilatations(patch, v) * patch_dilatations(patch, w);
  }

  void
  ExampleGram::add_patches(const FESpace  &fe_space,
                           const Material &cell_material,
                           const Patches  &patches)
  {
    const std::vector<double> more
        = blended.m() > 0 ? blended_shares(importance, fe_space, cell_material, patches)
                          : std::vector<double>(patches.size(), 0.);
    for (unsigned int patch = 0; patch < patch_dilatations.m(); ++patch)
      for (unsigned int v = 0; v < gram.m(); ++v)
        for (unsigned int w = 0; w < gram.m(); ++w)
        {
          const double energy = patches.stiffness(patch) * patch_dilatations(patch, v)
                                * patch_dilatations(patch, w);
          gram(v, w) += energy;
          if (blended.m() > 0)
            blended(v, w) += more[patch] * energy;
        }
  }

  void
  ExampleGram::add_blended(const double factor, dealii::FullMatrix<double> &sum) const
  {
    if (blended.m() > 0)
      sum.add(factor, blended);
    else
      sum.add(factor * (1. - importance) / importance, gram);
  }

  std::size_t
  ExampleGram::memory_consumption() const
  {
    return patch_dilatations.memory_consumption() + gram.memory_consumption()
           + blended.memory_consumption();
  }
} // namespace Exemplar
