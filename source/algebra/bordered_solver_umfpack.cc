// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/bordered_solver.h>
#include <exemplar/base/errors.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    class UmfpackSolver : public BorderedSolver
    {
    public:
      explicit UmfpackSolver(const SymmetricPattern &pattern)
          : pattern(pattern), values(pattern.n_values())
      {
      }

      std::string
      name() const override
      {
        return "umfpack";
      }

      std::vector<double> &
      matrix_values() override
      {
        return values;
      }

      SpdOperator *
      matrix() override
      {
        return nullptr;
      }

      void
      factorize(const WeightBlock &block) override
      {
        if (sparse.empty())
          build_pattern(block);
        fill(block);
        try
        {
          umfpack.factorize(sparse);
        }
        catch (const dealii::ExceptionBase &)
        {
          throw SolverFailure("UMFPACK finds the bordered matrix of the step singular. A body "
                              "may be without support, or examples may depend on each other.");
        }
      }

      void
      solve(const WeightBlock &, BorderedVector &vector) override
      {
        dealii::Vector<double> all(sparse.m());
        auto next = std::copy(vector.positions.begin(), vector.positions.end(), all.begin());
        next      = std::copy(vector.weights.begin(), vector.weights.end(), next);
        std::copy(vector.multipliers.begin(), vector.multipliers.end(), next);
        umfpack.solve(all);
        const auto first_weight     = all.begin() + vector.positions.size();
        const auto first_multiplier = first_weight + vector.weights.size();
        std::copy(all.begin(), first_weight, vector.positions.begin());
        std::copy(first_weight, first_multiplier, vector.weights.begin());
        std::copy(first_multiplier, all.end(), vector.multipliers.begin());
      }

    private:
      /// Call add(row, column, value) for every entry of the bordered matrix.
      template <typename Add>
      void
      for_each_entry(const WeightBlock &block, const Add &add)
      {
        const unsigned int n = pattern.n(), k = block.H.m();
        const auto         add_twice
            = [&add](const unsigned int i, const unsigned int j, const double value)
        {
          add(i, j, value);
          if (i != j)
            add(j, i, value);
        };
        for (unsigned int column = 0; column < n; ++column)
          for (int entry = pattern.column_start[column]; entry < pattern.column_start[column + 1];
               ++entry)
            add_twice(pattern.row[entry], column, values[entry]);
        for (std::size_t j = 0; j < block.coupled.size(); ++j)
          for (unsigned int i = 0; i < n; ++i)
            add_twice(n + block.coupled[j], i, -block.coupling[j * n + i]);
        for (unsigned int j = 0; j < k; ++j)
        {
          for (unsigned int i = j; i < k; ++i)
            add_twice(n + i, n + j, block.H(i, j));
          for (unsigned int c = 0; c < block.N.m(); ++c)
            add_twice(n + k + c, n + j, block.N(c, j));
        }
      }

      void
      build_pattern(const WeightBlock &block)
      {
        const unsigned int             size = pattern.n() + block.H.m() + block.N.m();
        dealii::DynamicSparsityPattern entries(size);
        for_each_entry(block, [&](const unsigned int i, const unsigned int j, double)
                       { entries.add(i, j); });
        sparsity.copy_from(entries);
        sparse.reinit(sparsity);
      }

      void
      fill(const WeightBlock &block)
      {
        sparse = 0.;
        for_each_entry(block, [&](const unsigned int i, const unsigned int j, const double value)
                       { sparse.set(i, j, value); });
      }

      const SymmetricPattern       pattern;
      std::vector<double>          values;
      dealii::SparsityPattern      sparsity;
      dealii::SparseMatrix<double> sparse;
      dealii::SparseDirectUMFPACK  umfpack;
    };
  } // namespace

  std::unique_ptr<BorderedSolver>
  make_umfpack_solver(const SymmetricPattern &pattern)
  {
    return std::make_unique<UmfpackSolver>(pattern);
  }
} // namespace Exemplar
