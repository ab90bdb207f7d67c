// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_outer_products_h
#define exemplar_outer_products_h

#include <cstddef>
#include <vector>

namespace Exemplar
{
  /// A sum of scaled outer products f_k u_k u_k^T, where u_k has three numbers for each of a few
  /// blocks, in any order: nodes, or block rows of a matrix. Kept apart because it has low rank,
  /// but assembled would couple all blocks of a product with each other.
  struct OuterProducts
  {
    std::vector<double>       factors; ///< f_k
    std::vector<std::size_t>  ends;    ///< end of each product's blocks
    std::vector<unsigned int> blocks;
    std::vector<double>       values; ///< entries of u_k, three a block

    std::size_t
    size() const
    {
      return factors.size();
    }

    std::size_t
    begin(const std::size_t product) const
    {
      return product == 0 ? 0 : ends[product - 1];
    }

    /// Append a product f u u^T; u has three numbers for each of `its_blocks`.
    void
    add(const double                     factor,
        const std::vector<unsigned int> &its_blocks,
        const std::vector<double>       &its_values)
    {
      factors.push_back(factor);
      blocks.insert(blocks.end(), its_blocks.begin(), its_blocks.end());
      values.insert(values.end(), its_values.begin(), its_values.end());
      ends.push_back(blocks.size());
    }

    /// Add another sum.
    void
    add(const OuterProducts &other)
    {
      for (const std::size_t end : other.ends)
        ends.push_back(blocks.size() + end);
      factors.insert(factors.end(), other.factors.begin(), other.factors.end());
      blocks.insert(blocks.end(), other.blocks.begin(), other.blocks.end());
      values.insert(values.end(), other.values.begin(), other.values.end());
    }

    void
    scale(const double factor)
    {
      for (double &own : factors)
        own *= factor;
    }

    /// Remove all products; keeps the memory.
    void
    clear()
    {
      factors.clear();
      ends.clear();
      blocks.clear();
      values.clear();
    }

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &factors &ends &blocks &values;
    }
  };
} // namespace Exemplar

#endif
