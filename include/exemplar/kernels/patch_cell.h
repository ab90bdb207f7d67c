// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_patch_cell_h
#define exemplar_patch_cell_h

#include <exemplar/kernels/corotational_cell.h>

// Terms of patches, Eq. (25), in thin cells and in strongly stretched patches, both of which are
// rare. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// Lower bound of the mean |F|^2 beyond which a patch is strongly stretched, beta > 0 in
  /// Eq. (26). |F|^2 = 3 at rest; for every Poisson's ratio the guard of a cell begins beyond 6.76,
  /// which is where beta reaches 1 for the least bound.
  constexpr double min_stretched_square = 5.;

  /// Necessary condition for y < y_0 by tr S and |F|^2 alone: with I_2 = (tr^2 S - |F|^2) / 2 the
  /// product p = tr S I_2 - det F is at least 8/9 tr S I_2 if that is positive, as the inequality
  /// of arithmetic and geometric means bounds det F.
  template <typename Number>
  auto
  may_be_thin(const Number &trace_of_S, const Number &square)
  {
    return Number(4. / 9.) * trace_of_S * (trace_of_S * trace_of_S - square)
           < Number(NearKink<Number>::y_0) * square;
  }

  /// The extended trace tr S + r(y) of thin cells, Eq. (25). Where the two least stretches nearly
  /// cancel, y < y_0 of Eq. (24), tr S has a kink like |s_2 + s_3|, and a patch that pulls with
  /// more than 2 mu would make it a minimum at which no gradient vanishes. The kink of r cancels
  /// it.
  template <typename Number>
  class ThinTrace
  {
  public:
    /// `p` is the product of the sums of two eigenvalues of S.
    ThinTrace(const Matrix3<Number> &S, const Number &p) : S(S)
    {
      const Number square  = contract(S, S);
      const auto   is_thin = p < Number(y_0) * square;
      any_thin             = any(is_thin);
      const Number u       = select(is_thin, square, Number(1.));
      norm                 = sqrt(u);
      y                    = select(is_thin, p / u, Number(y_0)); // where r and r' are 0
      r                    = NearKink<Number>(y);
      y_derivative         = y_derivative_of(S, y, u);
    }

    /// The trace of S = I + `strain`.
    static ThinTrace
    of_strain(const Matrix3<Number> &strain)
    {
      Matrix3<Number> S = strain;
      for (int i = 0; i < 3; ++i)
        S[i][i] += Number(1.);
      Matrix3<Number> B = combine(Number(-1.), S, Number(0.), S);
      for (int i = 0; i < 3; ++i)
        B[i][i] += trace(S);
      return ThinTrace(S, determinant(B));
    }

    /// Whether y < y_0 in some lane.
    bool
    acts() const
    {
      return any_thin;
    }

    /// The supplement r(y).
    const Number &
    supplement() const
    {
      return r.value;
    }

    /// R^T dr/dF, for the supplement r.
    Matrix3<Number>
    gradient() const
    {
      return combine(r.first, y_derivative, Number(0.), y_derivative);
    }

    /// The change of gradient() with S, and with R by Omega = R^T dR.
    Matrix3<Number>
    response(const Matrix3<Number> &dS, const Matrix3<Number> &Omega) const
    {
      const Number          dy     = contract(y_derivative, dS);
      const Matrix3<Number> change = combine(
          r.first, y_second_derivative(S, y, norm, y_derivative, dS), r.second * dy, y_derivative);
      return combine(Number(1.), change, r.first, Omega * y_derivative);
    }

  private:
    static constexpr double y_0 = NearKink<Number>::y_0;

    Matrix3<Number>  S;
    bool             any_thin;
    Number           norm; ///< |F|
    Number           y;
    NearKink<Number> r;
    Matrix3<Number>  y_derivative;
  };

  /// Parameters of a strongly stretched patch in one of its cells, Eq. (26): the energy of the
  /// patch includes beta(m_p) Xi.
  template <typename Number>
  struct StretchedPatch
  {
    Number               beta;
    Number               by_F;       ///< factor of F in the stress from the derivative of beta [Pa]
    Number               stiffness;  ///< beta lambda_p [Pa]
    CellMaterial<Number> elasticity; ///< elasticity of the guard Gamma
  };

  /// Terms of patches in the stress of a cell, beside their pressure, and in its tangent. They depend
  /// on its deformation, not on its law.
  template <typename Number>
  class PatchCell
  {
  public:
    PatchCell(const Matrix3<Number>        &rotation,
              const Matrix3<Number>        &deformation_gradient,
              const ExampleConstants       &examples,
              const StretchedPatch<Number> &patch)
        : cell(turning_cell(rotation, deformation_gradient, examples)),
          thin(cell.stretch_factor(), cell.product_of_sums()),
          guard(patch.elasticity, cell.stretch_factor(), cell.product_of_sums()), patch(patch)
    {
    }

    const ThinTrace<Number> &
    get_thin() const
    {
      return thin;
    }

    /// The guard's energy density Gamma [Pa], Eq. (24).
    Number
    guard_energy() const
    {
      return guard.energy_or_zero();
    }

    /// R^T dG/dF [Pa].
    Matrix3<Number>
    guard_force() const
    {
      return guard.acts() ? guard.force() : Matrix3<Number>{};
    }

    /// R^T P for R^T F = M and the pressure of the cell.
    Matrix3<Number>
    force(const Matrix3<Number> &M, const Number &pressure) const
    {
      return combine(Number(1.), combine(pressure, thin.gradient(), patch.beta, guard_force()),
                     patch.by_F, M);
    }

    /// R^T dP for R^T dF = M, without the rotation of R in the pressure's part and the terms that
    /// couple all nodes of the patch; the convex one lacks terms that may make it indefinite.
    Matrix3<Number>
    response(const Matrix3<Number> &M, const Number &pressure, const bool convex) const
    {
      Matrix3<Number> of_trace = thin.gradient();
      for (int i = 0; i < 3; ++i)
        of_trace[i][i] += Number(1.);
      Matrix3<Number> dP
          = combine(patch.by_F, M, patch.stiffness * contract(of_trace, M), of_trace);
      if (convex)
        return dP;
      const Matrix3<Number> Omega = cell.turn(M);
      const Matrix3<Number> dS
          = symmetric_part(combine(Number(1.), M, Number(-1.), Omega * cell.stretch_factor()));
      if (thin.acts())
        dP = combine(Number(1.), dP, pressure, thin.response(dS, Omega));
      if (guard.acts())
        dP = combine(Number(1.), dP, patch.beta,
                     combine(Number(1.), Omega * guard.force(), Number(1.), guard.response(dS)));
      return dP;
    }

  private:
    /// A cell without elasticity, which knows how its rotation follows F.
    static CorotationalCell<Number>
    turning_cell(const Matrix3<Number>  &rotation,
                 const Matrix3<Number>  &deformation_gradient,
                 const ExampleConstants &examples)
    {
      CorotationalCell<Number> cell({ Number(0.), Number(0.) }, rotation, deformation_gradient,
                                    examples);
      cell.set_target(Matrix3<Number>{});
      return cell;
    }

    CorotationalCell<Number> cell;
    ThinTrace<Number>        thin;
    StretchGuard<Number>     guard;
    StretchedPatch<Number>   patch;
  };
} // namespace Exemplar

#endif
