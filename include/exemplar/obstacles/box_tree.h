// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_box_tree_h
#define exemplar_box_tree_h

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace Exemplar
{
  /// A box along the axes; empty at first.
  struct AxisBox
  {
    dealii::Tensor<1, 3> low = constant(std::numeric_limits<double>::infinity()), high = -low;

    static dealii::Tensor<1, 3>
    constant(const double x)
    {
      dealii::Tensor<1, 3> result;
      for (unsigned int c = 0; c < 3; ++c)
        result[c] = x;
      return result;
    }

    void
    add(const dealii::Tensor<1, 3> &point)
    {
      for (unsigned int c = 0; c < 3; ++c)
      {
        low[c]  = std::min(low[c], point[c]);
        high[c] = std::max(high[c], point[c]);
      }
    }

    void
    add(const AxisBox &other)
    {
      add(other.low);
      add(other.high);
    }

    /// This box, wider by `range` to all sides.
    AxisBox
    widened(const double range) const
    {
      AxisBox result = *this;
      result.low -= constant(range);
      result.high += constant(range);
      return result;
    }

    bool
    meets(const AxisBox &other) const
    {
      for (unsigned int c = 0; c < 3; ++c)
        if (!(low[c] <= other.high[c] && other.low[c] <= high[c]))
          return false;
      return true;
    }
  };

  /// Finds which of many boxes meet another one. The boxes may move; the tree keeps its order.
  class BoxTree
  {
  public:
    BoxTree() = default;

    explicit BoxTree(const std::vector<AxisBox> &boxes);

    /// Take new boxes of the same number.
    void
    move(const std::vector<AxisBox> &boxes);

    /// The box around all.
    const AxisBox &
    around() const
    {
      return nodes.front().box;
    }

    bool
    empty() const
    {
      return nodes.empty();
    }

    /// Call visit(i) for each box i that meets `box`, in an order that the tree decides.
    template <typename Visit>
    void
    visit(const AxisBox &box, const Visit &visit) const
    {
      if (!nodes.empty())
        visit_node(0, box, visit);
    }

    /// Call visit(i, j) for each box i that meets the box j of another tree, or for each two of this one, once; in an order that the
    /// trees decide.
    template <typename Visit>
    void
    visit_pairs(const BoxTree &other, const Visit &visit) const
    {
      if (!nodes.empty() && !other.nodes.empty())
        visit_nodes(0, other, 0, visit);
    }

  private:
    /// Of a half of the items of the node above.
    struct Node
    {
      AxisBox      box;
      unsigned int begin, end; ///< of `items`
      unsigned int right = 0;  ///< the second node below, the first follows this one; 0: none
    };

    unsigned int
    make(const std::vector<AxisBox> &boxes, unsigned int begin, unsigned int end);

    template <typename Visit>
    void
    visit_node(const unsigned int n, const AxisBox &box, const Visit &visit) const
    {
      const Node &node = nodes[n];
      if (!node.box.meets(box))
        return;
      if (node.right != 0)
      {
        visit_node(n + 1, box, visit);
        visit_node(node.right, box, visit);
        return;
      }
      for (unsigned int i = node.begin; i < node.end; ++i)
        if (of_items[i].meets(box))
          visit(items[i]);
    }

    template <typename Visit>
    void
    visit_nodes(const unsigned int n,
                const BoxTree     &other,
                const unsigned int m,
                const Visit       &visit) const
    {
      const Node &node = nodes[n], &at_other = other.nodes[m];
      const bool  is_same = this == &other && n == m;
      if (!node.box.meets(at_other.box))
        return;
      if (node.right == 0 && at_other.right == 0)
      {
        for (unsigned int i = node.begin; i < node.end; ++i)
          for (unsigned int j = is_same ? i + 1 : at_other.begin; j < at_other.end; ++j)
            if (of_items[i].meets(other.of_items[j]))
              visit(items[i], other.items[j]);
      }
      else if (is_same)
      {
        visit_nodes(n + 1, other, n + 1, visit);
        visit_nodes(node.right, other, node.right, visit);
        visit_nodes(n + 1, other, node.right, visit);
      }
      else if (at_other.right == 0
               || (node.right != 0 && node.end - node.begin > at_other.end - at_other.begin))
      {
        visit_nodes(n + 1, other, m, visit);
        visit_nodes(node.right, other, m, visit);
      }
      else
      {
        visit_nodes(n, other, m + 1, visit);
        visit_nodes(n, other, at_other.right, visit);
      }
    }

    std::vector<Node>         nodes;
    std::vector<unsigned int> items;    ///< in the order of the tree
    std::vector<AxisBox>      of_items; ///< their boxes
  };
} // namespace Exemplar

#endif
