// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/bordered_solver.h>
#include <exemplar/algebra/weight_qp.h>
#include <exemplar/base/errors.h>

#include <algorithm>
#include <numeric>

namespace Exemplar
{
  namespace
  {
    double
    dot(const double *a, const double *b, const std::size_t n)
    {
      return std::inner_product(a, a + n, b, 0.);
    }

    class BlockSolver : public BorderedSolver
    {
    public:
      explicit BlockSolver(std::unique_ptr<SpdOperator> matrix) : A(std::move(matrix)) {}

      std::string
      name() const override
      {
        return A->name();
      }

      SpdOperator *
      matrix() override
      {
        return A.get();
      }

      std::vector<double> &
      matrix_values() override
      {
        return A->values();
      }

      const dealii::FullMatrix<double> &
      schur_complement() const override
      {
        return schur;
      }

      void
      place_nodes(const dealii::Vector<double> &positions) override
      {
        A->place_nodes(positions);
      }

      void
      factorize(const WeightBlock &) override
      {
        columns.clear();
        A->factorize();
      }

      void
      solve(const WeightBlock &block, BorderedVector &vector) override
      {
        const std::size_t n = vector.positions.size(), k = vector.weights.size();

        if (columns.empty()) // z = A^-1 r_x, Z = A^-1 G
        {
          std::vector<double> all = vector.positions; // no columns if this throws
          all.insert(all.end(), block.coupling.begin(), block.coupling.end());
          A->solve(all);
          columns = std::move(all);
        }
        else // Z is still that of this factor
        {
          A->solve(vector.positions);
          std::copy(vector.positions.begin(), vector.positions.end(), columns.begin());
        }

        if (k > 0)
          solve_weights(block, vector);
        for (std::size_t i = 0; i < n; ++i)
          vector.positions[i] = columns[i];
        for (std::size_t j = 0; j < block.coupled.size(); ++j)
        {
          const double *Z_j = columns.data() + (1 + j) * n;
          for (std::size_t i = 0; i < n; ++i)
            vector.positions[i] += vector.weights[block.coupled[j]] * Z_j[i];
        }
      }

    private:
      /// The quadratic of the Schur complement H - G^T Z over the weights, Eq. (11)
      void
      solve_weights(const WeightBlock &block, BorderedVector &vector)
      {
        const std::size_t   n          = vector.positions.size();
        const auto         &index      = block.coupled;
        std::vector<double> right_side = vector.weights;
        schur                          = block.H;
        for (std::size_t i = 0; i < index.size(); ++i)
        {
          const double *G_i = block.coupling.data() + i * n;
          right_side[index[i]] += dot(G_i, columns.data(), n);
          for (std::size_t j = 0; j < index.size(); ++j)
            schur(index[i], index[j]) -= dot(G_i, columns.data() + (1 + j) * n, n);
        }
        const WeightQpSolution solution
            = minimize_over_weights(schur, right_side, vector.multipliers, block.lower);
        if (!solution.found)
          throw SolverFailure("The system for the example weights is not positive definite. Set "
                              "Examples/Weight penalty to auto, or remove an example that is a "
                              "combination of the others.");
        vector.weights     = solution.weights;
        vector.multipliers = solution.multipliers;
      }

      const std::unique_ptr<SpdOperator> A;
      dealii::FullMatrix<double>         schur;   ///< of the last solve
      std::vector<double>                columns; ///< z and Z; empty: none since factorize()
    };
  } // namespace

  std::unique_ptr<BorderedSolver>
  make_block_solver(std::unique_ptr<SpdOperator> matrix, const SymmetricPattern &pattern)
  {
    matrix->reinit(pattern);
    return make_block_solver(std::move(matrix));
  }

  std::unique_ptr<BorderedSolver>
  make_block_solver(std::unique_ptr<SpdOperator> matrix)
  {
    return std::make_unique<BlockSolver>(std::move(matrix));
  }
} // namespace Exemplar
