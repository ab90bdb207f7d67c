// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_contact_points_h
#define exemplar_contact_points_h

#include <exemplar/algebra/vector.h>
#include <exemplar/obstacles/contact_surface.h>

#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// The points that contact between pieces has in place of the nodes of the body's surface. Where pieces are drawn touching, the points
  /// are below the surface: combinations of nodes of one cell with fixed weights whose sum is 1. So they turn with the body, and
  /// forces on them have the sum and the moment of their parts on the nodes. All other points are the nodes themselves.
  class ContactPoints
  {
  public:
    /// A node that a point is made of, and its weight.
    struct Part
    {
      unsigned int node;
      double       weight;
    };

    using Parts = std::vector<Part>;

    /// The nodes themselves.
    static const ContactPoints &
    none();

    bool
    empty() const
    {
      return shifted.empty();
    }

    /// Let the point of a node be a combination of at most Gap::max_nodes / 4 nodes.
    void
    set(const unsigned int node, Parts parts)
    {
      shifted[node] = std::move(parts);
    }

    void
    clear()
    {
      shifted.clear();
    }

    /// Call visit(node, weight) for the parts of the point of a node.
    template <typename Visit>
    void
    visit(const unsigned int node, const Visit &visit) const
    {
      const auto found = shifted.empty() ? shifted.end() : shifted.find(node);
      if (found == shifted.end())
        visit(node, 1.);
      else
        for (const Part &part : found->second)
          visit(part.node, part.weight);
    }

    /// What a field by degree of freedom has at the point of a node.
    dealii::Tensor<1, 3>
    value(const Vector &field, unsigned int node) const;

    /// Add to a field of forces by degree of freedom what a force on the point of a node is on the nodes.
    void
    add_to(Vector &field, unsigned int node, const dealii::Tensor<1, 3> &force) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    std::unordered_map<unsigned int, Parts> shifted;
  };

  /// Points below nodes of a surface, by a depth across all of the triangles around each.
  class PointsBelow
  {
  public:
    /// All must outlive it, and the nodes be of the surface.
    PointsBelow(const ContactSurface            &surface,
                const FESpace                   &fe_space,
                const std::vector<unsigned int> &nodes);

    /// The point below a node by this depth [m] at rest, but within the cell that it is made of.
    ContactPoints::Parts
    point(unsigned int node, double depth) const;

  private:
    /// Change of the weights by the depth [1/m], and the node's own.
    struct Change
    {
      ContactPoints::Parts others;
      double               most; ///< depth [m] at which the point reaches the middle of the cell
    };

    std::map<unsigned int, Change> changes;
  };
} // namespace Exemplar

#endif
