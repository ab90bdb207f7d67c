// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/block_matrix.h>

#include <algorithm>
#include <cstring>

namespace Exemplar
{
  namespace
  {
    using Register = float __attribute__((vector_size(16)));

    Register
    load(const float *place)
    {
      Register result;
      std::memcpy(&result, place, sizeof(result));
      return result;
    }

    void
    store(float *place, const Register value)
    {
      std::memcpy(place, &value, sizeof(value));
    }

    /// Product of a block with a vector of three.
    Register
    times(const float *block, const float *x)
    {
      return load(block) * x[0] + load(block + 3) * x[1] + load(block + 6) * x[2];
    }
  } // namespace

  BlockMatrix::BlockMatrix(Halo halo) : halo(std::move(halo)), start(1, 0) {}

  void
  BlockMatrix::add_row(std::vector<Entry> &entries)
  {
    std::sort(entries.begin(), entries.end(),
              [](const Entry &a, const Entry &b) { return a.column < b.column; });
    for (const Entry &entry : entries)
    {
      if (static_cast<int>(column.size()) == start.back() || column.back() != entry.column)
      {
        column.push_back(entry.column);
        values.resize(values.size() + 9, 0.F);
      }
      values[values.size() - 9 + entry.place] = entry.value;
    }
    start.push_back(static_cast<int>(column.size()));
  }

  void
  BlockMatrix::add_row(const std::vector<int> &columns, const std::vector<float> &blocks)
  {
    column.insert(column.end(), columns.begin(), columns.end());
    values.insert(values.end(), blocks.begin(), blocks.end());
    start.push_back(static_cast<int>(column.size()));
  }

  void
  BlockMatrix::finish()
  {
    values.resize(values.size() + read_beyond, 0.F);
    values.shrink_to_fit();
    column.shrink_to_fit();
    start.shrink_to_fit();
  }

  std::array<float, 9>
  BlockMatrix::diagonal_block(const std::size_t row) const
  {
    std::array<float, 9> sum{};
    const auto           begin = column.begin() + start[row], end = column.begin() + start[row + 1];
    const auto           found = std::lower_bound(begin, end, static_cast<int>(row));
    if (found != end && *found == static_cast<int>(row))
      std::copy_n(&values[9 * (found - column.begin())], 9, sum.begin());
    products.for_each_in_row(row,
                             [&](const int product, const float *u)
                             {
                               for (int j = 0; j < 3; ++j)
                                 for (int i = 0; i < 3; ++i)
                                   sum[3 * j + i] += products.factor(product) * u[j] * u[i];
                             });
    return sum;
  }

  std::vector<std::size_t>
  BlockMatrix::block_numbers(const std::size_t first) const
  {
    const std::size_t        n_own = halo.n_own() / 4;
    std::vector<double>      own(halo.n_own()), others(halo.n_others());
    std::vector<std::size_t> numbers;
    for (std::size_t block = 0; block < n_own; ++block)
    {
      numbers.push_back(first + block);
      own[4 * block] = static_cast<double>(first + block);
    }
    halo.share(own.data(), others.data());
    for (std::size_t k = 0; k < others.size(); k += 4)
      numbers.push_back(static_cast<std::size_t>(others[k]));
    return numbers;
  }

  void
  BlockMatrix::share(BlockVector &vector) const
  {
    halo.share(vector.data(), vector.data() + halo.n_own());
  }

  template <typename Action>
  void
  BlockMatrix::for_each_product(BlockVector &x, const Action &action) const
  {
    share(x);
    const std::vector<float> coefficients = products.coefficients(x.data());
    for (std::size_t row = 0; row < n_rows(); ++row)
    {
      Register sum{};
      for_each_block(row, [&](const std::size_t other, const float *block)
                     { sum += times(block, &x[4 * other]); });
      products.for_each_in_row(row, [&](const int product, const float *u)
                               { sum += load(u) * coefficients[product]; });
      action(row, sum);
    }
  }

  void
  BlockMatrix::multiply(BlockVector &x, BlockVector &result) const
  {
    for_each_product(x, [&](const std::size_t row, const Register product)
                     { store(&result[4 * row], product); });
  }

  void
  BlockMatrix::multiply_and_add(BlockVector &x, BlockVector &result) const
  {
    for_each_product(x, [&](const std::size_t row, const Register product)
                     { store(&result[4 * row], load(&result[4 * row]) + product); });
  }

