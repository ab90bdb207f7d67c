// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_outer_product_rows_h
#define exemplar_outer_product_rows_h

#include <exemplar/algebra/halo.h>
#include <exemplar/algebra/outer_products.h>

#include <map>
#include <type_traits>
#include <vector>

namespace Exemplar
{
  /// Padding of arrays of three numbers a block that are read by fours.
  constexpr std::size_t read_beyond = 4;

  /// A process' rows of a sum of outer products f_k u_k u_k^T, a matrix that is never assembled.
  /// Each product with a non-zero row here is stored as a whole, whichever process has made it, so
  /// that a matrix-vector product updates ghosts once, as that of a sparse matrix does. A single
  /// process sums in the order of the products.
  template <typename Number>
  class OuterProductRows
  {
  public:
    /// Vector entries for each block row, of which the first three count.
    static constexpr unsigned int n_each = std::is_same<Number, float>::value ? 4 : 3;

    /// An empty sum.
    OuterProductRows() = default;

    /// The sum of the products that all processes have made; their blocks are global numbers from
    /// `firsts` on, see first_numbers(). This and the multiplications are collective.
    OuterProductRows(const OuterProducts            &made_here,
                     const std::vector<std::size_t> &firsts,
                     const Exchange                 &exchange);

    /// Number of products known to this process, its own first.
    std::size_t
    n_products() const
    {
      return factors.size();
    }

    /// Total number of blocks of all products.
    std::size_t
    n_blocks() const
    {
      return blocks.size();
    }

    Number
    factor(const std::size_t product) const
    {
      return factors[product];
    }

    /// Coefficient f_k u_k.x of each product, where x has the owned rows.
    std::vector<Number>
    coefficients(const Number *x) const;

    /// Call action(product, u) for the products with a non-zero block in an owned block row; u
    /// points to its three numbers, and a fourth behind them may be read.
    template <typename Action>
    void
    for_each_in_row(const std::size_t row, const Action &action) const
    {
      if (row_start.empty())
        return;
      for (int k = row_start[row]; k < row_start[row + 1]; ++k)
        action(product_of[k], &values[3 * static_cast<std::size_t>(entry_of[k])]);
    }

    /// Call action(block, u) for all blocks of a product, by local number: owned ones, then
    /// other_blocks().
    template <typename Action>
    void
    for_each_block(const std::size_t product, const Action &action) const
    {
      for (int entry = start[product]; entry < start[product + 1]; ++entry)
        action(blocks[entry], &values[3 * static_cast<std::size_t>(entry)]);
    }

    /// Global numbers of the ghost blocks, ascending.
    const std::vector<std::size_t> &
    other_blocks() const
    {
      return others;
    }

    /// Complete partial sums, which each process has computed for the n_products() from its owned
    /// rows, in the block numbering of another matrix: returns the full products that this process
    /// has made.
    OuterProducts
    complete(const OuterProducts &parts, const Exchange &exchange) const;

    /// Memory in bytes.
    std::size_t
    memory_consumption() const;

  private:
    /// Send products to the processes that own some of their rows; returns the received ones.
    std::map<unsigned int, OuterProducts>
    share_products(const OuterProducts            &made_here,
                   const std::vector<std::size_t> &firsts,
                   const Exchange                 &exchange);

    void
    append(const OuterProducts &products);

    void
    number_blocks(std::size_t first, std::size_t n_own);

    void
    find_rows(std::size_t n_own);

    Halo                     halo;
    std::vector<Number>      factors;
    std::vector<int>         start = { 0 }; ///< begin of each product's blocks, and the end
    std::vector<int>         blocks;        ///< local number of each block
    std::vector<Number>      values;        ///< three a block, padded
    std::vector<int>         row_start, product_of, entry_of;
    std::vector<std::size_t> others;
    /// Products made here that each other process knows, and how many of each other process'
    /// products are known here.
    std::map<unsigned int, std::vector<std::size_t>> known_to;
    std::map<unsigned int, std::size_t>              n_known_of;
  };
} // namespace Exemplar

#endif
