// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_element_h
#define exemplar_element_h

#include <cstddef>
#include <iterator>
#include <type_traits>

// The finite elements: the one place where they differ. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// Elements on tetrahedra, in the order of element_traits.
  enum class Element
  {
    P1, ///< linear: 4 nodes, one quadrature point
    P2  ///< quadratic: 10 nodes, four quadrature points
  };

  /// Fractions of an amount in a cell, or on a face, at a vertex and at the middle of an edge.
  struct NodeShares
  {
    double vertex, edge; ///< relative shares
    double all;          ///< sum of the shares of all nodes

    double
    of_vertex(const double amount) const
    {
      return vertex * amount / all;
    }

    double
    of_edge(const double amount) const
    {
      return edge * amount / all;
    }
  };

  /// Whether an amount is distributed by integrals of shape functions (for quadratic ones negative
  /// at the vertices of a cell), or by those of their squares, divided by the sum of these.
  enum class ShareRule
  {
    consistent,
    lumped
  };

  /// Shares by each ShareRule.
  struct SharesByRule
  {
    NodeShares consistent, lumped;

    constexpr const NodeShares &
    by(const ShareRule rule) const
    {
      return rule == ShareRule::consistent ? consistent : lumped;
    }
  };

  /// Properties of an element, beside the quadratures of FESpace.
  struct ElementTraits
  {
    const char  *name;   ///< value of Model/Element in scenes
    const char  *cells;  ///< its cells in messages
    int          degree; ///< degree of the shape functions
    int          nodes_per_cell;
    int          points_per_cell; ///< quadrature points
    SharesByRule in_cell, on_face;

    /// Whether cells lock near Poisson's ratio 1/2, so that patches are stars of them. In other
    /// elements each cell is a patch.
    bool locks;

    unsigned char vtk_type; ///< VTK_TETRA or VTK_QUADRATIC_TETRA

    /// Whether there are nodes in the middles of the edges, behind the vertices.
    constexpr bool
    has_edge_nodes() const
    {
      return degree > 1;
    }
  };

  constexpr ElementTraits element_traits[] = { { "P1",
                                                 "cells",
                                                 1,
                                                 4,
                                                 1,
                                                 { { 1., 0., 4. }, { 1., 0., 4. } },
                                                 { { 1., 0., 3. }, { 1., 0., 3. } },
                                                 true,
                                                 10 },
                                               { "P2",
                                                 "quadratic cells",
                                                 2,
                                                 10,
                                                 4,
                                                 { { -1., 4., 20. }, { 3., 16., 108. } },
                                                 { { 0., 1., 3. }, { 3., 16., 57. } },
                                                 false,
                                                 24 } };

  constexpr const ElementTraits &
  traits_of(const Element element)
  {
    return element_traits[static_cast<std::size_t>(element)];
  }

  constexpr int
  nodes_per_cell(const Element element)
  {
    return traits_of(element).nodes_per_cell;
  }

  constexpr int
  points_per_cell(const Element element)
  {
    return traits_of(element).points_per_cell;
  }

  /// Whether there is an element of the next degree.
  constexpr bool
  has_richer(const Element element)
  {
    return static_cast<std::size_t>(element) + 1 < std::size(element_traits);
  }

  /// The element of the next degree. Requires has_richer().
  constexpr Element
  richer(const Element element)
  {
    return static_cast<Element>(static_cast<std::size_t>(element) + 1);
  }

  /// An element as a type, for overloads of templates.
  template <Element element>
  using ElementConstant = std::integral_constant<Element, element>;

  /// Call `function` with the ElementConstant of an element.
  template <std::size_t i = 0, typename Function>
  auto
  with_element(const Element element, const Function &function)
  {
    if constexpr (i + 1 < std::size(element_traits))
      if (element != static_cast<Element>(i))
        return with_element<i + 1>(element, function);
    return function(ElementConstant<static_cast<Element>(i)>());
  }
} // namespace Exemplar

#endif
