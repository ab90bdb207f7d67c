// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/blas.h>
#include <exemplar/algebra/bordered_system.h>
#include <exemplar/algebra/weight_qp.h>
#include <exemplar/base/errors.h>

#include <algorithm>
#include <numeric>

namespace Exemplar
{
  dealii::FullMatrix<double>
  make_schur_complement(const WeightForm          &form,
                        const std::vector<double> &G,
                        const double              *Z,
                        const std::size_t          n,
                        const Exchange            &exchange)
  {
    dealii::FullMatrix<double> schur = form.H;
    const auto                &index = form.coupled;
    const int                  m = static_cast<int>(index.size()), n_rows = static_cast<int>(n);
    std::vector<double>        products(index.size() * index.size(), 0.); // -G^T Z by columns
    if (m > 0 && n_rows > 0)
      Blas::subtract_product<double>("T", "N", m, m, n_rows, { G.data(), n_rows }, { Z, n_rows },
                                     0., { products.data(), m });
    exchange.sum(products);
    for (std::size_t j = 0; j < index.size(); ++j)
      for (std::size_t i = 0; i < index.size(); ++i)
        schur(index[i], index[j]) += products[j * index.size() + i];
    return schur;
  }

  namespace
  {
    class BlockSystem : public BorderedSystem
    {
    public:
      BlockSystem(std::unique_ptr<SpdOperator> matrix,
                  const WeightForm            &form,
                  const Exchange              &exchange)
          : BorderedSystem(form), A(std::move(matrix)), exchange(exchange)
      {
      }

      OperatorTraits
      traits() const override
      {
        return A->traits();
      }

      void
      reinit(const SymmetricPattern &pattern) override
      {
        inverse_columns.clear();
        A->reinit(pattern);
      }

      std::vector<double> &
      matrix_values() override
      {
        return A->values();
      }

      OuterProducts *
      outer_products() override
      {
        return A->outer_products();
      }

      UnknownShear *
      shear() override
      {
        return A->shear();
      }

      void
      factorize(const Vector &positions) override
      {
        inverse_columns.clear();
        A->factorize(positions);
      }

      void
      factorize_roughly(const Vector &positions) override
      {
        inverse_columns.clear();
        A->factorize_roughly(positions);
      }

      void
      factorize_near(const Vector &positions) override
      {
        inverse_columns.clear();
        A->factorize_near(positions);
      }

      bool
      leans_on_earlier() const override
      {
        return A->leans_on_earlier();
      }

      void
      solve(BorderedVector &vector, const WeightLimits &limits, const double accuracy) override
      {
        const std::size_t n  = vector.positions.size();
        const double      to = form.coupled.empty() ? accuracy : 0.;
        if (inverse_columns.empty())
          find_columns(vector.positions, to);
        else // Z is still that of this factor
        {
          A->solve(vector.positions, to);
          std::copy(vector.positions.begin(), vector.positions.end(), inverse_columns.begin());
        }
        solve_weights(vector, limits);
        std::copy(inverse_columns.begin(), inverse_columns.begin() + n, vector.positions.begin());
        for (std::size_t j = 0; j < form.coupled.size(); ++j)
        {
          const double *Z_j = inverse_columns.data() + (1 + j) * n;
          for (std::size_t i = 0; i < n; ++i)
            vector.positions[i] += vector.weights[form.coupled[j]] * Z_j[i];
        }
      }

      bool
      iterates() const override
      {
        return form.coupled.empty() && A->iterates();
      }

      void
      apply_inverse(std::vector<double> &columns) override
      {
        A->solve(columns);
      }

      void
      prepare() override
      {
        if (!form.coupled.empty())
          find_columns(std::vector<double>(G.size() / form.coupled.size(), 0.), 0.);
      }

      std::unique_ptr<BorderedSystem>
      twin() const override
      {
        std::unique_ptr<SpdOperator> matrix = A->twin();
        return matrix == nullptr ? nullptr
                                 : std::make_unique<BlockSystem>(std::move(matrix), form, exchange);
      }

      std::unique_ptr<KeptInverse>
      keep() const override
      {
        return A->keep();
      }

    private:
      /// z = A^-1 r_x and Z = A^-1 G
      void
      find_columns(std::vector<double> right_side, const double accuracy)
      {
        right_side.insert(right_side.end(), G.begin(), G.end());
        A->solve(right_side, accuracy); // no columns if this throws
        inverse_columns = std::move(right_side);
      }

      /// The quadratic of the Schur complement over the weights, Eq. (11)
      void
      solve_weights(BorderedVector &vector, const WeightLimits &limits)
      {
        const std::size_t   n          = vector.positions.size();
        std::vector<double> right_side = vector.weights;
        for (std::size_t i = 0; i < form.coupled.size(); ++i)
          right_side[form.coupled[i]] += exchange.sum(std::inner_product(
              G.begin() + i * n, G.begin() + (i + 1) * n, inverse_columns.begin(), 0.));
        schur = make_schur_complement(form, G, inverse_columns.data() + n, n, exchange);
        const WeightQpSolution solution
            = minimize_over_weights(form, schur, right_side, vector.multipliers, limits);
        if (!solution.found)
          throw SolverFailure("The system for the example weights is not positive definite. Set "
                              "Examples/Weight penalty to auto, or remove an example that is a "
                              "combination of the others.");
        vector.weights     = solution.weights;
        vector.multipliers = solution.multipliers;
      }

      const std::unique_ptr<SpdOperator> A;
      const Exchange                    &exchange;
      std::vector<double> inverse_columns; ///< z and Z; empty: none since factorize()
    };
  } // namespace

  std::unique_ptr<BorderedSystem>
  make_block_system(std::unique_ptr<SpdOperator> matrix,
                    const WeightForm            &form,
                    const Exchange              &exchange)
  {
    return std::make_unique<BlockSystem>(std::move(matrix), form, exchange);
  }
} // namespace Exemplar