  void
  BlockMatrix::find_residual(const BlockVector &b, BlockVector &x, BlockVector &result) const
  {
    for_each_product(x, [&](const std::size_t row, const Register product)
                     { store(&result[4 * row], load(&b[4 * row]) - product); });
  }

  void
  BlockMatrix::correct(const std::vector<float> &inverse_diagonal,
                       const BlockVector        &b,
                       const float               keep,
                       const float               take,
                       BlockVector              &x,
                       BlockVector              &change) const
  {
    for_each_product(x,
                     [&](const std::size_t row, const Register product)
                     {
                       float residual[4];
                       store(residual, load(&b[4 * row]) - product);
                       store(&change[4 * row],
                             keep * load(&change[4 * row])
                                 + take * times(&inverse_diagonal[9 * row], residual));
                     });
    for (std::size_t i = 0; i < 4 * n_rows(); ++i)
      x[i] += change[i];
  }

  void
  BlockMatrix::multiply_transposed(const BlockVector &x, BlockVector &result) const
  {
    std::fill(result.begin(), result.end(), 0.F);
    for (std::size_t row = 0; row < n_rows(); ++row)
    {
      const float *r = &x[4 * row];
      for_each_block(row,
                     [&](const std::size_t other, const float *block)
                     {
                       for (unsigned int c = 0; c < 3; ++c)
                         result[4 * other + c] += block[3 * c] * r[0] + block[3 * c + 1] * r[1]
                                                  + block[3 * c + 2] * r[2];
                     });
    }
    halo.add_to_owners(result.data(), result.data() + halo.n_own());
  }

  std::size_t
  BlockMatrix::memory_consumption() const
  {
    return sizeof(int) * (start.capacity() + column.capacity()) + sizeof(float) * values.capacity()
           + products.memory_consumption();
  }

  namespace
  {
    /// Global numbers of the ghost column blocks, ascending.
    std::vector<std::size_t>
    blocks_of_others(const std::vector<std::size_t> &columns, const std::size_t n_own)
    {
      std::vector<std::size_t> others;
      for (std::size_t column = 3 * n_own; column < columns.size(); ++column)
        others.push_back(columns[column] / 3);
      std::sort(others.begin(), others.end());
      others.erase(std::unique(others.begin(), others.end()), others.end());
      return others;
    }

    /// Local block number of each scalar column.
    std::vector<int>
    blocks_of_columns(const std::vector<std::size_t> &columns,
                      const std::size_t               n_own,
                      const std::vector<std::size_t> &others)
    {
      std::vector<int> blocks;
      for (std::size_t column = 0; column < columns.size(); ++column)
        if (column < 3 * n_own)
          blocks.push_back(static_cast<int>(column / 3));
        else
        {
          const auto place = std::lower_bound(others.begin(), others.end(), columns[column] / 3);
          blocks.push_back(static_cast<int>(n_own) + static_cast<int>(place - others.begin()));
        }
      return blocks;
    }
  } // namespace

  BlockMatrix
  make_block_matrix(const std::size_t               n_rows,
                    const std::vector<std::size_t> &firsts,
                    const std::vector<std::size_t> &columns,
                    const ReadRow                  &read_row,
                    const Exchange                 &exchange)
  {
    const unsigned int process = exchange.process();
    const std::size_t  n_own   = firsts[process + 1] - firsts[process];
    const auto         others  = blocks_of_others(columns, n_own);
    const auto         blocks  = blocks_of_columns(columns, n_own, others);

    BlockMatrix                     result(Halo(firsts, others, 4, exchange));
    std::vector<int>                in_row(1000);
    std::vector<double>             values(1000);
    std::vector<BlockMatrix::Entry> entries;
    for (std::size_t block = 0; block < n_rows; ++block)
    {
      entries.clear();
      for (int c = 0; c < 3; ++c)
      {
        const int length = read_row(static_cast<int>(3 * block) + c, in_row, values);
        for (int k = 0; k < length; ++k)
          entries.push_back({ blocks[in_row[k]], static_cast<int>(3 * (columns[in_row[k]] % 3)) + c,
                              static_cast<float>(values[k]) });
      }
      result.add_row(entries);
    }
    result.finish();
    return result;
  }

  void
  multiply_by_blocks(const std::vector<float> &inverse_diagonal,
                     const BlockVector        &x,
                     const float               factor,
                     BlockVector              &result)
  {
    for (std::size_t i = 0; 9 * i + read_beyond < inverse_diagonal.size(); ++i)
      store(&result[4 * i], factor * times(&inverse_diagonal[9 * i], &x[4 * i]));
  }
} // namespace Exemplar
