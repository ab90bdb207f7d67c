// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_bordered_system_h
#define exemplar_bordered_system_h

#include <exemplar/algebra/spd_operator.h>
#include <exemplar/algebra/weight_limits.h>

#include <deal.II/lac/full_matrix.h>

#include <memory>
#include <vector>

namespace Exemplar
{
  /// The quadratic form of k weights and the m linear constraints on them. The weights are m groups
  /// of k/m consecutive ones, and row g of N has ones at the weights of group g. Without constraints m
  /// is 0.
  struct WeightForm
  {
    dealii::FullMatrix<double> H;       ///< k x k
    dealii::FullMatrix<double> N;       ///< m x k
    std::vector<unsigned int>  coupled; ///< weights with a non-zero column of G, ascending

    /// Summands of the diagonal of H for a step in directions along which H less what positions follow is not convex;
    /// empty: none.
    std::vector<double> convexity;
  };

  /// A vector of the bordered system: a right side or a solution, in three parts.
  struct BorderedVector
  {
    std::vector<double> positions;   ///< free degrees of freedom
    std::vector<double> weights;     ///< k
    std::vector<double> multipliers; ///< m
  };

  /// The linear system of a step, Eq. (10):
  ///
  ///     [  A    -G    0  ] [ dx ]   [ r_x ]
  ///     [ -G^T   H   N^T ] [ dw ] = [ r_w ]
  ///     [  0     N    0  ] [ l  ]   [ r_c ]
  ///
  /// Without unknown weights the form is empty, and A is the whole system.
  class BorderedSystem
  {
  public:
    virtual ~BorderedSystem() = default;

    /// Traits of the operator A.
    virtual OperatorTraits
    traits() const = 0;

    /// Have another pattern of A with the same unknowns. Throws as SpdOperator::reinit().
    virtual void
    reinit(const SymmetricPattern &pattern)
        = 0;

    /// The values of A on its pattern, to be overwritten before factorize().
    virtual std::vector<double> &
    matrix_values()
        = 0;

    /// Further summand of A, as SpdOperator::outer_products().
    virtual OuterProducts *
    outer_products()
    {
      return nullptr;
    }

    /// The shear of the unknowns, as SpdOperator::shear(). Columns and vectors are by the unknowns of A. Null with UMFPACK, too, which no
    /// body that shears them takes: it has no fixed point.
    virtual UnknownShear *
    shear()
    {
      return nullptr;
    }

    /// The non-zero columns of G, one after the other, to be overwritten before factorize() and not
    /// changed until the next one.
    std::vector<double> &
    columns()
    {
      return G;
    }

    const std::vector<double> &
    columns() const
    {
      return G;
    }

    /// The form of the weights; empty without unknown weights.
    const WeightForm &
    weight_form() const
    {
      return form;
    }

    /// Prepare for solve(). `positions` as for SpdOperator::factorize(). Throws SolverFailure if A
    /// is not positive definite.
    virtual void
    factorize(const Vector &positions)
        = 0;

    /// Factorize to a few digits, as SpdOperator::factorize_roughly().
    virtual void
    factorize_roughly(const Vector &positions)
    {
      factorize(positions);
    }

    /// Factorize a matrix that has changed little, as SpdOperator::factorize_near().
    virtual void
    factorize_near(const Vector &positions)
    {
      factorize(positions);
    }

    /// As SpdOperator::leans_on_earlier().
    virtual bool
    leans_on_earlier() const
    {
      return false;
    }

    /// Overwrite the right side by the solution, with changes of weights within `limits`. Throws
    /// SolverFailure if the system is singular. `accuracy` as in SpdOperator::solve(); with weights to find, which need
    /// differences of solutions, it is not used.
    virtual void
    solve(BorderedVector &right_side, const WeightLimits &limits, double accuracy = 0.)
        = 0;

    /// Whether solve() can be had to a smaller accuracy.
    virtual bool
    iterates() const
    {
      return false;
    }

    /// Overwrite columns C by A^-1 C; throws SolverFailure if A has no factor of its own.
    virtual void
    apply_inverse(std::vector<double> &columns)
        = 0;

    /// Compute the columns Z = A^-1 G now, instead of in the first solve(). As there they are
    /// solved for together with one right side, because the order of BLAS's sums depends on the
    /// number of columns.
    virtual void
    prepare()
    {
    }

    /// An independent system of the same structure, as SpdOperator::twin().
    virtual std::unique_ptr<BorderedSystem>
    twin() const
    {
      return nullptr;
    }

    /// An approximate inverse of A that stays, as SpdOperator::keep().
    virtual std::unique_ptr<KeptInverse>
    keep() const = 0;

    /// The Schur complement H - G^T Z of the last solve(); empty if there was none.
    const dealii::FullMatrix<double> &
    schur_complement() const
    {
      return schur;
    }

  protected:
    explicit BorderedSystem(const WeightForm &form) : form(form) {}

    const WeightForm          &form;
    std::vector<double>        G;
    dealii::FullMatrix<double> schur;
  };

  /// H - G^T Z, Eq. (11). Columns of G and Z have n entries in this process; sums are over all
  /// processes.
  dealii::FullMatrix<double>
  make_schur_complement(const WeightForm          &form,
                        const std::vector<double> &G,
                        const double              *Z,
                        std::size_t                n,
                        const Exchange            &exchange);

  /// Block elimination: one solve for A^-1 [r_x, G], then the dense Schur complement bordered by N.
  /// `matrix` has its pattern; `form` and `exchange` must outlive the system.
  std::unique_ptr<BorderedSystem>
  make_block_system(std::unique_ptr<SpdOperator> matrix,
                    const WeightForm            &form,
                    const Exchange              &exchange);

  /// The bordered matrix factorised as a whole by UMFPACK; for checking. `form` must outlive the
  /// system.
  std::unique_ptr<BorderedSystem>
  make_umfpack_system(const SymmetricPattern &pattern, const WeightForm &form);
} // namespace Exemplar

#endif
