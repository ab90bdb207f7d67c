// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_neo_hookean_cell_h
#define exemplar_neo_hookean_cell_h

#include <exemplar/kernels/corotational_cell.h>
#include <exemplar/kernels/lanes.h>

#include <cmath>

// Cells whose body has the stable neo-Hookean energy of Smith, de Goes and Kim (2018), Eqs. (34)
// and (35). Examples act on the strain e = S - I as in CorotationalCell:
//
//   psi = (1 - eta) psi_b(F) + eta/2 (e - E(w)) : C : (e - E(w)),
//   psi_b = mu_S/2 (I_C - 3) + lambda_S/2 (J - J_0)^2 - mu_S/2 log(I_C + 1) + const,
//
// mu_S = 4/3 mu, lambda_S = lambda + 5/6 mu, J_0 = 1 + mu / lambda_S, so that psi_b is 1/2 e:C:e
// near the rest pose. The convex tangent is that of CorotationalCell. In patches, Eq. (37), cells
// have the same psi_b of lambda = 0 and a pressure along cof F. No deal.II header here: see
// matrix3.h.

namespace Exemplar
{
  /// x - log(1 + x) for each lane, x > -1, without cancellation near 0.
  template <typename Number>
  Number
  beyond_logarithm(const Number &x)
  {
    alignas(64) double lane[Lanes<Number>::n];
    Lanes<Number>::store(x, lane);
    for (double &value : lane)
      value -= std::log1p(value);
    return Lanes<Number>::load(lane);
  }

  /// J - 1 for the strain e = S - I, without cancellation near 0.
  template <typename Number>
  Number
  volume_change(const Matrix3<Number> &e)
  {
    const Number tr = trace(e);
    return tr + Number(0.5) * (tr * tr - contract(e, e)) + determinant(e);
  }

  /// psi_b and its derivatives in the frame of the rotation, where F = S.
  template <typename Number>
  class NeoHookean
  {
  public:
    NeoHookean(const CellMaterial<Number> &material,
               const Matrix3<Number>      &S,
               const Matrix3<Number>      &e)
        : mu(material.mu), lambda_S(material.lambda + Number(5. / 6.) * material.mu), S(S),
          cof(cofactors(S)), square(contract(e, e)), tr(trace(e)), det(determinant(e)),
          i(Number(2.) * tr + square), j(tr + Number(0.5) * (tr * tr - square) + det)
    {
    }

    /// Add p cof F to P; density() does not change [Pa].
    void
    add_pressure(const Number &p)
    {
      pressure += p;
    }

    /// psi_b [Pa], 0 at rest, in terms of e: the sum in terms of F would suffer from cancellation
    /// there.
    Number
    density() const
    {
      return mu * (square - Number(0.5) * tr * tr - det) + Number(0.5) * lambda_S * j * j
             + Number(2. / 3.) * mu * beyond_logarithm(Number(0.25) * i);
    }

    /// R^T P; symmetric.
    Matrix3<Number>
    force() const
    {
      return combine(of_S(), S, of_cof(), cof);
    }

    /// R^T dP for R^T dF = M.
    Matrix3<Number>
    response(const Matrix3<Number> &M) const
    {
      const Number    inverse = Number(1.) / (Number(4.) + i);
      const Number    d_S     = Number(8. / 3.) * mu * inverse * inverse * contract(S, M);
      const Number    d_cof   = lambda_S * contract(cof, M);
      Matrix3<Number> change;
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l)
        {
          const int p = (k + 1) % 3, q = (k + 2) % 3, r = (l + 1) % 3, s = (l + 2) % 3;
          change[k][l]
              = S[p][r] * M[q][s] + M[p][r] * S[q][s] - S[p][s] * M[q][r] - M[p][s] * S[q][r];
        }
      return combine(Number(1.), combine(of_S(), M, of_cof(), change), Number(1.),
                     combine(d_S, S, d_cof, cof));
    }

  private:
    Number
    of_S() const
    {
      return Number(4. / 3.) * mu * (Number(3.) + i) / (Number(4.) + i);
    }

    Number
    of_cof() const
    {
      return lambda_S * j - mu + pressure;
    }

