// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/patch_guard.h>

#include <algorithm>
#include <limits>

namespace Exemplar
{
  PatchGuard::PatchGuard(const Patches &patches, const FESpace &fe_space, const Material &material)
      : patches(patches), fe_space(fe_space), material(material),
        least_pressures(patches.size(), std::numeric_limits<double>::max())
  {
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      for (const unsigned int point : patches.points(patch))
      {
        const KinkSlope<double> at_rest = kink(point, 0.);
        least_pressures[patch] = std::min(least_pressures[patch], -at_rest.slope - at_rest.margin);
      }
  }

  KinkSlope<double>
  PatchGuard::kink(const unsigned int point, const double elastic_pressure) const
  {
    return patch_kink_slope(material.elasticity(fe_space.cell_of(point)), elastic_pressure);
  }

  void
  PatchGuard::find(const CellField           &cells,
                   const Vector              &positions,
                   const std::vector<double> &means)
  {
    guards.clear();
    sums.clear();
    if (!traits_of(cells.strain_measure()).has_guard || cells.get_guard_bound() == no_guard)
      return;
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      if (patches.lambda(patch) * means[patch] > least_pressures[patch])
        for (const unsigned int point : patches.points(patch))
          find_at(cells, positions, patch, point, patches.lambda(patch) * means[patch]);
  }

  void
  PatchGuard::find_at(const CellField   &cells,
                      const Vector      &positions,
                      const unsigned int patch,
                      const unsigned int point,
                      const double       elastic_pressure)
  {
    const Matrix3<double> F = fe_space.deformation_gradient(point, positions);
    const Matrix3<double> S = symmetric_part(transpose_times(cells.rotation(point), F));
    Matrix3<double>       B = combine(-1., S, 0., S);
    for (int i = 0; i < 3; ++i)
      B[i][i] += trace(S);
    const StretchGuard<double> guard(kink(point, elastic_pressure), S, determinant(B));
    if (!guard.acts())
      return;
    const double lambda = patches.lambda(patch), factor = fe_space.volume(point) * lambda;
    sums[patch].by_mean += factor * guard.by_slope();
    sums[patch].second_by_mean += factor * lambda * guard.second_by_slope();
    guards.emplace(point, guard);
  }

  double
  PatchGuard::density(const unsigned int point) const
  {
    const auto guard = guards.find(point);
    return guard == guards.end() ? 0. : guard->second.energy();
  }

  double
  PatchGuard::energy() const
  {
    double sum = 0.;
    for (const auto &[point, guard] : guards)
      sum += fe_space.volume(point) * guard.energy();
    return sum;
  }

  double
  PatchGuard::by_mean(const unsigned int patch) const
  {
    const auto sum = sums.find(patch);
    return sum == sums.end() ? 0. : sum->second.by_mean;
  }

  double
  PatchGuard::second_by_mean(const unsigned int patch) const
  {
    const auto sum = sums.find(patch);
    return sum == sums.end() ? 0. : sum->second.second_by_mean;
  }

  template <typename Function>
  void
  PatchGuard::for_each_force(const CellField       &cells,
                             const unsigned int     point,
                             const Matrix3<double> &P,
                             const Function        &function) const
  {
    const Matrix3<double> RP    = cells.rotation(point) * P;
    const auto            nodes = fe_space.nodes(fe_space.cell_of(point));
    for (unsigned int a = 0; a < nodes.size(); ++a)
    {
      Vector3<double> force = RP * fe_space.gradients(point)[a];
      for (unsigned int c = 0; c < 3; ++c)
        force[c] *= fe_space.volume(point);
      function(nodes[a], force);
    }
  }

  void
  PatchGuard::add_forces(const CellField &cells, Vector &gradient) const
  {
    for (const auto &[point, guard] : guards)
      for_each_force(cells, point, guard.force(),
                     [&](const unsigned int node, const Vector3<double> &force)
                     {
                       for (unsigned int c = 0; c < 3; ++c)
                         gradient[3 * node + c] += force[c];
                     });
  }

  void
  PatchGuard::add_forces_by_mean(const CellField                 &cells,
                                 const unsigned int               patch,
                                 const std::vector<unsigned int> &nodes,
                                 std::vector<double>             &forces) const
  {
    if (sums.count(patch) == 0)
      return;
    for (const unsigned int point : patches.points(patch))
      if (const auto guard = guards.find(point); guard != guards.end())
        for_each_force(cells, point, guard->second.force_by_slope(),
                       [&](const unsigned int node, const Vector3<double> &force)
                       {
                         const auto place
                             = std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin();
                         for (unsigned int c = 0; c < 3; ++c)
                           forces[3 * place + c] += patches.lambda(patch) * force[c];
                       });
  }
} // namespace Exemplar
