// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_plastic_cell_h
#define exemplar_plastic_cell_h

#include <exemplar/kernels/corotational_cell.h>
#include <exemplar/kernels/plastic_flow.h>

// Cells with von Mises plasticity in the frame of their rotation. Examples act on the whole strain
// e = S - I, and the body, with its dissipation, has the share 1 - eta, Eq. (33):
//
//   psi = (1 - eta) psi_b(e, p) + eta/2 (e - E(w)) : C : (e - E(w)),
//   psi_b = 1/2 (e - p) : C : (e - p) + what PlasticFlow adds for hardening and flow,
//
// minimised over the trace-free plastic strain p. For this p it is the energy of CorotationalCell
// with the target eta E(w) + (1 - eta) p, up to terms without e. So forces are those of
// CorotationalCell, and the guard of Eq. (16) acts on the plastic strain as on that of examples: p
// is driven by phi times the strain. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// A deformed cell; see CorotationalCell.
  template <typename Number>
  class PlasticCell : public CorotationalCell<Number>
  {
    using Corotational = CorotationalCell<Number>;

  public:
    using Constants = PlasticConstants<Number>;

    /// History variables: p as xx, yy, yz, xz, xy; the accumulated plastic strain; the plastic
    /// work [J/m^3].
    static constexpr std::size_t n_of_strain = 5;

    static constexpr ModelTraits traits = chosen_by({ "plastic", "",
                                                      /* has_rotations */ true,
                                                      /* has_guard */ true,
                                                      /* has_stretch_guard */ true,
                                                      /* exact_is_rotated */ false,
                                                      /* convex_is_rotated */ false,
                                                      /* trace_gradient_is_R */ true,
                                                      /* is_frame_indifferent */ true,
                                                      /* n_history */ n_of_strain + 2,
                                                      /* plastic_strain */ n_of_strain,
                                                      /* dissipated */ n_of_strain + 1 },
                                                    Constants::own_constants[0].name);

    static constexpr std::array<Refusal, 7> refusals = {
      { { Beside::interpolation, " is for static and dynamic scenes: in an interpolation nothing "
                                 "pulls at the body. Set it to 0, or choose another Scene." },
        { Beside::orthotropy,
          " is for materials without orthotropy, as what yields is isotropic; fibres may go "
          "through it (Fibre stiffness). Give the two to different regions, or set {}." },
        { Beside::other_strain,
          " is for Model/Strain = corotational with Model/Gradient = consistent, whose cells know "
          "a plastic strain in their own frame. Set these two, or {}." },
        { Beside::unblended_examples,
          " with examples needs Examples/Energy = blended, in which the body has an energy of its "
          "own beside the wish to be like the examples, so that yielding does not depend on "
          "Examples/Importance. Set Examples/Energy = blended, or {}." },
        no_own_elasticity,
        { Beside::varying_importance,
          " is for bodies in which examples are equally important everywhere, as they share the "
          "energy with what yields. Set Material/Importance factor = 1, or {}." },
        { Beside::statics,
          " lets plastic strain grow in the time of a dynamic scene, but this scene is static: its "
          "increments have no length in time. Set {}, or Scene = dynamic.",
          Constants::own_constants[3].name } }
    };

    PlasticCell(const Constants        &constants,
                const Matrix3<Number>  &rotation,
                const Matrix3<Number>  &deformation_gradient,
                const ExampleConstants &examples)
        : Corotational(constants, rotation, deformation_gradient, examples), constants(constants),
          of_body(1. - examples.importance)
    {
    }

    /// Set the history at the end of the last step, load(k) being variable k, and the size of this
    /// step [s].
    template <typename Load>
    void
    remember(const Load &load, const double step_size)
    {
      const Matrix3<Number> d = driving(this->strain());
      const Number          a = load(n_of_strain);
      is_elastic = !any((abs(a) > Number(0.)) | PlasticFlow<Number>::begins(constants, d));
      if (is_elastic)
        return;
      const Number          xx = load(0), yy = load(1), yz = load(2), xz = load(3), xy = load(4);
      const Matrix3<Number> p = { { { xx, xy, xz }, { xy, yy, yz }, { xz, yz, -(xx + yy) } } };
      hardening_before        = hardening(p, a);
      work_before             = load(n_of_strain + 1);
      flow.begin(constants, d, p, a, step_size);
    }

    Number
    new_history(const std::size_t k) const
    {
      const Matrix3<Number> &p     = flow.strain();
      const Number           all[] = { p[0][0],
                                       p[1][1],
                                       p[1][2],
                                       p[0][2],
                                       p[0][1],
                                       flow.accumulated(),
                                       work_before + of_body * plastic_work() };
      return all[k];
    }

    /// Energy density of the elastic strain, 1/2 (e - p):C:(e - p) [Pa].
    Number
    elastic_density() const
    {
      if (is_elastic)
        return Corotational::elastic_density();
      return Number(0.5) * contract(stress(constants, elastic_strain()), elastic_strain());
    }

    Number
    elastic_scale() const
    {
      if (is_elastic)
        return Corotational::elastic_scale();
      return norm(stress(constants, elastic_strain()));
    }

    /// Energy density of hardening, and the potential of this step's flow [Pa].
    Number
    inelastic_density() const
    {
      if (is_elastic)
        return Number(0.);
      return of_body
             * (hardening(flow.strain(), flow.accumulated()) + flow.dissipation_potential());
    }

    Matrix3<Number>
    damp(const Matrix3<Number> &D, const Number &s, const Matrix3<Number> &past)
    {
      moved = Number(1.) + s;
      return Corotational::damp(D, s, past);
    }

    bool
    may_be_stretched(const Number & /*elastic_density*/) const
    {
      return Corotational::may_be_stretched(Corotational::elastic_density());
    }

    Matrix3<Number>
    stress_towards(const Matrix3<Number> &D) const
    {
      return Corotational::stress_towards(with_plastic(D));
    }

    /// psi for the target strain D, without damping [Pa].
    Number
    energy(const Matrix3<Number> &D) const
    {
      if (is_elastic)
        return Corotational::energy(D);
      const Matrix3<Number> &p   = flow.strain();
      const Matrix3<Number>  T_p = stress(constants, p);
      return Corotational::energy(with_plastic(D)) - of_body * contract(D, T_p)
             + Number(0.5) * of_body * (Number(1.) - of_body) * contract(p, T_p)
             + inelastic_density();
    }

    /// psi without a target [Pa].
    Number
    energy() const
    {
      return is_elastic ? Corotational::elastic_density() : energy(Matrix3<Number>{});
    }

    Matrix3<Number>
    elastic_force()
    {
      if (is_elastic)
        return Corotational::elastic_force();
      set_target(Matrix3<Number>{});
      return this->force();
    }

    void
    set_target(const Matrix3<Number> &D)
    {
      Corotational::set_target(with_plastic(D));
    }

    /// Let response() fix the rotation while p follows, nearly: the second derivative of a convex
    /// function, definite also without hardening.
    void
    make_convex()
    {
      is_convex = true;
    }

    /// R^T dP for R^T dF = M, including the change of p.
    Matrix3<Number>
    response(const Matrix3<Number> &M) const
    {
      if (is_convex)
        return convex_response(symmetric_part(M));
      const Matrix3<Number> dS = symmetric_part(
          combine(Number(1.), M, Number(-1.), this->turn(M) * this->stretch_factor()));
      Matrix3<Number> d = driving(dS);
      if (any(this->is_guarded()))
        d = combine(Number(1.), d, this->change_of_guard(dS), deviator(this->strain()));
      return combine(Number(1.), Corotational::response(M), -of_body / moved,
                     this->example_response(flow.response(d)));
    }

    Matrix3<Number>
    example_response(const Matrix3<Number> &E) const
    {
      return is_convex ? stress(this->own_material(), E) : Corotational::example_response(E);
    }

  protected:
    /// Whether make_convex() has been called.
    bool
    has_convex_tangent() const
    {
      return is_convex;
    }

  private:
    /// Fraction of the change of p in the convex tangent.
    static constexpr double convex_share = 0.9;

    Matrix3<Number>
    convex_response(const Matrix3<Number> &dS) const
    {
      const Matrix3<Number> dp = flow.response(driving(dS));
      return combine(Number(1.), stress(this->own_material(), dS),
                     Number(-2. * convex_share) * of_body * constants.mu, driving(dp));
    }

    /// The strain that drives the flow, phi dev e.
    Matrix3<Number>
    driving(const Matrix3<Number> &strain) const
    {
      const Matrix3<Number> d = deviator(strain);
      return combine(this->phi, d, Number(0.), d);
    }

    /// Energy density of hardening [Pa].
    Number
    hardening(const Matrix3<Number> &p, const Number &a) const
    {
      return Number(1. / 3.) * constants.kinematic * contract(p, p)
             + Number(0.5) * constants.isotropic * a * a;
    }

    /// Plastic work of this step [Pa].
    Number
    plastic_work() const
    {
      return hardening(flow.strain(), flow.accumulated()) - hardening_before + flow.dissipation();
    }

    Matrix3<Number>
    elastic_strain() const
    {
      return combine(Number(1.), this->strain(), Number(-1.), flow.strain());
    }

    /// The target D, for C or with damping for C (1 + s), plus the share of p.
    Matrix3<Number>
    with_plastic(const Matrix3<Number> &D) const
    {
      return combine(Number(1.), D, of_body / moved, flow.strain());
    }

    Constants           constants;               ///< without damping
    Number              of_body;                 ///< 1 - eta
    Number              moved      = Number(1.); ///< 1 + s with damping
    bool                is_elastic = true;       ///< no plastic strain, as in most cells
    bool                is_convex  = false;
    PlasticFlow<Number> flow;
    Number              hardening_before = Number(0.), work_before = Number(0.);
  };
} // namespace Exemplar

#endif
