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
  /// A vector with four numbers for each block of three rows: the fourth is padding, so that a
  /// block fills a register. Owned blocks come first, then ghosts, copies of blocks that other
  /// processes own.
  using BlockVector = std::vector<float>;

  /// A sparse matrix of 3 x 3 blocks in single precision, plus a sum of outer products that is not
  /// assembled. Rows are distributed over the processes; columns are the owned ones, then ghosts.
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

    /// A matrix without rows, whose columns are those of `halo`, with four numbers a block.
    explicit BlockMatrix(Halo halo);

    /// Append a row of blocks; sorts the entries.
    void
    add_row(std::vector<Entry> &entries);

    /// Append a row of whole blocks, nine numbers each by columns, in ascending `columns`.
    void
    add_row(const std::vector<int> &columns, const std::vector<float> &blocks);

    /// Finish the matrix after the last add_row().
    void
    finish();

    /// Set the sum of outer products, which has the same rows.
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

    /// Number of owned block rows.
    std::size_t
    n_rows() const
    {
      return start.size() - 1;
    }

    /// A zero vector of the column space, ghosts included.
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

    /// The diagonal block of a row, by columns; zero where the pattern has none.
    std::array<float, 9>
    diagonal_block(std::size_t row) const;

    /// Global numbers of the column blocks, owned ones first; these count from `first` on.
    std::vector<std::size_t>
    block_numbers(std::size_t first) const;

    /// Call action(column, block) for the assembled blocks of a row, without the outer products.
    template <typename Action>
    void
    for_each_block(const std::size_t row, const Action &action) const
    {
      for (int entry = start[row]; entry < start[row + 1]; ++entry)
        action(column[entry], &values[9 * static_cast<std::size_t>(entry)]);
    }

    /// result = A x. This and the products below update the ghosts of x.
    void
    multiply(BlockVector &x, BlockVector &result) const;

    /// result += A x
    void
    multiply_and_add(BlockVector &x, BlockVector &result) const;

    /// result = b - A x
    void
    find_residual(const BlockVector &b, BlockVector &x, BlockVector &result) const;

    /// result = A^T x on the owned columns, without the outer products.
    void
    multiply_transposed(const BlockVector &x, BlockVector &result) const;

    /// A relaxation step with D^-1, one 3 x 3 block for each block row, in `inverse_diagonal`:
    /// change = keep * change + take * D^-1 (b - A x), then x += change.
    void
    correct(const std::vector<float> &inverse_diagonal,
            const BlockVector        &b,
            float                     keep,
            float                     take,
            BlockVector              &x,
            BlockVector              &change) const;

    /// Memory in bytes.
    std::size_t
    memory_consumption() const;

  private:
    /// Update the ghosts of a vector.
    void
    share(BlockVector &vector) const;

    /// Call action(row, (A x)_row) for all rows, outer products included.
    template <typename Action>
    void
    for_each_product(BlockVector &x, const Action &action) const;

    Halo                    halo;
    std::vector<int>        start, column;
    std::vector<float>      values; ///< 9 a block; padded, as registers of four are read
    OuterProductRows<float> products;
  };

  /// Reads a scalar row, by local number: local column numbers and values. Returns the number of
  /// entries, and enlarges the vectors where they are too short.
  using ReadRow
      = std::function<int(int row, std::vector<int> &columns, std::vector<double> &values)>;

  /// Copy a scalar matrix with `n_rows` block rows in this process into blocks. Column blocks are
  /// numbered globally from `firsts` on, see first_numbers(); `columns` are the global numbers of
  /// the scalar columns, owned ones first.
  BlockMatrix
  make_block_matrix(std::size_t                     n_rows,
                    const std::vector<std::size_t> &firsts,
                    const std::vector<std::size_t> &columns,
                    const ReadRow                  &read_row,
                    const Exchange                 &exchange);

  /// result = factor * D^-1 x, where D^-1 has a 3 x 3 block for each block of x.
  void
  multiply_by_blocks(const std::vector<float> &inverse_diagonal,
                     const BlockVector        &x,
                     float                     factor,
                     BlockVector              &result);
} // namespace Exemplar

#endif
