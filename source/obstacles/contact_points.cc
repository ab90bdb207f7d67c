// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/obstacles/contact_points.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace Exemplar
{
  namespace
  {
    using SpaceVector = dealii::Tensor<1, 3>;

    /// A displacement that takes a node below each of the planes with these unit normals by 1 or more.
    SpaceVector
    way_below(const std::vector<SpaceVector> &normals)
    {
      constexpr unsigned int max_rounds = 200;
      constexpr double       tolerance = 1e-9, longest = 10.; // of a needle's tip
      SpaceVector            way;
      bool                   is_below = false;
      for (unsigned int round = 0; round < max_rounds && !is_below; ++round)
      {
        is_below = true;
        for (const SpaceVector &normal : normals)
          if (const double above = 1. + normal * way; above > tolerance)
          {
            way -= above * normal;
            is_below = false;
          }
      }
      const double length = way.norm();
      return length > longest ? longest / length * way : way;
    }

    /// How the place of a point that moves with a cell changes with its vertices if it goes by `way` at rest: the vertices with
    /// the derivatives of the cell's linear shape functions along it, without those that are 0 but for rounding.
    ContactPoints::Parts
    changes_in_cell(const std::array<unsigned int, 4> &vertices,
                    const FESpace                     &fe_space,
                    const SpaceVector                 &way)
    {
      dealii::Tensor<2, 3> edges; // by row
      for (unsigned int k = 0; k < 3; ++k)
        edges[k] = fe_space.rest_position(vertices[k + 1]) - fe_space.rest_position(vertices[0]);
      // way = sum of shares times edges
      const SpaceVector    shares = way * dealii::invert(edges);
      ContactPoints::Parts result{ { vertices[0], -(shares[0] + shares[1] + shares[2]) } };
      for (unsigned int k = 0; k < 3; ++k)
        result.push_back({ vertices[k + 1], shares[k] });
      double greatest = 0.;
      for (const ContactPoints::Part &part : result)
        greatest = std::max(greatest, std::abs(part.weight));
      constexpr double rounding = 1e-10;
      result.erase(std::remove_if(result.begin(), result.end(),
                                  [&](const ContactPoints::Part &part)
                                  { return std::abs(part.weight) < rounding * greatest; }),
                   result.end());
      return result;
    }
  } // namespace

  const ContactPoints &
  ContactPoints::none()
  {
    static const ContactPoints nodes;
    return nodes;
  }

  dealii::Tensor<1, 3>
  ContactPoints::value(const Vector &field, const unsigned int node) const
  {
    dealii::Tensor<1, 3> sum;
    visit(node,
          [&](const unsigned int of, const double weight)
          {
            for (unsigned int c = 0; c < 3; ++c)
              sum[c] += weight * field[3 * of + c];
          });
    return sum;
  }

  void
  ContactPoints::add_to(Vector                     &field,
                        const unsigned int          node,
                        const dealii::Tensor<1, 3> &force) const
  {
    visit(node,
          [&](const unsigned int of, const double weight)
          {
            for (unsigned int c = 0; c < 3; ++c)
              field[3 * of + c] += weight * force[c];
          });
  }

  std::size_t
  ContactPoints::memory_consumption() const
  {
    constexpr std::size_t of_entry = 12 * sizeof(double);
    return shifted.size() * of_entry;
  }

  PointsBelow::PointsBelow(const ContactSurface            &surface,
                           const FESpace                   &fe_space,
                           const std::vector<unsigned int> &nodes)
  {
    std::map<unsigned int, std::vector<SpaceVector>> normals;
    for (const unsigned int node : nodes)
      normals[node];
    for (const ContactSurface::Triangle &triangle : surface.triangles)
    {
      const auto x
          = [&](const unsigned int k) { return fe_space.rest_position(triangle.nodes[k]); };
      const SpaceVector n = dealii::cross_product_3d(x(1) - x(0), x(2) - x(0));
      for (const unsigned int node : triangle.nodes)
        if (const auto found = normals.find(node); found != normals.end() && n.norm() > 0.)
          found->second.push_back(n / n.norm());
    }
    std::map<unsigned int, SpaceVector> ways;
    std::map<unsigned int, double>      least; // sum of the changes of the other nodes' weights
    for (const auto &[node, of_node] : normals)
    {
      ways[node]  = way_below(of_node);
      least[node] = std::numeric_limits<double>::infinity();
    }
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      const auto                        of_cell = fe_space.numbering().of_cell(cell);
      const std::array<unsigned int, 4> vertices{ { of_cell[0], of_cell[1], of_cell[2],
                                                    of_cell[3] } };
      for (const unsigned int node : of_cell)
      {
        const auto way = ways.find(node);
        if (way == ways.end())
          continue;
        ContactPoints::Parts others = changes_in_cell(vertices, fe_space, way->second);
        others.erase(std::remove_if(others.begin(), others.end(),
                                    [&](const ContactPoints::Part &part)
                                    { return part.node == node; }),
                     others.end());
        double sum = 0.;
        for (const ContactPoints::Part &part : others)
          sum += std::abs(part.weight);
        // the cell that is highest below the node has the least changes
        constexpr double clearly = 1. - 1e-9;
        if (sum < clearly * least[node])
        {
          least[node]   = sum;
          changes[node] = { std::move(others), 0.5 / sum };
        }
      }
    }
  }

  ContactPoints::Parts
  PointsBelow::point(const unsigned int node, const double depth) const
  {
    const Change        &change = changes.at(node);
    const double         by     = std::min(depth, change.most);
    double               own    = 1.;
    ContactPoints::Parts parts{ { node, own } };
    for (const ContactPoints::Part &part : change.others)
    {
      parts.push_back({ part.node, by * part.weight });
      own -= by * part.weight;
    }
    parts[0].weight = own;
    return parts;
  }
} // namespace Exemplar
