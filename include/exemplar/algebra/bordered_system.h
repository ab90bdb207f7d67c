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
  /// The quadratic form of k weights, what couples them to the positions, and the m linear
  /// constraints on them. They are m groups of k/m consecutive weights, and N has a row a group,
  /// of ones where the weights are the group's.
  struct WeightForm
  {
    dealii::FullMatrix<double> H;       ///< k x k
    dealii::FullMatrix<double> N;       ///< m x k
    std::vector<unsigned int>  coupled; ///< the weights whose column of G is not zero, ascending
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
  /// Without weights to find the form is empty, and only A is there.
  class BorderedSystem
  {
  public:
    virtual ~BorderedSystem() = default;

    /// Of A.
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

    /// As SpdOperator::outer_products().
    virtual OuterProducts *
    outer_products()
    {
      return nullptr;
    }

    /// The columns of G of the coupled weights, one after the other, to be overwritten before
    /// factorize() and left as they are until the next.
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

    /// The weights' part; empty without weights to find.
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

    /// As SpdOperator::factorize_roughly().
    virtual void
    factorize_roughly(const Vector &positions)
    {
      factorize(positions);
    }

    /// Overwrite the right side by the solution, with changes of the weights as these limits leave
    /// them. Throws SolverFailure if the system is singular.
    virtual void
    solve(BorderedVector &right_side, const WeightLimits &limits)
        = 0;

    /// Overwrite columns by A^-1 times them; throws SolverFailure if there is no factor of A alone.
    virtual void
    apply_inverse(std::vector<double> &columns)
        = 0;

    /// Do now what else the first solve() would do: to find the columns Z = A^-1 G. They are found
    /// beside one right side, as there, because the number of columns decides in which order BLAS
    /// sums.
    virtual void
    prepare()
    {
    }

    /// As SpdOperator::twin().
    virtual std::unique_ptr<BorderedSystem>
    twin() const
    {
      return nullptr;
    }

    /// As SpdOperator::keep().
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

  /// H - G^T Z, Eq. (11), with n entries of this process in each column.
  dealii::FullMatrix<double>
  make_schur_complement(const WeightForm          &form,
                        const std::vector<double> &G,
                        const double              *Z,
                        std::size_t                n,
                        const Exchange            &exchange);

  /// Block elimination: one call for A^-1 [r_x, G], then the dense Schur complement bordered by N.
  /// `matrix` has its pattern; `form` and `exchange` must outlive the system.
  std::unique_ptr<BorderedSystem>
  make_block_system(std::unique_ptr<SpdOperator> matrix,
                    const WeightForm            &form,
                    const Exchange              &exchange);

  /// The whole bordered matrix at once by UMFPACK; for checking. `form` must outlive the system.
  std::unique_ptr<BorderedSystem>
  make_umfpack_system(const SymmetricPattern &pattern, const WeightForm &form);
} // namespace Exemplar

#endif
