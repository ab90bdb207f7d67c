// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/problem/body_measures.h>
#include <exemplar/run/problem/problem_parts.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    double
    boundary_area(const Mesh &mesh)
    {
      double area = 0.;
      for (const BoundaryFace &face : mesh.get_boundary_faces())
      {
        const auto &x = mesh.get_nodes();
        const auto a = x[face.nodes[1]] - x[face.nodes[0]], b = x[face.nodes[2]] - x[face.nodes[0]];
        area += 0.5 * dealii::cross_product_3d(a, b).norm();
      }
      return mesh.exchange().sum(area);
    }

    std::array<double, 3>
    bounding_box(const Mesh &mesh)
    {
      std::array<double, 3> size;
      for (unsigned int c = 0; c < 3; ++c)
      {
        Range range;
        for (const dealii::Point<3> &node : mesh.get_nodes())
          range.add(node[c]);
        range   = range.over(mesh.exchange());
        size[c] = range.maximum - range.minimum;
      }
      return size;
    }
  } // namespace

  void
  Range::add(const double value)
  {
    minimum = std::min(minimum, value);
    maximum = std::max(maximum, value);
  }

  Range
  Range::over(const Exchange &exchange) const
  {
    return { min_of_all(exchange, minimum), exchange.max(maximum) };
  }

  double
  BodyMeasures::length() const
  {
    return *std::max_element(size.begin(), size.end());
  }

  BodyMeasures
  measure(const Body &body)
  {
    BodyMeasures          result{};
    std::array<double, 3> sums{}; // volume, mass, volume over Young's modulus
    for (unsigned int point = 0; point < body.fe_space.n_points(); ++point)
    {
      const unsigned int cell   = body.fe_space.cell_of(point);
      const double       volume = body.fe_space.volume(point);
      const auto        &lame   = body.material.elasticity(cell);
      result.young.add(body.material.youngs_modulus(cell));
      result.poisson.add(lame.lambda / (2. * (lame.lambda + lame.mu)));
      result.density.add(body.material.density(cell));
      sums[0] += volume;
      sums[1] += volume * body.material.density(cell);
      sums[2] += volume / body.material.youngs_modulus(cell);
    }
    const Exchange &exchange = body.exchange();
    exchange.sum(sums.data(), sums.size());
    result.young      = result.young.over(exchange);
    result.poisson    = result.poisson.over(exchange);
    result.density    = result.density.over(exchange);
    result.volume     = sums[0];
    result.mass       = sums[1];
    result.soft_young = sums[0] / sums[2];
    result.area       = boundary_area(body.mesh);
    result.size       = bounding_box(body.mesh);
    return result;
  }
} // namespace Exemplar
