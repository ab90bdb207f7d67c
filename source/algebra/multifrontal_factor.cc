// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/blas.h>
#include <exemplar/algebra/elimination.h>
#include <exemplar/algebra/front_kernels.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/algebra/multifrontal_factor.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// Multiplication of several columns by L^-1 or L^-T, restricted to supernodes begin to
    /// end - 1, by BLAS.
    template <typename Number>
    struct SeveralColumns
    {
      const FactorStructure &structure;
      const Number          *values;
      Number                *columns;
      int                    stride, n_columns;

      void
      forward(const int begin, const int end, std::vector<Number> &block) const
      {
        for (int s = begin; s < end; ++s)
        {
          const auto [n, below, rows, L, own] = front(s);
          Blas::solve_triangle<Number>("L", "N", n, n_columns, L, own);
          if (below == 0) // the reference BLAS refuses empty blocks
            continue;
          block.resize(static_cast<std::size_t>(below) * n_columns);
          Blas::subtract_product<Number>("N", "N", below, n_columns, n, { L.values + n, L.stride },
                                         { own.values, stride }, 0., { block.data(), below });
          for (int k = 0; k < n_columns; ++k)
            for (int i = 0; i < below; ++i)
              at(rows[i], k) += block[static_cast<std::size_t>(k) * below + i];
        }
      }

      void
      backward(const int begin, const int end, std::vector<Number> &block) const
      {
        for (int s = end; s-- > begin;)
        {
          const auto [n, below, rows, L, own] = front(s);
          block.resize(static_cast<std::size_t>(below) * n_columns);
          for (int k = 0; k < n_columns; ++k)
            for (int i = 0; i < below; ++i)
              block[static_cast<std::size_t>(k) * below + i] = at(rows[i], k);
          if (below > 0)
            Blas::subtract_product<Number>("T", "N", n, n_columns, below,
                                           { L.values + n, L.stride }, { block.data(), below }, 1.,
                                           own);
          Blas::solve_triangle<Number>("L", "T", n, n_columns, L, own);
        }
      }

    private:
      struct Front
      {
        int                        n, below; ///< number of columns, and of rows below the triangle
        const int                 *rows;     ///< numbers of the rows below the triangle
        Blas::Matrix<const Number> L;
        Blas::Matrix<Number>       own; ///< right sides at the supernode's columns
      };

      Front
      front(const int s) const
      {
        const int n = structure.n_columns(s), n_rows = structure.n_rows(s);
        return { n,
                 n_rows - n,
                 structure.rows.data() + structure.first_row[s] + n,
                 { values + structure.first_value[s], n_rows },
                 { columns + structure.first_column[s], stride } };
      }

      Number &
      at(const int row, const int k) const
      {
        return columns[static_cast<std::size_t>(k) * stride + row];
      }
    };
  } // namespace

  template <typename Number>
  MultifrontalFactor<Number>::MultifrontalFactor(
      std::shared_ptr<const FactorStructure> new_structure, const unsigned int n_threads)
      : structure(std::move(new_structure)), n_threads(static_cast<int>(n_threads)),
        inverse_diagonal(structure->n()), workspace(n_threads)
  {
  }

  template <typename Number>
  bool
  MultifrontalFactor<Number>::factorize(const std::vector<double> &entries)
  {
    values.resize(structure->n_values() + FrontKernels<Number>::max_lanes);
    if constexpr (sizeof(Number) < sizeof(double))
      scale = std::exp2(-std::ilogb(max_entry(entries)));
    const bool is_definite
        = Elimination<Number>(*structure, entries, scale, values.data()).run(n_threads);
    if (is_definite)
      finish();
    return is_definite;
  }

  template <typename Number>
  void
  MultifrontalFactor<Number>::assign(const double *panels)
  {
    const double *end  = panels + structure->n_values();
    const double  unit = std::exp2(-std::ilogb(max_entry(panels, end)));
    scale              = unit * unit;
    values.resize(structure->n_values() + FrontKernels<Number>::max_lanes);
    std::transform(panels, end, values.begin(),
                   [unit](const double value) { return static_cast<Number>(unit * value); });
    finish();
  }

  template <typename Number>
  void
  MultifrontalFactor<Number>::finish()
  {
    for (int s = 0; s < structure->n_supernodes(); ++s)
      for (int c = 0; c < structure->n_columns(s); ++c)
        inverse_diagonal[structure->first_column[s] + c]
            = Number(1.)
              / values[structure->first_value[s]
                       + static_cast<std::size_t>(c) * structure->n_rows(s) + c];
  }

  template <typename Number>
  double
  MultifrontalFactor<Number>::pivot_ratio() const
  {
    const auto [min, max] = std::minmax_element(inverse_diagonal.begin(), inverse_diagonal.end());
    return std::pow(static_cast<double>(*max) / static_cast<double>(*min), 2);
  }

  template <typename Number>
  void
  MultifrontalFactor<Number>::solve(std::vector<Number> &columns)
  {
    const auto n_columns = static_cast<int>(columns.size() / std::max(1, structure->n()));
    if (n_columns == 1)
    {
      const FrontKernels<Number> &kernels = front_kernels<Number>();
      const auto                  by      = [&](const auto &kernel)
      {
        return [&, kernel](const int begin, const int end, Number *column, std::size_t,
                           std::vector<Number> &block)
        {
          block.resize(structure->max_rows + FrontKernels<Number>::max_lanes);
          kernel(*structure, values.data(), inverse_diagonal.data(), begin, end, column,
                 block.data());
        };
      };
      workspace.solve(*structure, columns, by(kernels.forward), by(kernels.backward));
      return;
    }
    const auto of = [&](Number *permuted, const std::size_t stride)
    {
      return SeveralColumns<Number>{ *structure, values.data(), permuted, static_cast<int>(stride),
                                     n_columns };
    };
    workspace.solve(
        *structure, columns,
        [&](const int begin, const int end, Number *permuted, const std::size_t stride,
            std::vector<Number> &block) { of(permuted, stride).forward(begin, end, block); },
        [&](const int begin, const int end, Number *permuted, const std::size_t stride,
            std::vector<Number> &block) { of(permuted, stride).backward(begin, end, block); });
  }

  template <typename Number>
  void
  MultifrontalFactor<Number>::forward(const int supernode, Number *vector, Number *block) const
  {
    front_kernels<Number>().forward(*structure, values.data(), inverse_diagonal.data(), supernode,
                                    supernode + 1, vector, block);
  }

  template <typename Number>
  std::size_t
  MultifrontalFactor<Number>::memory_consumption() const
  {
    return structure->memory_consumption() + workspace.memory_consumption()
           + sizeof(Number) * (values.capacity() + inverse_diagonal.capacity());
  }

  template class MultifrontalFactor<double>;
  template class MultifrontalFactor<float>;
} // namespace Exemplar
