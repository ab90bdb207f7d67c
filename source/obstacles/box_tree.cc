// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/obstacles/box_tree.h>

#include <numeric>

namespace Exemplar
{
  namespace
  {
    constexpr unsigned int items_of_leaf = 4;
  } // namespace

  BoxTree::BoxTree(const std::vector<AxisBox> &boxes) : items(boxes.size())
  {
    std::iota(items.begin(), items.end(), 0U);
    if (!boxes.empty())
      make(boxes, 0, static_cast<unsigned int>(boxes.size()));
    move(boxes);
  }

  unsigned int
  BoxTree::make(const std::vector<AxisBox> &boxes, const unsigned int begin, const unsigned int end)
  {
    AxisBox middles; // twice the middles
    for (unsigned int i = begin; i < end; ++i)
      middles.add(boxes[items[i]].low + boxes[items[i]].high);
    const auto n = static_cast<unsigned int>(nodes.size());
    nodes.push_back({ {}, begin, end });
    if (end - begin <= items_of_leaf)
      return n;
    const dealii::Tensor<1, 3> extent = middles.high - middles.low;
    unsigned int               axis   = 0;
    for (unsigned int c = 1; c < 3; ++c)
      if (extent[c] > extent[axis])
        axis = c;
    const unsigned int middle = begin + (end - begin) / 2;
    const auto         key    = [&](const unsigned int item)
    { return std::pair(boxes[item].low[axis] + boxes[item].high[axis], item); };
    std::nth_element(items.begin() + begin, items.begin() + middle, items.begin() + end,
                     [&](const unsigned int i, const unsigned int j) { return key(i) < key(j); });
    make(boxes, begin, middle);
    nodes[n].right = make(boxes, middle, end);
    return n;
  }

  void
  BoxTree::move(const std::vector<AxisBox> &boxes)
  {
    of_items.clear();
    for (const unsigned int item : items)
      of_items.push_back(boxes[item]);
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) // nodes below come after
    {
      node->box = {};
      if (node->right == 0)
        for (unsigned int i = node->begin; i < node->end; ++i)
          node->box.add(of_items[i]);
      else
      {
        node->box.add(nodes[nodes.size() - (node - nodes.rbegin())].box);
        node->box.add(nodes[node->right].box);
      }
    }
  }
} // namespace Exemplar
