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
  /// Room behind numbers by threes that are read by fours.
  constexpr std::size_t read_beyond = 4;

  /// The rows that a process has of a sum of outer products, as a matrix that is never assembled:
  /// the whole of each product with a number in one of its rows, whoever has made it. So a product
  /// with a vector takes the values of others once, as that of a sparse matrix does. In one process
  /// sums are made in the order of the products.
  template <typename Number>
  class OuterProductRows
  {
  public:
    /// Numbers of a vector for each block of rows, of which the first three count.
    static constexpr unsigned int n_each = std::is_same<Number, float>::value ? 4 : 3;

    /// None.
    OuterProductRows() = default;

    /// Of the products that each process has made, blocks being numbered from `firsts` on, as
    /// first_numbers() tells. All processes must call this and the functions that multiply.
    OuterProductRows(const OuterProducts            &made_here,
                     const std::vector<std::size_t> &firsts,
                     const Exchange                 &exchange);

    /// That are known here, those that others have made last.
    std::size_t
    n_products() const
    {
      return factors.size();
    }

    /// Blocks of all products.
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

    /// f_k u_k.x of each product; x has the own rows.
    std::vector<Number>
    coefficients(const Number *x) const;

    /// Call action(product, u) for the products with numbers in a block of own rows: there they are
    /// the three at u, behind which a fourth may be read.
    template <typename Action>
    void
    for_each_in_row(const std::size_t row, const Action &action) const
    {
      if (row_start.empty())
        return;
      for (int k = row_start[row]; k < row_start[row + 1]; ++k)
        action(product_of[k], &values[3 * static_cast<std::size_t>(entry_of[k])]);
    }

    /// Call action(block, u) for all blocks of a product, by local number: the own ones, then those
    /// of other_blocks().
    template <typename Action>
    void
    for_each_block(const std::size_t product, const Action &action) const
    {
      for (int entry = start[product]; entry < start[product + 1]; ++entry)
        action(blocks[entry], &values[3 * static_cast<std::size_t>(entry)]);
    }

    /// Numbers among all processes, ascending.
    const std::vector<std::size_t> &
    other_blocks() const
    {
      return others;
    }

    /// Of sums that each process has made of its own rows of the n_products(), with the blocks of
    /// another numbering: the products that this process has made, complete.
    OuterProducts
    complete(const OuterProducts &parts, const Exchange &exchange) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    /// Give others the products with numbers in their rows; returns theirs.
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
    std::vector<int>         start = { 0 }; ///< of each product's blocks
    std::vector<int>         blocks;        ///< by local number
    std::vector<Number>      values;        ///< three a block, and some behind
    std::vector<int>         row_start, product_of, entry_of;
    std::vector<std::size_t> others;
    /// Products made here that other processes know, and how many are known of each of them.
    std::map<unsigned int, std::vector<std::size_t>> known_to;
    std::map<unsigned int, std::size_t>              n_known_of;
  };
} // namespace Exemplar

#endif
