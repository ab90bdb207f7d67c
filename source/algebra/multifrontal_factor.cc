// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/elimination.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/algebra/multifrontal_factor.h>
#include <exemplar/base/loop_parts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>

namespace Exemplar
{
  namespace
  {
    constexpr std::align_val_t line{ 128 };

    /// Least size of a factor for threads in a solve: starting one takes as long as solving with so many numbers.
    constexpr std::size_t min_values = 400000;

    /// A power of two near 1 over a magnitude, which need not be finite.
    double
    unit_of(const double magnitude)
    {
      constexpr int most = 1000;
      return magnitude == 0. ? 1. : std::exp2(-std::clamp(std::ilogb(magnitude), -most, most));
    }
  } // namespace

  template <typename Number>
  MultifrontalFactor<Number>::MultifrontalFactor(
      std::shared_ptr<const FactorStructure> new_structure, const unsigned int n_threads)
      : structure(std::move(new_structure)), kernels(front_kernels<Number>()),
        n_threads(static_cast<int>(n_threads)),
        values(allocate(structure->n_values() + FrontKernels<Number>::max_lanes))
  {
  }

  template <typename Number>
  void
  MultifrontalFactor<Number>::Free::operator()(Number *numbers) const
  {
    ::operator delete[](numbers, line);
  }

  template <typename Number>
  typename MultifrontalFactor<Number>::Numbers
  MultifrontalFactor<Number>::allocate(const std::size_t n)
  {
    auto *numbers = static_cast<Number *>(::operator new[](n * sizeof(Number), line));
    // what is behind the values is multiplied, though nobody uses the products
    std::fill_n(numbers + n - FrontKernels<Number>::max_lanes, FrontKernels<Number>::max_lanes,
                Number(0.));
    return Numbers(numbers);
  }

  template <typename Number>
  bool
  MultifrontalFactor<Number>::factorize(const std::vector<double> &entries)
  {
    if constexpr (sizeof(Number) < sizeof(double))
      scale = unit_of(max_entry(entries));
    return Elimination<Number>(*structure, entries, scale, values.get()).run(n_threads);
  }

  template <typename Number>
  template <typename Function>
  void
  MultifrontalFactor<Number>::for_each_block(const Function &function) const
  {
    for (int s = 0; s < structure->n_supernodes(); ++s)
      for (PanelBlock block = PanelBlock::first(structure->n_columns(s), structure->n_rows(s));;
           block            = block.next())
      {
        function(s, block);
        if (block.column + block.width == structure->n_columns(s))
          break;
      }
  }

  template <typename Number>
  void
  MultifrontalFactor<Number>::assign(const double *panels)
  {
    std::size_t              n = 0;
    std::vector<std::size_t> begin;
    for (int s = 0; s < structure->n_supernodes(); ++s)
    {
      begin.push_back(n);
      n += static_cast<std::size_t>(structure->n_rows(s)) * structure->n_columns(s);
    }
    const double unit = unit_of(max_entry(panels, panels + n));
    scale             = unit * unit;
    for_each_block(
        [&](const int s, const PanelBlock &block)
        {
          const auto at = [&](const int row, const int column)
          {
            return static_cast<Number>(
                unit
                * panels[begin[s] + static_cast<std::size_t>(column) * structure->n_rows(s) + row]);
          };
          constexpr int      stride = PanelBlock::max_width;
          alignas(64) Number triangle[stride * stride];
          for (int k = 0; k < block.width; ++k)
            for (int i = k; i < block.width; ++i)
              triangle[k * stride + i] = at(block.column + i, block.column + k);
          Number *panel = values.get() + structure->first_value[s], *to = panel + block.below();
          kernels.write_inverse(triangle, block, panel);
          for (int row = 0; row < block.n_below; row += slab_rows)
            for (int k = 0; k < block.width; ++k)
              for (int i = row; i < std::min(row + slab_rows, block.n_below); ++i)
                *to++ = at(block.column + block.width + i, block.column + k);
        });
  }

  template <typename Number>
  template <typename Other>
  void
  MultifrontalFactor<Number>::assign(const MultifrontalFactor<Other> &other)
  {
    // the inverse of the greatest entry of L's diagonal is about as small as entries of inverses get
    const auto   pivots = other.diagonal_range();
    const double unit   = unit_of(pivots.second);
    scale               = unit * unit * other.scale;
    for_each_block(
        [&](const int s, const PanelBlock &block)
        {
          const std::size_t panel = structure->first_value[s];
          const auto copy = [&](const std::size_t begin, const std::size_t end, const double factor)
          {
            std::transform(other.values.get() + panel + begin, other.values.get() + panel + end,
                           values.get() + panel + begin,
                           [factor](const Other value)
                           { return static_cast<Number>(factor * value); });
          };
          copy(block.begin, block.below(), 1. / unit);
          copy(block.below(), block.end(), unit);
        });
  }

