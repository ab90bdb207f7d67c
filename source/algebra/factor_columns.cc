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
        supernode_of(row_of.size()), vector(factor->get_structure().n_of_vectors(), 0.F)
  {
    const FactorStructure &structure = factor->get_structure();
    for (int i = 0; i < structure.n(); ++i)
      row_of[structure.permutation[i]] = i;
    for (int s = 0; s < structure.n_supernodes(); ++s)
      std::fill(supernode_of.begin() + structure.first_column[s],
                supernode_of.begin() + structure.first_column[s + 1], s);
  }

  std::size_t
  FactorColumns::add(const unsigned int unknown)
  {
    const FactorStructure &structure = factor->get_structure();
    const int              row = row_of[unknown], first = supernode_of[row];
    Column                 column;
    vector[structure.vector_begin(first) + row - structure.first_column[first]] = 1.F;
    for (int s = first; s != -1; s = structure.parent[s])
    {
      column.supernodes.push_back(s); // whose other children have vectors of zeros
      factor->forward(s, { vector.data(), vector.size(), 1 });
    }
    std::reverse(column.supernodes.begin(), column.supernodes.end());
    for (const int s : column.supernodes)
    {
      const auto begin = vector.begin() + structure.vector_begin(s);
      column.values.insert(column.values.end(), begin, begin + structure.n_columns(s));
      std::fill_n(begin, structure.n_rows(s) + slab_rows, 0.F);
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
    std::size_t bytes
        = sizeof(int) * (row_of.size() + supernode_of.size()) + sizeof(float) * vector.size();
    for (const Column &column : columns)
      bytes
          += sizeof(int) * column.supernodes.capacity() + sizeof(float) * column.values.capacity();
    return bytes;
  }
} // namespace Exemplar
