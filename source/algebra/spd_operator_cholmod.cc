// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/single_precision_inverse.h>
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/base/environment.h>
#include <exemplar/base/errors.h>

#include <cholmod.h>
#include <mutex>
#include <string>

namespace Exemplar
{
  namespace
  {
    class CholmodOperator : public SpdOperator
    {
    public:
      CholmodOperator()
      {
        cholmod_start(&common);
        common.print      = 0; // it would print about indefinite matrices; we throw
        common.supernodal = CHOLMOD_SUPERNODAL; // L D L^T, its choice for small matrices, lets
                                                // indefinite ones pass
      }

      CholmodOperator(const CholmodOperator &) = delete;
      CholmodOperator &
      operator=(const CholmodOperator &)
          = delete;

      ~CholmodOperator() override
      {
        cholmod_free_dense(&solution, &common);
        cholmod_free_dense(&workspace_y, &common);
        cholmod_free_dense(&workspace_e, &common);
        cholmod_free_factor(&factor, &common);
        cholmod_finish(&common);
      }

      OperatorTraits
      traits() const override
      {
        const bool is_factorized = pattern.n() > 0 && factor->xtype != CHOLMOD_PATTERN;
        return { "cholesky", common.fl, is_factorized ? 1. / cholmod_rcond(factor, &common) : 0.,
                 common.memory_inuse
                     + sizeof(int) * (pattern.row.size() + pattern.column_start.size())
                     + sizeof(double) * matrix_values.size() };
      }

      void
      reinit(const SymmetricPattern &new_pattern) override
      {
        pattern = new_pattern;
        matrix_values.assign(pattern.n_values(), 0.);
        matrix.nrow   = pattern.n();
        matrix.ncol   = pattern.n();
        matrix.nzmax  = pattern.row.size();
        matrix.p      = pattern.column_start.data();
        matrix.i      = pattern.row.data();
        matrix.x      = matrix_values.data();
        matrix.stype  = -1; // the lower triangle
        matrix.itype  = CHOLMOD_INT;
        matrix.xtype  = CHOLMOD_REAL;
        matrix.dtype  = CHOLMOD_DOUBLE;
        matrix.sorted = 1;
        matrix.packed = 1;
        cholmod_free_factor(&factor, &common);
        analyze();
        check("analysis");
      }

      std::vector<double> &
      values() override
      {
        return matrix_values;
      }

      void
      factorize(const Vector & /*positions*/) override
      {
        if (pattern.n() == 0)
          return;
        const OpenMPScope scope(OpenMPScope::Threads::one);
        cholmod_factorize(&matrix, factor, &common);
        check("factorisation");
      }

      void
      solve(std::vector<double> &columns) override
      {
        const std::size_t n = pattern.n();
        if (n == 0)
          return;
        cholmod_dense right_side{};
        right_side.nrow  = n;
        right_side.ncol  = columns.size() / n;
        right_side.nzmax = columns.size();
        right_side.d     = n;
        right_side.x     = columns.data();
        right_side.xtype = CHOLMOD_REAL;
        right_side.dtype = CHOLMOD_DOUBLE;
        const OpenMPScope scope(OpenMPScope::Threads::one);
        cholmod_solve2(CHOLMOD_A, factor, &right_side, nullptr, &solution, nullptr, &workspace_y,
                       &workspace_e, &common);
        check("solve");
        const double *x = static_cast<const double *>(solution->x);
        std::copy(x, x + columns.size(), columns.begin());
      }

      std::unique_ptr<KeptInverse>
      keep() const override
      {
        return std::make_unique<SinglePrecisionInverse>(panels());
      }

    private:
      /// One thread at a time: METIS, which orders large matrices, draws from the one sequence of
      /// random numbers of the C library, and the order decides the last digits.
      void
      analyze()
      {
        static std::mutex                 of_random_numbers;
        const std::lock_guard<std::mutex> lock(of_random_numbers);
        const OpenMPScope                 scope(OpenMPScope::Threads::one);
        factor = cholmod_analyze(&matrix, &common);
      }

      FactorPanels
      panels() const
      {
        const auto *super   = static_cast<const int *>(factor->super);
        const auto *row     = static_cast<const int *>(factor->pi);
        const auto *value   = static_cast<const int *>(factor->px);
        const auto *rows    = static_cast<const int *>(factor->s);
        const auto *values  = static_cast<const double *>(factor->x);
        const auto *order   = static_cast<const int *>(factor->Perm);
        const auto  n_super = static_cast<std::ptrdiff_t>(factor->nsuper);

        FactorPanels panels;
        panels.permutation.assign(order, order + factor->n);
        panels.first_column.assign(super, super + n_super + 1);
        panels.first_row.assign(row, row + n_super + 1);
        panels.first_value.assign(value, value + n_super + 1);
        panels.rows.assign(rows, rows + row[n_super]);
        panels.values.resize(value[n_super]);
        for (std::ptrdiff_t i = 0; i < value[n_super]; ++i)
          panels.values[i] = static_cast<float>(values[i]);
        for (std::ptrdiff_t s = 0; s < n_super; ++s)
          for (int k = 0; k < super[s + 1] - super[s]; ++k)
          {
            const std::ptrdiff_t diagonal
                = value[s] + static_cast<std::ptrdiff_t>(k) * (row[s + 1] - row[s]) + k;
            panels.values[diagonal] = static_cast<float>(1. / values[diagonal]);
          }
        return panels;
      }

      void
      check(const std::string &what)
      {
        if (common.status == CHOLMOD_NOT_POSDEF)
          throw indefinite_matrix();
        if (common.status == CHOLMOD_TOO_LARGE || common.status == CHOLMOD_OUT_OF_MEMORY)
          throw SolverFailure("CHOLMOD's " + what
                              + " needs more memory than there is. Set Solver/Linear solver to "
                                "iterative, or use a coarser mesh.");
        if (common.status < CHOLMOD_OK)
          throw SolverFailure("CHOLMOD's " + what + " failed with status "
                              + std::to_string(common.status) + ".");
      }

      mutable cholmod_common common{}; ///< CHOLMOD wants it in all calls
      SymmetricPattern       pattern;
      std::vector<double>    matrix_values;
      cholmod_sparse         matrix{};
      cholmod_factor        *factor      = nullptr;
      cholmod_dense         *solution    = nullptr;
      cholmod_dense         *workspace_y = nullptr;
      cholmod_dense         *workspace_e = nullptr;
    };
  } // namespace

  std::unique_ptr<SpdOperator>
  make_cholesky_operator()
  {
    return std::make_unique<CholmodOperator>();
  }
} // namespace Exemplar
