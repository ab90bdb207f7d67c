// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_block_matrix_h
#define exemplar_block_matrix_h

#include <exemplar/algebra/outer_product_rows.h>

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace Exemplar
{
  /// Four numbers for each block of three rows: with the fourth, which means nothing, they fill a
  /// register. Behind the own blocks of a process are copies of those of others.
  using BlockVector = std::vector<float>;

  /// A sparse matrix of blocks of 3 x 3 numbers in single precision, and a sum of outer products that
  /// is not assembled. Each process has rows of it, and of its columns those that it owns and those of
  /// others that occur in its rows.
  class BlockMatrix
  {
  public:
    /// An entry that add_row() takes.
    struct Entry
    {
      int   column; ///< block, by local number
      int   place;  ///< three times the column in the block, and the row in it
      float value;
    };

    /// For vectors with this halo, of four numbers a block.
    explicit BlockMatrix(Halo halo);

    /// The next row of blocks; sorts the entries.
    void
    add_row(std::vector<Entry> &entries);

    /// The same of whole blocks, whose columns ascend: nine numbers each, by columns.
    void
    add_row(const std::vector<int> &columns, const std::vector<float> &blocks);

    /// After the last row.
    void
    finish();

    /// A summand with the same rows.
    void
    set_products(OuterProductRows<float> new_products)
    {
      products = std::move(new_products);
    }

    const OuterProductRows<float> &
    get_products() const
    {
      return products;
    }

    /// Blocks of rows.
    std::size_t
    n_rows() const
    {
      return start.size() - 1;
    }

    /// A vector by columns, of zeros.
    BlockVector
    zeros() const
    {
      return BlockVector(halo.n_own() + halo.n_others(), 0.F);
    }

    std::size_t
    n_blocks() const
    {
      return column.size();
    }

    /// On the diagonal, by columns; zero where there is none.
    std::array<float, 9>
    diagonal_block(std::size_t row) const;

    /// The numbers among all processes of the blocks here, of which the own begin with `first`.
    std::vector<std::size_t>
    block_numbers(std::size_t first) const;

    /// Call action(column, block) for the blocks of a row, without the products.
    template <typename Action>
    void
    for_each_block(const std::size_t row, const Action &action) const
    {
      for (int entry = start[row]; entry < start[row + 1]; ++entry)
        action(column[entry], &values[9 * static_cast<std::size_t>(entry)]);
    }

    /// result = A x; for all products x gets the values of others.
    void
    multiply(BlockVector &x, BlockVector &result) const;

    /// result += A x
    void
    multiply_and_add(BlockVector &x, BlockVector &result) const;

    /// result = b - A x
    void
    find_residual(const BlockVector &b, BlockVector &x, BlockVector &result) const;

    /// result = A^T x, the own blocks, without the products.
    void
    multiply_transposed(const BlockVector &x, BlockVector &result) const;

    /// With three by three numbers for each row in `inverse_diagonal`, D^-1,
    /// change = keep * change + take * D^-1 (b - A x), then x += change.
    void
    correct(const std::vector<float> &inverse_diagonal,
            const BlockVector        &b,
            float                     keep,
            float                     take,
            BlockVector              &x,
            BlockVector              &change) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    /// The owners' values to all who need them.
    void
    share(BlockVector &vector) const;

    /// Call action(row, product) for the rows of a product.
    template <typename Action>
    void
    for_each_product(BlockVector &x, const Action &action) const;

    Halo                    halo;
    std::vector<int>        start, column;
    std::vector<float>      values; ///< 9 a block, and some behind, as registers of four are read
    OuterProductRows<float> products;
  };

  /// Reads a row of a matrix of numbers, by its own number: columns by local number, and the values
  /// there. Returns how many they are, and makes the vectors longer where they are too short.
  using ReadRow
      = std::function<int(int row, std::vector<int> &columns, std::vector<double> &values)>;

  /// A copy of a matrix of numbers with `n_rows` rows of blocks in this process. Blocks of columns are
  /// numbered from `firsts` on, as first_numbers() tells; `columns` are the numbers among all
  /// processes of the columns of numbers here, the own ones first.
  BlockMatrix
  make_block_matrix(std::size_t                     n_rows,
                    const std::vector<std::size_t> &firsts,
                    const std::vector<std::size_t> &columns,
                    const ReadRow                  &read_row,
                    const Exchange                 &exchange);

  /// result = factor * D^-1 x, with three by three numbers for each block of x in D^-1.
  void
  multiply_by_blocks(const std::vector<float> &inverse_diagonal,
                     const BlockVector        &x,
                     float                     factor,
                     BlockVector              &result);
} // namespace Exemplar

#endif
