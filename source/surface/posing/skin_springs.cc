// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/posing/skin_springs.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  SkinSprings::SkinSprings(const SurfaceSkin              &skin,
                           const std::vector<std::size_t> &vertices,
                           const Points                   &nodes,
                           const Points                   &places)
      : stiffness(vertices.size(), 0.)
  {
    for (const std::size_t v : vertices)
    {
      shares.push_back(skin.shares_of(v));
      dealii::Tensor<1, 3> from = skin.place_at_rest(v) - places[v];
      for (const auto &[node, share] : shares.back())
        from -= share * dealii::Tensor<1, 3>(nodes[node]);
      offset.push_back(from);
    }
  }

  dealii::Tensor<1, 3>
  SkinSprings::way(const std::size_t v, const Points &x) const
  {
    dealii::Tensor<1, 3> result = offset[v];
    for (const auto &[node, share] : shares[v])
      for (int d = 0; d < 3; ++d)
        result[d] += share * x[node][d];
    return result;
  }

  SkinSprings::Ways
  SkinSprings::ways(const Points &x) const
  {
    Ways result;
    for (std::size_t v = 0; v < stiffness.size(); ++v)
    {
      const double length = way(v, x).norm();
      result.mean += length / static_cast<double>(stiffness.size());
      result.greatest = std::max(result.greatest, length);
    }
    return result;
  }

  double
  SkinSprings::energy(const Points &x) const
  {
    double sum = 0.;
    for (std::size_t v = 0; v < stiffness.size(); ++v)
      sum += 0.5 * stiffness[v] * way(v, x).norm_square();
    return sum;
  }

  void
  SkinSprings::add_gradient(const Points &x, std::vector<double> &gradient) const
  {
    for (std::size_t v = 0; v < stiffness.size(); ++v)
    {
      const dealii::Tensor<1, 3> force = stiffness[v] * way(v, x);
      for (const auto &[node, share] : shares[v])
        for (int d = 0; d < 3; ++d)
          gradient[3 * node + d] += share * force[d];
    }
  }

  void
  SkinSprings::add_product(const Vector &vector, Vector &product) const
  {
    for (std::size_t v = 0; v < stiffness.size(); ++v)
    {
      double sum[3] = { 0., 0., 0. };
      for (const auto &[node, share] : shares[v])
        for (int d = 0; d < 3; ++d)
          sum[d] += share * vector[3 * node + d];
      for (const auto &[node, share] : shares[v])
        for (int d = 0; d < 3; ++d)
          product[3 * node + d] += stiffness[v] * share * sum[d];
    }
  }

  std::vector<double>
  SkinSprings::diagonal_bound(const std::size_t n_nodes) const
  {
    std::vector<double> result(n_nodes, 0.);
    for (std::size_t v = 0; v < stiffness.size(); ++v)
    {
      double sum = 0.;
      for (const auto &[node, share] : shares[v])
        sum += std::abs(share);
      for (const auto &[node, share] : shares[v])
        result[node] += stiffness[v] * std::abs(share) * sum;
    }
    return result;
  }
} // namespace Exemplar
