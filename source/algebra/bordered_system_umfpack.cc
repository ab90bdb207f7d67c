// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/bordered_system.h>
#include <exemplar/base/errors.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    class UmfpackSystem : public BorderedSystem
    {
    public:
      UmfpackSystem(const SymmetricPattern &pattern, const WeightForm &form)
          : BorderedSystem(form), pattern(pattern), values(pattern.n_values())
      {
      }

      OperatorTraits
      traits() const override
      {
        return { "umfpack", 0., 0., 0 };
      }

      void
      reinit(const SymmetricPattern &new_pattern) override
      {
        pattern = new_pattern;
        values.assign(pattern.n_values(), 0.);
        sparse.clear();
      }

      std::vector<double> &
      matrix_values() override
      {
        return values;
      }

      void
      factorize(const Vector & /*positions*/) override
      {
        if (sparse.empty())
          build_pattern();
        fill();
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
      solve(BorderedVector &vector, const WeightLimits & /*limits*/, double /*accuracy*/) override
      {
        Vector all(sparse.m());
        auto   next = std::copy(vector.positions.begin(), vector.positions.end(), all.begin());
        next        = std::copy(vector.weights.begin(), vector.weights.end(), next);
        std::copy(vector.multipliers.begin(), vector.multipliers.end(), next);
        umfpack.solve(all);
        const auto first_weight     = all.begin() + vector.positions.size();
        const auto first_multiplier = first_weight + vector.weights.size();
        std::copy(all.begin(), first_weight, vector.positions.begin());
        std::copy(first_weight, first_multiplier, vector.weights.begin());
        std::copy(first_multiplier, all.end(), vector.multipliers.begin());
      }

      void
      apply_inverse(std::vector<double> & /*columns*/) override
      {
        throw no_factor();
      }

      std::unique_ptr<KeptInverse>
      keep() const override
      {
        throw no_factor();
      }

    private:
      static SolverFailure
      no_factor()
      {
        return SolverFailure(
            "Solver/Linear solver = umfpack makes no factor of the positions' block.");
      }

      /// Call add(row, column, value) for every entry of the bordered matrix.
      template <typename Add>
      void
      for_each_entry(const Add &add)
      {
        const unsigned int n = pattern.n();
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
        const unsigned int k = form.H.m();
        for (std::size_t j = 0; j < form.coupled.size(); ++j)
          for (unsigned int i = 0; i < n; ++i)
            add_twice(n + form.coupled[j], i, -G[j * n + i]);
        for (unsigned int j = 0; j < k; ++j)
        {
          for (unsigned int i = j; i < k; ++i)
            add_twice(n + i, n + j, form.H(i, j));
          for (unsigned int c = 0; c < form.N.m(); ++c)
            add_twice(n + k + c, n + j, form.N(c, j));
        }
      }

      void
      build_pattern()
      {
        const unsigned int             size = pattern.n() + form.H.m() + form.N.m();
        dealii::DynamicSparsityPattern entries(size);
        for_each_entry([&](const unsigned int i, const unsigned int j, double)
                       { entries.add(i, j); });
        sparsity.copy_from(entries);
        sparse.reinit(sparsity);
      }

      void
      fill()
      {
        sparse = 0.;
        for_each_entry([&](const unsigned int i, const unsigned int j, const double value)
                       { sparse.set(i, j, value); });
      }

      SymmetricPattern             pattern;
      std::vector<double>          values;
      dealii::SparsityPattern      sparsity;
      dealii::SparseMatrix<double> sparse;
      dealii::SparseDirectUMFPACK  umfpack;
    };
  } // namespace

  std::unique_ptr<BorderedSystem>
  make_umfpack_system(const SymmetricPattern &pattern, const WeightForm &form)
  {
    return std::make_unique<UmfpackSystem>(pattern, form);
  }
} // namespace Exemplar
