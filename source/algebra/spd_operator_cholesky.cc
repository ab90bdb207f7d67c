// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/cholmod_analysis.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/algebra/multifrontal_factor.h>
#include <exemplar/algebra/single_precision_inverse.h>
#include <exemplar/algebra/spd_operator.h>

#include <optional>

namespace Exemplar
{
  namespace
  {
    /// A plain pattern's order of elimination serves for more couplings up to so many times the operations.
    constexpr double greatest_growth = 1.5;

    std::shared_ptr<const FactorStructure>
    analyzed(const SymmetricPattern &pattern, const std::vector<int> &order = {})
    {
      CholmodCommon common;
      common.join_more_supernodes();
      cholmod_factor *factor = analyze(pattern, common, order);
      FactorStructure result = factor_structure(pattern, *factor, common);
      cholmod_free_factor(&factor, &common);
      return std::make_shared<const FactorStructure>(std::move(result));
    }

    /// r -= A x, where A is given by its lower triangle.
    void
    subtract_product(const SymmetricPattern    &pattern,
                     const std::vector<double> &values,
                     const double              *x,
                     double                    *r)
    {
      for (unsigned int j = 0; j < pattern.n(); ++j)
      {
        const int diagonal = pattern.column_start[j];
        double    sum      = values[diagonal] * x[j];
        for (int k = diagonal + 1; k < pattern.column_start[j + 1]; ++k)
        {
          sum += values[k] * x[pattern.row[k]];
          r[pattern.row[k]] -= values[k] * x[j];
        }
        r[j] -= sum;
      }
    }

    class CholeskyOperator : public SpdOperator
    {
    public:
      explicit CholeskyOperator(const unsigned int n_threads) : n_threads(n_threads) {}

      OperatorTraits
      traits() const override
      {
        OperatorTraits traits = { "cholesky", structure->n_operations, 0.,
                                  sizeof(int) * (pattern.row.size() + pattern.column_start.size())
                                      + sizeof(double) * matrix_values.size() };
        if (factor)
          traits.pivot_ratio = factor->pivot_ratio();
        else if (rough_factor)
          traits.pivot_ratio = rough_factor->pivot_ratio();
        traits.bytes += factor         ? factor->memory_consumption()
                        : rough_factor ? rough_factor->memory_consumption()
                                       : 0;
        return traits;
      }

      void
      reinit(const SymmetricPattern &new_pattern) override
      {
        pattern = new_pattern;
        matrix_values.assign(pattern.n_values(), 0.);
        rough_factor.reset();
        factor.reset();
        structure = analyzed_in_order_of_plain();
      }

      std::vector<double> &
      values() override
      {
        return matrix_values;
      }

      void
      factorize(const Vector & /*positions*/) override
      {
        rough_factor.reset();
        if (!factor)
          factor.emplace(structure, threads_at_work());
        if (factor->factorize(matrix_values))
          return;
        factor.reset();
        throw indefinite_matrix();
      }

      void
      factorize_roughly(const Vector &positions) override
      {
        factor.reset();
        if (rough_factor.use_count() != 1) // none yet, or the last one is kept
          rough_factor = std::make_shared<MultifrontalFactor<float>>(structure, threads_at_work());
        if (!rough_factor->factorize(matrix_values)) // not definite in single precision, at least
          factorize(positions);
      }

      void
      solve(std::vector<double> &columns, double /*accuracy*/) override
      {
        if (factor)
          factor->solve(columns);
        else if (rough_factor != nullptr)
          solve_roughly(columns);
        else if (pattern.n() > 0)
          throw indefinite_matrix(); // the last factorisation has failed
      }

      std::unique_ptr<SpdOperator>
      twin() const override
      {
        auto other       = std::make_unique<CholeskyOperator>(n_threads);
        other->pattern   = pattern;
        other->structure = structure;
        other->matrix_values.assign(pattern.n_values(), 0.);
        return other;
      }

      std::unique_ptr<KeptInverse>
      keep() const override
      {
        if (rough_factor != nullptr)
          return std::make_unique<SinglePrecisionInverse>(rough_factor);
        if (!factor)
          throw indefinite_matrix(); // the last factorisation has failed
        auto rounded = std::make_shared<MultifrontalFactor<float>>(structure, threads_at_work());
        rounded->assign(*factor);
        return std::make_unique<SinglePrecisionInverse>(std::move(rounded));
      }

    private:
      std::shared_ptr<const FactorStructure>
      analyzed_in_order_of_plain()
      {
        if (pattern.plain == nullptr)
          return analyzed(pattern);
        if (plain != pattern.plain)
        {
          plain           = pattern.plain;
          plain_structure = analyzed(*plain);
        }
        if (pattern.row.size() == plain->row.size())
          return plain_structure;
        auto in_order = analyzed(pattern, plain_structure->permutation);
        return in_order->n_operations > greatest_growth * plain_structure->n_operations
                   ? analyzed(pattern)
                   : in_order;
      }

      /// Number of threads; one for a small factor, whose threads would wait longer than they work,
      /// by far where other programs use the cores.
      unsigned int
      threads_at_work() const
      {
        return structure->n_operations < 3e7 ? 1 : n_threads;
      }

      /// Solve by iterative refinement; each step gains the digits of single precision.
      void
      solve_roughly(std::vector<double> &columns)
      {
        const std::size_t   n        = pattern.n();
        std::vector<double> residual = columns;
        std::fill(columns.begin(), columns.end(), 0.);
        for (unsigned int k = 0;; ++k)
        {
          std::vector<double> step = residual;
          rough_factor->solve(step);
          add(columns, 1., step);
          if (k == n_refinements)
            return;
          for (std::size_t begin = 0; begin < columns.size(); begin += n)
            subtract_product(pattern, matrix_values, step.data() + begin, residual.data() + begin);
        }
      }

      static constexpr unsigned int n_refinements = 2;

      const unsigned int                         n_threads;
      SymmetricPattern                           pattern;
      std::vector<double>                        matrix_values;
      std::shared_ptr<const FactorStructure>     structure;
      std::shared_ptr<const SymmetricPattern>    plain; ///< of the last pattern that had one
      std::shared_ptr<const FactorStructure>     plain_structure;
      std::optional<MultifrontalFactor<double>>  factor;
      std::shared_ptr<MultifrontalFactor<float>> rough_factor; ///< null while `factor` is set
    };
  } // namespace

  std::unique_ptr<SpdOperator>
  make_cholesky_operator(const unsigned int n_threads)
  {
    return std::make_unique<CholeskyOperator>(n_threads);
  }
} // namespace Exemplar
