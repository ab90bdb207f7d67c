// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/example_poses.h>

// What pairs of examples cost in energy: the Gram matrix of their strains, Eq. (9).

namespace Exemplar
{
  void
  ExamplePoses::compute_gram_matrix(const Material &cell_material, const Patches &patches)
  {
    gram.reinit(n_weights(), n_weights());
    const bool         varies = fe_space.exchange().any(cell_material.importance_varies());
    const unsigned int n      = varies ? n_weights() : 0;
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
            const double more = varies ? blended_share(cell_material.importance(cell)) : 0.;
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
    for (auto *const matrix : { &gram, &blended })
      if (matrix->m() > 0)
        fe_space.exchange().sum(&(*matrix)(0, 0), matrix->m() * matrix->n());
  }

  void
  ExamplePoses::add_patches_to_gram_matrix(const Material &cell_material, const Patches &patches)
  {
    const std::vector<double> more = blended.m() > 0 ? blended_shares(cell_material, patches)
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

  std::vector<double>
  ExamplePoses::blended_shares(const Material &cell_material, const Patches &patches) const
  {
    std::vector<double> factors(patches.size(), 0.);
    for (unsigned int point = 0; patches.size() > 0 && point < fe_space.n_points(); ++point)
    {
      const unsigned int patch = patches.of_point(point);
      factors[patch] += fe_space.volume(point) / patches.volume(patch)
                        * cell_material.importance(fe_space.cell_of(point));
    }
    for (double &factor : factors)
      factor = blended_share(factor);
    return factors;
  }

  double
  ExamplePoses::blended_share(const double factor) const
  {
    const double eta = factor * example_constants.importance;
    return eta > 0. ? (1. - eta) / eta : 0.;
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
