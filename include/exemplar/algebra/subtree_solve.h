// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_subtree_solve_h
#define exemplar_subtree_solve_h

#include <exemplar/algebra/factor_structure.h>
#include <exemplar/base/loop_parts.h>

#include <algorithm>
#include <vector>

namespace Exemplar
{
  /// Workspace and driver of triangular solves: columns in the order of the factor, each with a
  /// tail as described in FactorStructure, and a block for each thread.
  template <typename Number>
  class SubtreeSolve
  {
  public:
    /// `n_threads` >= 1.
    explicit SubtreeSolve(const unsigned int n_threads) : blocks(n_threads) {}

    /// Overwrite columns of n entries, in the order of A: call forward(begin, end, columns, stride,
    /// block) and then backward() for all supernodes, in the order of the elimination tree. Columns
    /// are `stride` apart. The result does not depend on which thread does a subtree.
    template <typename Forward, typename Backward>
    void
    solve(const FactorStructure &structure,
          std::vector<Number>   &columns,
          const Forward         &forward,
          const Backward        &backward)
    {
      const std::size_t n = structure.n(), stride = n + structure.tail.size();
      const std::size_t n_columns = n == 0 ? 0 : columns.size() / n;
      permuted.resize(n_columns * stride);
      for (std::size_t k = 0; k < n_columns; ++k)
      {
        for (std::size_t i = 0; i < n; ++i)
          permuted[k * stride + i] = columns[k * n + structure.permutation[i]];
        std::fill_n(permuted.begin() + k * stride + n, structure.tail.size(), Number(0.));
      }
      in_subtrees(structure, forward, stride);
      for (std::size_t k = 0; k < n_columns; ++k)
        for (std::size_t i = 0; i < structure.tail.size(); ++i)
          permuted[k * stride + structure.tail[i]] += permuted[k * stride + n + i];
      for (const int s : structure.top)
        forward(s, s + 1, permuted.data(), stride, blocks[0]);
      for (auto s = structure.top.rbegin(); s != structure.top.rend(); ++s)
        backward(*s, *s + 1, permuted.data(), stride, blocks[0]);
      for (std::size_t k = 0; k < n_columns; ++k)
        for (std::size_t i = 0; i < structure.tail.size(); ++i)
          permuted[k * stride + n + i] = permuted[k * stride + structure.tail[i]];
      in_subtrees(structure, backward, stride);
      for (std::size_t k = 0; k < n_columns; ++k)
        for (std::size_t i = 0; i < n; ++i)
          columns[k * n + structure.permutation[i]] = permuted[k * stride + i];
    }

    /// Memory in bytes.
    std::size_t
    memory_consumption() const
    {
      std::size_t numbers = permuted.capacity();
      for (const std::vector<Number> &block : blocks)
        numbers += block.capacity();
      return sizeof(Number) * numbers;
    }

  private:
    /// Least size of a factor for threads: starting one takes as long as solving with so many
    /// numbers.
    static constexpr std::size_t min_values = 400000;

    template <typename Kernel>
    void
    in_subtrees(const FactorStructure &structure, const Kernel &kernel, const std::size_t stride)
    {
      const int n         = static_cast<int>(structure.subtrees.size());
      const int n_at_once = structure.n_values() < min_values ? 1 : static_cast<int>(blocks.size());
      for_each_task(n, n_at_once,
                    [&](const int i, const int thread)
                    {
                      kernel(structure.subtrees[i].begin, structure.subtrees[i].end,
                             permuted.data(), stride, blocks[thread]);
                    });
    }

    std::vector<Number>              permuted;
    std::vector<std::vector<Number>> blocks; ///< one a thread
  };
} // namespace Exemplar

#endif
