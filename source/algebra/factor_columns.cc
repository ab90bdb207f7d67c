// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/factor_columns.h>
#include <exemplar/algebra/front_kernels.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// The sum of products of the first n numbers: in double precision, and several sums, so that additions need not wait
    /// for each other.
    double
    product(const float *a, const float *b, const std::size_t n)
    {
      constexpr std::size_t n_sums      = 8;
      double                sum[n_sums] = {};
      std::size_t           i           = 0;
      for (; i + n_sums <= n; i += n_sums)
        for (std::size_t k = 0; k < n_sums; ++k)
          sum[k] += static_cast<double>(a[i + k]) * static_cast<double>(b[i + k]);
      for (; i < n; ++i)
        sum[0] += static_cast<double>(a[i]) * static_cast<double>(b[i]);
      return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
    }
  } // namespace

  FactorColumns::FactorColumns(std::shared_ptr<const MultifrontalFactor<float>> new_factor)
      : factor(std::move(new_factor)), row_of(factor->get_structure().n()),
        supernode_of(row_of.size()), subtree_of(factor->get_structure().n_supernodes(), -1),
        vector(row_of.size() + factor->get_structure().tail.size()),
        block(factor->get_structure().max_rows + FrontKernels<float>::max_lanes)
  {
    const FactorStructure &structure = factor->get_structure();
    for (int i = 0; i < structure.n(); ++i)
      row_of[structure.permutation[i]] = i;
    for (int s = 0; s < structure.n_supernodes(); ++s)
      std::fill(supernode_of.begin() + structure.first_column[s],
                supernode_of.begin() + structure.first_column[s + 1], s);
    for (std::size_t i = 0; i < structure.subtrees.size(); ++i)
      std::fill(subtree_of.begin() + structure.subtrees[i].begin,
                subtree_of.begin() + structure.subtrees[i].end, static_cast<int>(i));
  }

  std::size_t
  FactorColumns::add(const unsigned int unknown)
  {
    const FactorStructure &structure = factor->get_structure();
    const int              row       = row_of[unknown];
    Column                 column;
    vector[row] = 1.;
    for (int s = supernode_of[row]; s != -1; s = structure.parent[s])
    {
      column.supernodes.push_back(s);
      factor->forward(s, vector.data(), block.data());
      const int parent = structure.parent[s];
      if (subtree_of[s] == -1 || (parent != -1 && subtree_of[parent] == subtree_of[s]))
        continue;
      // the way leaves a subtree, whose copies of the rows above it join these
      const FactorStructure::Subtree &subtree = structure.subtrees[subtree_of[s]];
      for (int i = subtree.begin_of_tail; i < subtree.end_of_tail; ++i)
      {
        float &copy = vector[structure.n() + i];
        vector[structure.tail[i]] += copy;
        copy = 0.;
      }
    }
    std::reverse(column.supernodes.begin(), column.supernodes.end());
    for (const int s : column.supernodes)
    {
      const auto begin = vector.begin() + structure.first_column[s];
      const auto end   = vector.begin() + structure.first_column[s + 1];
      column.values.insert(column.values.end(), begin, end);
      std::fill(begin, end, 0.F);
    }
    columns.push_back(std::move(column));
    return columns.size() - 1;
  }

  double
  FactorColumns::entry(const std::size_t row, const std::size_t column) const
  {
    const FactorStructure &structure = factor->get_structure();
    const Column          &a = columns[row], &b = columns[column];
    const std::size_t      n_most = std::min(a.supernodes.size(), b.supernodes.size());
    std::size_t            n      = 0;
    for (std::size_t i = 0; i < n_most && a.supernodes[i] == b.supernodes[i]; ++i)
      n += structure.n_columns(a.supernodes[i]);
    return factor->get_scale() * product(a.values.data(), b.values.data(), n);
  }

  std::size_t
  FactorColumns::memory_consumption() const
  {
    std::size_t bytes = sizeof(int) * (row_of.size() + supernode_of.size() + subtree_of.size())
                        + sizeof(float) * (vector.size() + block.size());
    for (const Column &column : columns)
      bytes
          += sizeof(int) * column.supernodes.capacity() + sizeof(float) * column.values.capacity();
    return bytes;
  }
} // namespace Exemplar
