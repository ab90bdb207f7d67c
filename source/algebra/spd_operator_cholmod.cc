// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/cholmod_analysis.h>
#include <exemplar/algebra/single_precision_inverse.h>
#include <exemplar/base/environment.h>

namespace Exemplar
{
  namespace
  {
    class CholmodOperator : public SpdOperator
    {
    public:
      CholmodOperator() = default;

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
      }

      OperatorTraits
      traits() const override
      {
        const bool is_factorized = pattern.n() > 0 && factor->xtype != CHOLMOD_PATTERN;
        return { "cholmod", common->fl, is_factorized ? 1. / cholmod_rcond(factor, &common) : 0.,
                 common->memory_inuse
                     + sizeof(int) * (pattern.row.size() + pattern.column_start.size())
                     + sizeof(double) * matrix_values.size() };
      }

      void
      reinit(const SymmetricPattern &new_pattern) override
      {
        pattern = new_pattern;
        matrix_values.assign(pattern.n_values(), 0.);
        matrix = cholmod_view(pattern, matrix_values.data());
        cholmod_free_factor(&factor, &common);
        factor = analyze(pattern, common);
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
        const OneOpenMPThread one_thread;
        cholmod_factorize(&matrix, factor, &common);
        common.check("factorisation");
      }

      void
      solve(std::vector<double> &columns, double /*accuracy*/) override
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
        const OneOpenMPThread one_thread;
        cholmod_solve2(CHOLMOD_A, factor, &right_side, nullptr, &solution, nullptr, &workspace_y,
                       &workspace_e, &common);
        common.check("solve");
        const double *x = static_cast<const double *>(solution->x);
        std::copy(x, x + columns.size(), columns.begin());
      }

      std::unique_ptr<KeptInverse>
      keep() const override
      {
        auto structure
            = std::make_shared<const FactorStructure>(factor_structure(pattern, *factor, common));
        auto rounded = std::make_shared<MultifrontalFactor<float>>(std::move(structure), 1);
        rounded->assign(static_cast<const double *>(factor->x));
        return std::make_unique<SinglePrecisionInverse>(std::move(rounded));
      }

    private:
      mutable CholmodCommon common; ///< CHOLMOD wants it in all calls
      SymmetricPattern      pattern;
      std::vector<double>   matrix_values;
      cholmod_sparse        matrix{};
      cholmod_factor       *factor      = nullptr;
      cholmod_dense        *solution    = nullptr;
      cholmod_dense        *workspace_y = nullptr;
      cholmod_dense        *workspace_e = nullptr;
    };
  } // namespace

  std::unique_ptr<SpdOperator>
  make_cholmod_operator()
  {
    return std::make_unique<CholmodOperator>();
  }
} // namespace Exemplar
