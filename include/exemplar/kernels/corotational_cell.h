// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_corotational_cell_h
#define exemplar_corotational_cell_h

#include <exemplar/kernels/quadratic_cell.h>
#include <exemplar/kernels/rotation_guard.h>

// The corotational model with the force that is the gradient of its energy, and the exact
// tangent. A cell's energy density is a function of S, the symmetric factor of F = R S,
// through the strain e = S - I, and of the target strain D = eta E(w):
//
//   psi = 1/2 (e - D) : C : (e - D) + (1 - phi) S : dev(C:D),        Eq. (16)
//
// where the guard phi is 1 except in badly inverted cells; dev(C:D), see elasticity.h, is 2 mu dev
// D in isotropic materials. In other materials phi also multiplies the anisotropic part, see
// grain_cell.h. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// A deformed cell: QuadraticCell with the guard of Eq. (16).
  template <typename Number, typename OfLaw = CellMaterial<Number>>
  class CorotationalCell : public QuadraticCell<Number, OfLaw>
  {
    using Quadratic = QuadraticCell<Number, OfLaw>;
    using Quadratic::e;
    using Quadratic::elastic_stress;
    using Quadratic::material;
    using Quadratic::T;

  public:
    static constexpr ModelTraits traits = { "corotational",
                                            "S - I, the deformation freed of the cell's rotation",
                                            /* has_rotations */ true,
                                            /* has_guard */ true,
                                            /* has_stretch_guard */ true,
                                            /* exact_is_rotated */ false,
                                            /* convex_is_rotated */ true,
                                            /* trace_gradient_is_R */ true,
                                            /* is_frame_indifferent */ true };

    /// e = S - I, Eq. (2).
    static Matrix3<Number>
    strain_of(const Matrix3<Number> &rotation, const Matrix3<Number> &deformation_gradient)
    {
      return corotated_strain(rotation, deformation_gradient);
    }

    template <typename Real = double>
    CorotationalCell(const OfLaw                &material,
                     const Matrix3<Number>      &rotation,
                     const Matrix3<Number>      &deformation_gradient,
                     const ExampleNumbers<Real> &examples)
        : CorotationalCell(material,
                           symmetric_part(transpose_times(rotation, deformation_gradient)),
                           Number(examples.guard_bound))
    {
    }

    /// Let the guard of the stretch use this elasticity instead of the cell's own.
    void
    set_guard_elasticity(const CellMaterial<Number> &C)
    {
      elasticity = C;
    }

    /// Add a pressure p I [Pa] of the cell's patch, Eq. (25), to the stress, after set_target(). W
    /// does not change: I commutes with S.
    void
    add_pressure(const Number &p)
    {
      for (int i = 0; i < 3; ++i)
        T[i][i] += p;
    }

    /// Whether the guard of Eq. (16) acts, for each lane.
    auto
    is_guarded() const
    {
      return phi < Number(1.);
    }

    /// Upper bound of |R^T P| / |T|.
    Number
    force_factor() const
    {
      return Number(1.);
    }

    /// Energy density of the elasticity, without target [Pa].
    Number
    elastic_density() const
    {
      const Number density = Quadratic::elastic_density();
      if constexpr (!OfLaw::is_isotropic)
        if (any(is_guarded()))
          return density + guard_energy(material, Number(1.) - phi, S, Matrix3<Number>{});
      return density;
    }

    /// psi for the target strain D, Eq. (16).
    Number
    energy(const Matrix3<Number> &D) const
    {
      const Number psi = Quadratic::energy(D);
      if (!any(is_guarded()))
        return psi;
      return psi + guard_energy(material, Number(1.) - phi, S, D);
    }

    /// Energy density 1/2 (e - e*) : C : (e - e*) of stiffness damping, without its factor s.
    Number
    damping_density(const Matrix3<Number> &past) const
    {
      return energy(past);
    }

    /// Necessary condition for the guard of the stretch to act in some lane, by the energy density
    /// of the elasticity [Pa].
    bool
    may_be_stretched(const Number &elastic_density) const
    {
      return any(elastic_density > min_density_at_kink(elasticity));
    }

    /// Whether the guard of the stretch acts in some lane.
    bool
    is_stretched() const
    {
      return StretchGuard<Number>::may_act(S, product) && stretch().acts();
    }

    /// The guard of the stretch, Eq. (24), whose energy and force are not part of energy() and
    /// force(). Computed on demand, as hardly any cell needs it.
    StretchGuard<Number>
    stretch() const
    {
      return StretchGuard<Number>(elasticity, S, product);
    }

    /// The stress -d psi / dD. The derivative of psi by a weight w_i is -eta times its contraction
    /// with E_i.
    Matrix3<Number>
    weight_stress(const Matrix3<Number> &D) const
    {
      const Matrix3<Number> T_D = this->stress_towards(D);
      if (!any(is_guarded()))
        return T_D;
      return add_guard_of_stretch(T_D, material, phi - Number(1.), S);
    }

    /// R^T P without a target and damping.
    Matrix3<Number>
    elastic_force() const
    {
      if constexpr (OfLaw::is_isotropic)
        return elastic_stress;
      CorotationalCell without_target = *this;
      without_target.set_target(Matrix3<Number>{});
      return without_target.force();
    }

    /// Prepare force() and the responses for the target strain D.
    void
    set_target(const Matrix3<Number> &D)
    {
      T = add_guard_of_target(this->stress_towards(D), material, Number(1.) - phi, e, D);
      invert_B();
      W = skew_matrix(B_inverse * axial_vector(commutator(S, T)));
      if (!any(is_guarded()))
        return;
      target      = D;
      guard_force = -guard_energy(material, phi_derivative, S, D);
    }

    /// R^T P = T + W + the guard of Eq. (16), Eq. (17), where P is the derivative of psi by F.
    Matrix3<Number>
    force() const
    {
      Matrix3<Number> P = combine(Number(1.), T, Number(1.), W);
      if (any(is_guarded()))
        P = combine(Number(1.), P, guard_force, p_derivative(S));
      return P;
    }

    const Matrix3<Number> &
    stretch_factor() const
    {
      return S;
    }

    /// (s_1+s_2)(s_2+s_3)(s_3+s_1).
    const Number &
    product_of_sums() const
    {
      return product;
    }

    /// Omega = R^T dR of Eq. (18) for R^T dF = M.
    Matrix3<Number>
    turn(const Matrix3<Number> &M) const
    {
      Matrix3<Number> difference;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          difference[i][j] = M[i][j] - M[j][i];
      return skew_matrix(B_inverse * axial_vector(difference));
    }

    /// R^T dP for R^T dF = M, Eq. (18); symmetric in M.
    Matrix3<Number>
    response(const Matrix3<Number> &M) const
    {
      const Matrix3<Number> Omega = turn(M);
      const Matrix3<Number> dS    = symmetric_part(combine(Number(1.), M, Number(-1.), Omega * S));
      const Matrix3<Number> dT    = stress(material.softened(phi), dS);
      const Matrix3<Number> right
          = combine(Number(1.), commutator(dS, T), Number(1.), commutator(S, dT));
      const Matrix3<Number> dS_W = dS * W, W_dS = W * dS;
      Matrix3<Number>       skew;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          skew[i][j] = right[i][j] - dS_W[i][j] - W_dS[i][j];
      const Matrix3<Number> dW = skew_matrix(B_inverse * axial_vector(skew));
      Matrix3<Number>       dP = combine(Number(1.), Omega * combine(Number(1.), T, Number(1.), W),
                                         Number(1.), combine(Number(1.), dT, Number(1.), dW));
      if (any(is_guarded()))
        add_response_of_guard(dS, Omega, dP);
      if (!is_stretched())
        return dP;
      const StretchGuard<Number> guard = stretch();
      return combine(Number(1.), dP, Number(1.),
                     combine(Number(1.), Omega * guard.force(), Number(1.), guard.response(dS)));
    }

    /// R^T dP for a change of the target by -E. A column of the coupling, Eq. (40), is eta times
    /// this for E = E_i.
    Matrix3<Number>
    example_response(const Matrix3<Number> &E) const
    {
      const Matrix3<Number> dT = add_guard_of_target(stress(material, E), material,
                                                     phi - Number(1.), Matrix3<Number>{}, E);
      const Matrix3<Number> dP = combine(Number(1.), dT, Number(1.),
                                         skew_matrix(B_inverse * axial_vector(commutator(S, dT))));
      if (!any(is_guarded()))
        return dP;
      const Matrix3<Number> by_target
          = add_guard_of_stretch(Matrix3<Number>{}, material, phi_derivative, S);
      return combine(Number(1.), dP, contract(by_target, E), p_derivative(S));
    }

  protected:
    /// Have another elasticity, the guard of the stretch, too. To be called before a target or damping is set; what elasticity
    /// alone makes, elastic_density() and elastic_scale(), stays that of before.
    void
    set_elasticity(const OfLaw &C)
    {
      material   = C;
      elasticity = C.isotropic_part();
    }

    /// Change of phi by a change dS of S.
    Number
    change_of_guard(const Matrix3<Number> &dS) const
    {
      return phi_derivative * contract(p_derivative(S), dS);
    }

    /// Add the terms of phi's change to response(); a separate function, because hardly any cell
    /// needs it.
    [[gnu::noinline, gnu::cold]] void
    add_response_of_guard(const Matrix3<Number> &dS,
                          const Matrix3<Number> &Omega,
                          Matrix3<Number>       &dP) const
    {
      const Matrix3<Number> by_S = p_derivative(S);
      const Number          dp   = contract(by_S, dS);
      const Matrix3<Number> of_target
          = add_guard_of_target(Matrix3<Number>{}, material, Number(1.), e, target);
      const Matrix3<Number> dT = combine(-phi_derivative * dp, of_target, Number(0.), of_target);
      const Matrix3<Number> dW = skew_matrix(B_inverse * axial_vector(commutator(S, dT)));
      const Number          d_force = -guard_energy(material, phi_second * dp, S, target)
                             - phi_derivative * contract(of_target, dS);
      // dp/dS commutes with S and so has no part in W
      const Matrix3<Number> of_force
          = combine(Number(1.), p_second_derivative(S, dS), Number(1.), Omega * by_S);
      dP = combine(Number(1.), dP, Number(1.), combine(Number(1.), dT, Number(1.), dW));
      dP = combine(Number(1.), dP, Number(1.), combine(d_force, by_S, guard_force, of_force));
    }

    CorotationalCell(const OfLaw &material, const Matrix3<Number> &S, const Number &p_0)
        : Quadratic(material, minus_identity(S)), elasticity(material.isotropic_part()), S(S)
    {
      B = combine(Number(-1.), S, Number(0.), S);
      for (int i = 0; i < 3; ++i)
        B[i][i] += trace(S);
      product               = determinant(B);
      const Guard<Number> g = guard(product, p_0);
      phi                   = g.phi;
      phi_derivative        = g.derivative;
      phi_second            = g.second;
    }

    static Matrix3<Number>
    minus_identity(Matrix3<Number> S)
    {
      for (int i = 0; i < 3; ++i)
        S[i][i] -= Number(1.);
      return S;
    }

    /// Compute B^-1; where the guard acts, with the eigenvalues s_i + s_j of B bounded below by a
    /// tiny number. In W the guard makes the numerator vanish faster than they do, in responses
    /// they determine the rotation of the cell.
    void
    invert_B()
    {
      B_inverse = inverse_of_symmetric(B);
      if (any(is_guarded()))
        B_inverse = select_matrix(is_guarded(), bounded_inverse(B, Number(1e-8)), B_inverse);
    }

    CellMaterial<Number> elasticity; ///< elasticity of the guard of the stretch
    Matrix3<Number>      S;
    Matrix3<Number>      B; ///< tr(S) I - S
    Number               phi            = Number(1.);
    Number               phi_derivative = Number(0.);
    Number               phi_second     = Number(0.);
    Matrix3<Number>      target; ///< D, set where the guard acts
    Matrix3<Number>      W;
    Matrix3<Number>      B_inverse;
    Number               guard_force;
    Number               product = Number(8.); ///< (s_1+s_2)(s_2+s_3)(s_3+s_1)
  };
} // namespace Exemplar

#endif