  template <typename Number>
  std::pair<double, double>
  MultifrontalFactor<Number>::diagonal_range() const
  {
    double min = std::numeric_limits<double>::infinity(), max = 0.;
    for_each_block(
        [&](const int s, const PanelBlock &block)
        {
          const Number *triangle = values.get() + structure->first_value[s] + block.begin;
          for (int k = 0; k < block.width; ++k)
          {
            const int    row = k / slab_rows * slab_rows;
            const double inverse
                = triangle[PanelBlock::lower_slab(row) + k * block.slab_height(row) + k - row];
            min = std::min(min, 1. / inverse);
            max = std::max(max, 1. / inverse);
          }
        });
    return { min, max };
  }

  template <typename Number>
  double
  MultifrontalFactor<Number>::pivot_ratio() const
  {
    const auto [min, max] = diagonal_range();
    return std::pow(max / min, 2);
  }

  template <typename Number>
  void
  MultifrontalFactor<Number>::solve(std::vector<double> &columns)
  {
    const auto n      = static_cast<std::size_t>(structure->n());
    const int  number = n == 0 ? 0 : static_cast<int>(columns.size() / n);
    for (int k = 0; k < number; k += SupernodeVectors<Number>::max_number)
      solve(columns.data() + k * n, std::min(SupernodeVectors<Number>::max_number, number - k));
  }

  template <typename Number>
  void
  MultifrontalFactor<Number>::solve(double *columns, const int number)
  {
    const std::size_t n = structure->n(), stride = structure->n_of_vectors();
    vectors.resize(std::max(vectors.size(), number * stride));
    const SupernodeVectors<Number>                           all{ vectors.data(), stride, number };
    std::array<double, SupernodeVectors<Number>::max_number> units;
    for (int k = 0; k < number; ++k)
    {
      // scaled: forces that shrink by ten orders of magnitude would underflow in single precision
      double *column = columns + k * n;
      units[k] = sizeof(Number) == sizeof(double) ? 1. : unit_of(max_entry(column, column + n));
      for_each_own_row(vectors.data() + k * stride, [&](const int i, Number &entry)
                       { entry = static_cast<Number>(units[k] * column[i]); });
    }
    const int  n_subtrees  = static_cast<int>(structure->subtrees.size());
    const int  n_at_once   = structure->n_values() < min_values ? 1 : n_threads;
    const auto in_subtrees = [&](const auto &kernel)
    {
      for_each_task(n_subtrees, n_at_once,
                    [&](const int i, int /*thread*/)
                    {
                      kernel(*structure, values.get(), structure->subtrees[i].begin,
                             structure->subtrees[i].end, all);
                    });
    };
    in_subtrees(kernels.forward);
    for (const int s : structure->top)
      kernels.forward(*structure, values.get(), s, s + 1, all);
    for (auto s = structure->top.rbegin(); s != structure->top.rend(); ++s)
      kernels.backward(*structure, values.get(), *s, *s + 1, all);
    in_subtrees(kernels.backward);
    for (int k = 0; k < number; ++k)
      for_each_own_row(vectors.data() + k * stride,
                       [&, factor = scale / units[k]](const int i, const Number &entry)
                       { columns[k * n + i] = factor * entry; });
  }

  template <typename Number>
  template <typename Function>
  void
  MultifrontalFactor<Number>::for_each_own_row(Number *vector, const Function &function) const
  {
    for (int s = 0; s < structure->n_supernodes(); ++s)
    {
      Number    *own = vector + structure->vector_begin(s);
      const int *row = structure->permutation.data() + structure->first_column[s];
      for (int i = 0; i < structure->n_columns(s); ++i)
        function(row[i], own[i]);
    }
  }

  template <typename Number>
  std::size_t
  MultifrontalFactor<Number>::memory_consumption() const
  {
    return structure->memory_consumption()
           + sizeof(Number) * (structure->n_values() + vectors.capacity());
  }

  template class MultifrontalFactor<double>;
  template class MultifrontalFactor<float>;
  template void
  MultifrontalFactor<float>::assign(const MultifrontalFactor<double> &);
} // namespace Exemplar
