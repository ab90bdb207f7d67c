// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/posing/fold_system.h>

#include <deal.II/lac/solver_cg.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// Relative tolerance and greatest number of iterations of conjugate gradients; a direction for
    /// a line search needs no better.
    constexpr double       cg_tolerance   = 1e-2;
    constexpr unsigned int max_iterations = 30;

    /// A symmetric matrix, given by its lower triangle, plus the Hessian of the skin's springs.
    struct MatrixWithSprings
    {
      const SymmetricPattern    &pattern;
      const std::vector<double> &values;
      const SkinSprings         &springs;

      void
      vmult(Vector &product, const Vector &vector) const
      {
        product = 0.;
        for (unsigned int j = 0; j < pattern.n(); ++j)
        {
          int p = pattern.column_start[j];
          product[j] += values[p] * vector[j];
          for (++p; p < pattern.column_start[j + 1]; ++p)
          {
            product[pattern.row[p]] += values[p] * vector[j];
            product[j] += values[p] * vector[pattern.row[p]];
          }
        }
        springs.add_product(vector, product);
      }
    };

    struct Inverse
    {
      SpdOperator &system;

      void
      vmult(Vector &product, const Vector &vector) const
      {
        std::vector<double> column(vector.begin(), vector.end());
        system.solve(column);
        std::copy(column.begin(), column.end(), product.begin());
      }
    };
  } // namespace

  FoldSystem::FoldSystem(const FoldPotential &potential)
      : potential(potential), system(make_cholesky_operator(potential.get_n_threads())),
        pattern(potential.block_pattern())
  {
    system->reinit(pattern);
  }

  void
  FoldSystem::factorize(const FoldPotential::Points &x, const double eps)
  {
    potential.assemble(x, eps, system->values());
    if (!potential.skin.empty())
    {
      without_skin                    = system->values();
      const std::vector<double> bound = potential.skin.diagonal_bound(x.size());
      for (unsigned int k = 0; k < pattern.n(); ++k)
        system->values()[pattern.column_start[k]] += bound[k / 3];
    }
    factorize_shifted();
  }

  /// Factorizes the matrix, with growing shifts of its diagonal if need be: it is positive, but
  /// nearly collapsed cells may be so stiff that rounding makes pivots negative.
  void
  FoldSystem::factorize_shifted()
  {
    const std::vector<double> values = system->values();
    for (double shift = 1e-14; shift < 1.; shift *= 100.)
      try
      {
        system->factorize({});
        return;
      }
      catch (const SolverFailure &)
      {
        for (unsigned int k = 0; k < pattern.n(); ++k)
          system->values()[pattern.column_start[k]]
              = (1. + shift) * values[pattern.column_start[k]];
      }
    throw indefinite_matrix();
  }

  std::vector<double>
  FoldSystem::solve(const std::vector<double> &right_side) const
  {
    std::vector<double> solution = right_side;
    if (potential.skin.empty())
    {
      system->solve(solution);
      return solution;
    }
    Vector                         b(right_side.begin(), right_side.end()), x(right_side.size());
    dealii::IterationNumberControl control(max_iterations, cg_tolerance * b.l2_norm());
    dealii::SolverCG<Vector>       cg(control);
    cg.solve(MatrixWithSprings{ pattern, without_skin, potential.skin }, x, b, Inverse{ *system });
    std::copy(x.begin(), x.end(), solution.begin());
    return solution;
  }
} // namespace Exemplar