    Number          mu, lambda_S;
    Matrix3<Number> S, cof;
    Number          square, tr, det; ///< invariants of e: |e|^2, tr e, det e
    Number          i, j;            ///< I_C - 3, J - 1
    Number          pressure = Number(0.);
  };

  /// A deformed cell; CorotationalCell provides all that depends on the weights.
  template <typename Number>
  class NeoHookeanCell : public CorotationalCell<Number>
  {
    using Corotational = CorotationalCell<Number>;

  public:
    static constexpr ModelTraits traits = { "neo-hookean",
                                            "",
                                            /* has_rotations */ true,
                                            /* has_guard */ true,
                                            /* has_stretch_guard */ false,
                                            /* exact_is_rotated */ false,
                                            /* convex_is_rotated */ true,
                                            /* trace_gradient_is_R */ true,
                                            /* is_frame_indifferent */ true,
                                            /* n_history */ 0,
                                            ModelTraits::not_remembered,
                                            ModelTraits::not_remembered,
                                            /* has_volumetric_energy */ true };

    static constexpr std::array<Refusal, 7> refusals
        = { { { Beside::other_strain, " is for Model/Strain = corotational with Model/Gradient = "
                                      "consistent. Set these two, or {}." },
              { Beside::interpolation, " is for static and dynamic scenes: in an interpolation "
                                       "examples alone act. Choose another Scene, or set {}." },
              { Beside::grain, " is for isotropic materials. Remove the fibres (Material/Fibre "
                               "stiffness = 0, Orthotropy empty), or set {}." },
              { Beside::memory, " is for elastic materials. Set Material/Yield stress = 0 and "
                                "Relaxation time = 0, or set {}." },
              { Beside::unblended_examples,
                " with examples needs Examples/Energy = blended, in which the body has an energy "
                "of its own beside the wish to be like the examples. Set that, or set {}." },
              no_own_elasticity,
              { Beside::varying_importance,
                " is for bodies in which examples are equally important everywhere. Set "
                "Material/Importance factor = 1, or set {}." } } };

    template <typename Real = double>
    NeoHookeanCell(const CellMaterial<Number> &material,
                   const Matrix3<Number>      &rotation,
                   const Matrix3<Number>      &deformation_gradient,
                   const ExampleNumbers<Real> &of_examples)
        : Corotational(material, rotation, deformation_gradient, of_examples),
          examples{ Number(of_examples.guard_bound), Number(of_examples.importance) },
          body(material, this->stretch_factor(), this->strain()),
          attractor(attractor_of(examples.importance))
    {
    }

    /// Add the stress p cof F [Pa] of the patch's mean of J, Eq. (37), to that of psi_b.
    void
    add_volume_pressure(const Number &p)
    {
      body.add_pressure(p);
    }

    /// Add the pressure of the patch's mean dilatation, Eq. (25), to the examples' part.
    void
    add_pressure(const Number &p)
    {
      attractor.add_pressure(p);
    }

    Matrix3<Number>
    turn(const Matrix3<Number> &M) const
    {
      return attractor.turn(M);
    }

    /// psi_b [Pa].
    Number
    elastic_density() const
    {
      return body.density();
    }

    Number
    elastic_scale() const
    {
      return norm(body.force());
    }

    Matrix3<Number>
    damp(const Matrix3<Number> &D, const Number &s, const Matrix3<Number> &past)
    {
      share     = examples.importance + s;
      moved     = Number(1.) + s;
      attractor = attractor_of(share);
      return damped_target(D, s, past);
    }

    bool
    may_be_stretched(const Number & /*elastic_density*/) const
    {
      return attractor.may_be_stretched(attractor.elastic_density());
    }

    bool
    is_stretched() const
    {
      return attractor.is_stretched();
    }

    StretchGuard<Number>
    stretch() const
    {
      return attractor.stretch();
    }

    /// The derivative of psi by S without guards [Pa].
    Matrix3<Number>
    stress_towards(const Matrix3<Number> &D) const
    {
      return combine(Number(1.), Corotational::stress_towards(D), of_body(),
                     combine(Number(1.), body.force(), Number(-1.),
                             stress(this->own_material(), this->strain())));
    }

    Number
    energy(const Matrix3<Number> &D) const
    {
      return Corotational::energy(D)
             + of_body() * (body.density() - Corotational::elastic_density());
    }

    Matrix3<Number>
    elastic_force() const
    {
      return body.force();
    }

    void
    set_target(const Matrix3<Number> &D)
    {
      attractor.set_target(combine(of_target(), D, Number(0.), D));
    }

    Matrix3<Number>
    force() const
    {
      return combine(of_body(), body.force(), Number(1.), attractor.force());
    }

    Matrix3<Number>
    response(const Matrix3<Number> &M) const
    {
      return combine(of_body(), body.response(M), Number(1.), attractor.response(M));
    }

    Matrix3<Number>
    example_response(const Matrix3<Number> &E) const
    {
      return attractor.example_response(combine(of_target(), E, Number(0.), E));
    }

  private:
    /// The examples' part as a corotational cell with elasticity `share` C: its energy is eta/2
    /// (e - E):C:(e - E) for the target E = D / eta.
    Corotational
    attractor_of(const Number &share) const
    {
      Corotational cell(this->own_material().scaled(share), identity_matrix<Number>(),
                        this->stretch_factor(), examples);
      cell.set_guard_elasticity(this->own_material().scaled(examples.importance));
      return cell;
    }

    Number
    of_body() const
    {
      return Number(1.) - examples.importance;
    }

    /// Ratio of the attractor's target to that of a cell with elasticity C (1 + s).
    Number
    of_target() const
    {
      return select(share > Number(0.), moved / share, Number(0.));
    }

    ExampleNumbers<Number> examples;
    Number                 share = examples.importance; ///< eta, with damping eta + s
    Number                 moved = Number(1.);          ///< 1 + s
    NeoHookean<Number>     body;
    Corotational           attractor;
  };
} // namespace Exemplar

#endif
