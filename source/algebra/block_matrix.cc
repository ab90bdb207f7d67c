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

    /// A block times three numbers.
    Register
    times(const float *block, const float *x)
    {
      return load(block) * x[0] + load(block + 3) * x[1] + load(block + 6) * x[2];
    }
  } // namespace

  BlockMatrix::BlockMatrix(const std::size_t                                          n_own,
                           const std::size_t                                          n_others,
                           std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner)
      : n_own(n_own), n_others(n_others), partitioner(std::move(partitioner)), start(1, 0)
  {
  }

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
  BlockMatrix::finish()
  {
    values.resize(values.size() + read_beyond, 0.F);
    values.shrink_to_fit();
    column.shrink_to_fit();
    start.shrink_to_fit();
  }

  const float *
  BlockMatrix::block(const std::size_t row, const std::size_t other) const
  {
    const auto begin = column.begin() + start[row], end = column.begin() + start[row + 1];
    const auto found = std::lower_bound(begin, end, static_cast<int>(other));
    return found == end || *found != static_cast<int>(other)
               ? nullptr
               : &values[9 * (found - column.begin())];
  }

  void
  BlockMatrix::share(BlockVector &vector) const
  {
    if (partitioner == nullptr)
      return;
    std::vector<float>             buffer(partitioner->n_import_indices());
    std::vector<MPI_Request>       requests;
    const dealii::ArrayView<float> others(vector.data() + 4 * n_own, 4 * n_others);
    partitioner->export_to_ghosted_array_start(
        0, dealii::ArrayView<const float>(vector.data(), 4 * n_own),
        dealii::ArrayView<float>(buffer.data(), buffer.size()), others, requests);
    partitioner->export_to_ghosted_array_finish(others, requests);
  }

  namespace
  {
    /// Call action(row, product) for the rows of a product.
    template <typename Action>
    void
    for_each_product(const BlockMatrix &matrix, const BlockVector &x, const Action &action)
    {
      for (std::size_t row = 0; row < matrix.n_rows(); ++row)
      {
        Register sum{};
        matrix.for_each_block(row, [&](const std::size_t column, const float *block)
                              { sum += times(block, &x[4 * column]); });
        action(row, sum);
      }
    }
  } // namespace

  void
  BlockMatrix::multiply(BlockVector &x, BlockVector &result) const
  {
    share(x);
    for_each_product(*this, x,
                     [&](const std::size_t row, const Register product)
                     { store(&result[4 * row], product); });
  }

  void
  BlockMatrix::multiply_and_add(BlockVector &x, BlockVector &result) const
  {
    share(x);
    for_each_product(*this, x,
                     [&](const std::size_t row, const Register product)
                     { store(&result[4 * row], load(&result[4 * row]) + product); });
  }

  void
  BlockMatrix::find_residual(const BlockVector &b, BlockVector &x, BlockVector &result) const
  {
    share(x);
    for_each_product(*this, x,
                     [&](const std::size_t row, const Register product)
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
    share(x);
    for_each_product(*this, x,
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
    if (partitioner == nullptr)
      return;
    std::vector<float>             buffer(partitioner->n_import_indices());
    std::vector<MPI_Request>       requests;
    const dealii::ArrayView<float> others(result.data() + 4 * n_own, 4 * n_others);
    partitioner->import_from_ghosted_array_start(
        dealii::VectorOperation::add, 0, others,
        dealii::ArrayView<float>(buffer.data(), buffer.size()), requests);
    partitioner->import_from_ghosted_array_finish(
        dealii::VectorOperation::add, dealii::ArrayView<const float>(buffer.data(), buffer.size()),
        dealii::ArrayView<float>(result.data(), 4 * n_own), others, requests);
  }

  std::size_t
  BlockMatrix::memory_consumption() const
  {
    return sizeof(int) * (start.capacity() + column.capacity()) + sizeof(float) * values.capacity();
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
