// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/multigrid_hierarchy.h>

#include <algorithm>
#include <iterator>

namespace Exemplar
{
  namespace
  {
    /// A sparse accumulator: n numbers (9 or 3) for each of few of very many blocks.
    template <unsigned int n>
    class FewBlocks
    {
    public:
      explicit FewBlocks(const std::size_t n_blocks) : place_of(n_blocks, none) {}

      /// The numbers of a block, zero at first.
      float *
      operator[](const std::size_t block)
      {
        if (place_of[block] == none)
        {
          place_of[block] = static_cast<int>(blocks.size());
          blocks.push_back(static_cast<int>(block));
          values.resize(values.size() + n, 0.F);
        }
        return &values[n * place_of[block]];
      }

      /// Empty it; calls action(blocks, values) before, with ascending blocks.
      template <typename Action>
      void
      take(const Action &action)
      {
        std::vector<int> ascending = blocks;
        std::sort(ascending.begin(), ascending.end());
        std::vector<float> sorted;
        for (const int block : ascending)
          sorted.insert(sorted.end(), &values[n * place_of[block]],
                        &values[n * place_of[block]] + n);
        for (const int block : blocks)
          place_of[block] = none;
        blocks.clear();
        values.clear();
        action(ascending, sorted);
      }

    private:
      static constexpr int none = -1;

      std::vector<int>   place_of, blocks;
      std::vector<float> values;
    };

    /// Galerkin coarsening: P^T u of each product, by global numbers of the columns of P.
    OuterProducts
    coarsen(const OuterProductRows<float>  &products,
            const BlockMatrix              &prolongation,
            const std::vector<std::size_t> &numbers,
            const Exchange                 &exchange)
    {
      OuterProducts own_parts;
      FewBlocks<3>  sum(numbers.size());
      for (std::size_t product = 0; product < products.n_products(); ++product)
      {
        products.for_each_block(product,
                                [&](const std::size_t block, const float *u)
                                {
                                  if (block >= prolongation.n_rows())
                                    return;
                                  prolongation.for_each_block(
                                      block,
                                      [&](const std::size_t coarse, const float *P)
                                      {
                                        float *image = sum[coarse];
                                        for (int j = 0; j < 3; ++j)
                                          for (int i = 0; i < 3; ++i)
                                            image[j] += P[3 * j + i] * u[i];
                                      });
                                });
        sum.take(
            [&](const std::vector<int> &blocks, const std::vector<float> &values)
            {
              std::vector<unsigned int> global;
              for (const int block : blocks)
                global.push_back(numbers[block]);
              own_parts.add(products.factor(product), global, { values.begin(), values.end() });
            });
      }
      return products.complete(own_parts, exchange);
    }

    /// Local numbers of blocks, from global ones, in a matrix with the ghost blocks `others`.
    std::vector<int>
    local_numbers(const std::vector<std::size_t> &numbers,
                  const std::size_t               first,
                  const std::size_t               n_own,
                  const std::vector<std::size_t> &others)
    {
      std::vector<int> local;
      for (const std::size_t number : numbers)
        local.push_back(static_cast<int>(
            number - first < n_own
                ? number - first
                : n_own
                      + (std::lower_bound(others.begin(), others.end(), number) - others.begin())));
      return local;
    }

    /// The assembled sum of a matrix and outer products.
    BlockMatrix
    sum(const BlockMatrix              &matrix,
        const OuterProductRows<float>  &products,
        const std::vector<std::size_t> &firsts,
        const Exchange                 &exchange)
    {
      const std::size_t              first = firsts[exchange.process()], n_own = matrix.n_rows();
      const std::vector<std::size_t> numbers = matrix.block_numbers(first);
      std::vector<std::size_t>       others;
      std::set_union(numbers.begin() + n_own, numbers.end(), products.other_blocks().begin(),
                     products.other_blocks().end(), std::back_inserter(others));
      const std::vector<int> in_sum = local_numbers(numbers, first, n_own, others),
                             beyond = local_numbers(products.other_blocks(), first, n_own, others);
      BlockMatrix  result(Halo(firsts, others, 4, exchange));
      FewBlocks<9> row(n_own + others.size());
      for (std::size_t i = 0; i < n_own; ++i)
      {
        matrix.for_each_block(i, [&](const std::size_t column, const float *block)
                              { std::copy_n(block, 9, row[in_sum[column]]); });
        products.for_each_in_row(
            i,
            [&](const int product, const float *u)
            {
              const float scaled[3]
                  = { products.factor(product) * u[0], products.factor(product) * u[1],
                      products.factor(product) * u[2] };
              products.for_each_block(product,
                                      [&](const std::size_t column, const float *v)
                                      {
                                        float *to
                                            = row[column < n_own ? column : beyond[column - n_own]];
                                        for (int k = 0; k < 9; ++k)
                                          to[k] += scaled[k % 3] * v[k / 3];
                                      });
            });
        row.take([&](const std::vector<int> &columns, const std::vector<float> &blocks)
                 { result.add_row(columns, blocks); });
      }
      result.finish();
      return result;
    }
  } // namespace

  void
  add_products(const OuterProducts         &products,
               std::vector<MultigridLevel> &levels,
               const Exchange              &exchange)
  {
    if (!exchange.any(products.size() > 0))
      return;
    auto                    firsts = first_numbers(levels[0].matrix.n_rows(), exchange);
    OuterProductRows<float> rows(products, firsts, exchange);
    for (std::size_t level = 0; level + 1 < levels.size(); ++level)
    {
      const BlockMatrix &prolongation = levels[level].prolongation;
      BlockMatrix       &coarser      = levels[level + 1].matrix;
      firsts                          = first_numbers(coarser.n_rows(), exchange);
      const OuterProducts coarse      = coarsen(
               rows, prolongation, prolongation.block_numbers(firsts[exchange.process()]), exchange);
      if (level == 0)
        levels[0].matrix.set_products(std::move(rows));
      rows    = OuterProductRows<float>(coarse, firsts, exchange);
      coarser = sum(coarser, rows, firsts, exchange);
    }
    if (levels.size() == 1)
      levels[0].matrix.set_products(std::move(rows));
  }
} // namespace Exemplar
