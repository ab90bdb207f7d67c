// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/example_poses.h>

// What pairs of examples cost in energy: the Gram matrix of their strains, Eq. (9).

namespace Exemplar
{
  namespace
  {
    /// 0 where eta is 0.
    double
    blended_share(const double eta)
    {
      return eta > 0. ? (1. - eta) / eta : 0.;
    }

    /// Of each patch, with the mean of eta over its volume.
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
  ExamplePoses::compute_gram_matrix(const Material &cell_material, const Patches &patches)
  {
    gram.reinit(n_weights(), n_weights());
    const bool varies = fe_space.exchange().any(cell_material.importance_varies())
                        && !cell_material.has_examples();
    const unsigned int n = varies ? n_weights() : 0;
    blended.reinit(n, n);
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
      for_each_weight(
          point,
          [&](const unsigned int v, const unsigned int i, const double share_v)
          {
            const unsigned int    cell = fe_space.cell_of(point);
            const Matrix3<double> T    = model_stress(
                   laws[cell],
                   [&](const std::size_t k) { return cell_material.number(laws[cell], cell, k); },
                   strain(point, i));
            const double more
                = varies
                      ? blended_share(example_constants.importance * cell_material.importance(cell))
                      : 0.;
            for_each_weight(point,
                            [&](const unsigned int w, const unsigned int j, const double share_w)
                            {
                              const double energy = fe_space.volume(point) * share_v * share_w
                                                    * contract(T, strain(point, j));
                              gram(v, w) += energy;
                              if (varies)
                                blended(v, w) += more * energy;
                            });
          });
    add_patches_to_gram_matrix(cell_material, patches);
    if (cell_material.has_examples())
      compute_excess(cell_material, patches);
    for (auto *const matrix : { &gram, &blended })
      if (matrix->m() > 0)
        fe_space.exchange().sum(&(*matrix)(0, 0), matrix->m() * matrix->n());
  }

  void
  ExamplePoses::compute_excess(const Material &cell_material, const Patches &patches)
  {
    blended.reinit(n_weights(), n_weights());
    std::vector<double> of_patches(patches.size(), 0.); // lambda times volume
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      const unsigned int cell   = fe_space.cell_of(point);
      const double       lambda = patches.size() > 0 ? cell_material.excess_of_patches(cell) : 0.;
      if (patches.size() > 0)
        of_patches[patches.of_point(point)] += lambda * fe_space.volume(point);
      for_each_weight(
          point,
          [&](const unsigned int v, const unsigned int i, const double share_v)
          {
            const Matrix3<double> D = strain(point, i);
            const Matrix3<double> T = combine(1., cell_material.excess_stress(cell, D),
                                              -lambda * trace(D), identity_matrix<double>());
            for_each_weight(point,
                            [&](const unsigned int w, const unsigned int j, const double share_w) {
                              blended(v, w) += fe_space.volume(point) * share_v * share_w
                                               * contract(T, strain(point, j));
                            });
          });
    }
    for (unsigned int patch = 0; patch < patch_dilatations.m(); ++patch)
      for (unsigned int v = 0; v < n_weights(); ++v)
        for (unsigned int w = 0; w < n_weights(); ++w)
          blended(v, w)
              += of_patches[patch] * patch_dilatations(patch, v) * patch_dilatations(patch, w);
  }

  void
  ExamplePoses::add_patches_to_gram_matrix(const Material &cell_material, const Patches &patches)
  {
    const std::vector<double> more
        = blended.m() > 0
              ? blended_shares(example_constants.importance, fe_space, cell_material, patches)
              : std::vector<double>(patches.size(), 0.);
    for (unsigned int patch = 0; patch < patch_dilatations.m(); ++patch)
      for (unsigned int v = 0; v < n_weights(); ++v)
        for (unsigned int w = 0; w < n_weights(); ++w)
        {
          const double energy = patches.stiffness(patch) * patch_dilatations(patch, v)
                                * patch_dilatations(patch, w);
          gram(v, w) += energy;
          if (blended.m() > 0)
            blended(v, w) += more[patch] * energy;
        }
  }

  void
  ExamplePoses::add_blended(const double factor, dealii::FullMatrix<double> &sum) const
  {
    if (blended.m() > 0)
      sum.add(factor, blended);
    else
    {
      const double eta = example_constants.importance;
      sum.add(factor * (1. - eta) / eta, gram);
    }
  }
} // namespace Exemplar
