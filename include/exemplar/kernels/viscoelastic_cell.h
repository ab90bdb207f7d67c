// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_viscoelastic_cell_h
#define exemplar_viscoelastic_cell_h

#include <exemplar/kernels/corotational_cell.h>

#include <array>

// Cells that relax: a spring of the share r of the shear modulus is in series with a dashpot of the relaxation time tau
// (a Maxwell branch in the frame of the cell's rotation), beside what is left of the elasticity, C_inf with the bulk modulus
// of C and the shear modulus (1 - r) mu, with which examples act. After a step of length h from the branch's strain q_n,
//
//   psi = 1/2 (e - D) : C_inf : (e - D) + r mu (1 - f) |dev e - q_n|^2,  f = h / (tau + h),
//   q_{n+1} = q_n + f (dev e - q_n),                                                        Eq. (41)
//
// which is the energy of CorotationalCell with C_t : E = C_inf : E + 2 r mu (1 - f) dev E and the target D_t of C_t : D_t =
// C_inf : D + 2 r mu (1 - f) q_n, up to terms without e. Without a step f = 0: the branch is a spring; in statics f = 1: it is
// relaxed. The guard of Eq. (16) holds D_t. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// tau and r, beside Lamé's constants of C.
  template <typename Number>
  struct ViscoelasticConstants : Isotropic<Number>
  {
    static constexpr std::size_t n_numbers = 4;

    static constexpr std::array<LawConstant, 2> own_constants
        = { { { "Relaxation time",
                "tau [s]: after it 63 % of what relaxes of the stress of a strain that is held has "
                "gone. Young's modulus and Poisson's ratio are those of fast motions. 0: the "
                "material is elastic.",
                0. },
              { "Relaxing share",
                "r [-]: this part of the shear modulus relaxes. Where there is a Relaxation time.",
                0.5, 0., 0.999 } } };

    Number tau, share;

    template <typename Load>
    static ViscoelasticConstants
    from_numbers(const Load &load)
    {
      return { { load(0), load(1) }, load(2), load(3) };
    }

    /// The elasticity of which the part f of the branch has relaxed: with the bulk modulus of C.
    Isotropic<Number>
    relaxed(const Number &f) const
    {
      const Number gone = f * share * this->mu;
      return { this->lambda + Number(2. / 3.) * gone, this->mu - gone };
    }
  };

  /// C_inf:E [Pa], with which examples act.
  template <typename Number>
  Matrix3<Number>
  stress(const ViscoelasticConstants<Number> &material, const Matrix3<Number> &E)
  {
    return stress(material.relaxed(Number(1.)), E);
  }

  /// A deformed cell; see CorotationalCell.
  template <typename Number>
  class ViscoelasticCell : public CorotationalCell<Number>
  {
    using Corotational = CorotationalCell<Number>;

  public:
    using Constants = ViscoelasticConstants<Number>;

    /// q by xx, yy, yz, xz, xy; what the dashpot has dissipated [J/m^3].
    static constexpr std::size_t n_of_strain = 5;

    static constexpr ModelTraits traits
        = chosen_by({ "viscoelastic", "",
                      /* has_rotations */ true,
                      /* has_guard */ true,
                      /* has_stretch_guard */ true,
                      /* exact_is_rotated */ false,
                      /* convex_is_rotated */ false,
                      /* trace_gradient_is_R */ true,
                      /* is_frame_indifferent */ true,
                      /* n_history */ n_of_strain + 1, ModelTraits::not_remembered,
                      /* dissipated */ n_of_strain },
                    Constants::own_constants[0].name);

    static constexpr std::array<Refusal, 6> refusals = {
      { { Beside::interpolation,
          " is for static and dynamic scenes: an interpolation has no time in which anything "
          "relaxes. Set it to 0, or choose another Scene." },
        { Beside::fibres,
          " is for materials without fibres. Give the two to different regions, or set {}." },
        { Beside::orthotropy,
          " is for materials without orthotropy. Give the two to different regions, or set {}." },
        { Beside::other_memory,
          " is for materials that do not yield. Give the two to different regions, or set {}." },
        { Beside::other_strain,
          " is for Model/Strain = corotational with Model/Gradient = consistent, whose cells know "
          "the strain that has relaxed in their own frame. Set these two, or {}." },
        no_own_elasticity }
    };

    ViscoelasticCell(const Constants        &constants,
                     const Matrix3<Number>  &rotation,
                     const Matrix3<Number>  &deformation_gradient,
                     const ExampleConstants &examples)
        : Corotational(constants, rotation, deformation_gradient, examples), constants(constants),
          equilibrium(constants.relaxed(Number(1.)))
    {
    }

    /// What the last step left, of which load(k) is a number, and the size of this one [s].
    template <typename Load>
    void
    remember(const Load &load, const double step_size)
    {
      const Number xx = load(0), yy = load(1), yz = load(2), xz = load(3), xy = load(4);
      q           = { { { xx, xy, xz }, { xy, yy, yz }, { xz, yz, -(xx + yy) } } };
      work_before = load(n_of_strain);
      if (step_size > 0.)
        f = Number(1.) / (Number(1.) + constants.tau * Number(1. / step_size));
      this->set_elasticity(constants.relaxed(f));
    }

    Number
    new_history(const std::size_t k) const
    {
      const Matrix3<Number> way = branch_strain();
      const Number          all[]
          = { q[0][0] + f * way[0][0], q[1][1] + f * way[1][1],
              q[1][2] + f * way[1][2], q[0][2] + f * way[0][2],
              q[0][1] + f * way[0][1], work_before + Number(2.) * f * branch_density() };
      return all[k];
    }

    /// What springs hold: 1/2 e:C_inf:e, and that of the branch at the end of the step [Pa].
    Number
    elastic_density() const
    {
      return Number(0.5) * contract(stress(equilibrium, this->strain()), this->strain())
             + (Number(1.) - f) * branch_density();
    }

    Number
    elastic_scale() const
    {
      return norm(stress(this->own_material(), this->strain()));
    }

    /// Half of what the dashpot dissipates in this step, its potential [Pa].
    Number
    inelastic_density() const
    {
      return f * branch_density();
    }

    bool
    may_be_stretched(const Number & /*elastic_density*/) const
    {
      return Corotational::may_be_stretched(Corotational::elastic_density());
    }

    /// The energy of all; without damping.
    Number
    energy(const Matrix3<Number> &D) const
    {
      const Matrix3<Number> deviation = combine(Number(1.), this->strain(), Number(-1.), D);
      const Number          psi
          = Number(0.5) * contract(stress(equilibrium, deviation), deviation) + branch_density();
      if (!any(this->is_guarded()))
        return psi;
      return psi
             + guard_energy(this->own_material(), Number(1.) - this->phi, this->stretch_factor(),
                            target_of_step(D));
    }

    /// The energy without a target.
    Number
    energy() const
    {
      return energy(Matrix3<Number>{});
    }

    /// -d psi / dD, with which C_inf alone acts.
    Matrix3<Number>
    weight_stress(const Matrix3<Number> &D) const
    {
      const Matrix3<Number> T
          = stress(equilibrium, combine(Number(1.), this->strain(), Number(-1.), D));
      if (!any(this->is_guarded()))
        return T;
      return add_guard_of_stretch(T, equilibrium, this->phi - Number(1.), this->stretch_factor());
    }

    Matrix3<Number>
    damp(const Matrix3<Number> &D, const Number &s, const Matrix3<Number> &past)
    {
      is_damped = true;
      return Corotational::damp(target_of_step(D), s, past);
    }

    Matrix3<Number>
    stress_towards(const Matrix3<Number> &D) const
    {
      return Corotational::stress_towards(is_damped ? D : target_of_step(D));
    }

    void
    set_target(const Matrix3<Number> &D)
    {
      Corotational::set_target(is_damped ? D : target_of_step(D));
    }

    Matrix3<Number>
    elastic_force()
    {
      set_target(Matrix3<Number>{});
      return this->force();
    }

    /// Let the rotation stay: R K R^T with C_t.
    void
    make_convex()
    {
      is_convex = true;
    }

    Matrix3<Number>
    response(const Matrix3<Number> &M) const
    {
      return is_convex ? stress(this->own_material(), symmetric_part(M))
                       : Corotational::response(M);
    }

    Matrix3<Number>
    example_response(const Matrix3<Number> &E) const
    {
      const Matrix3<Number> E_t = drawn(E);
      return is_convex ? stress(this->own_material(), E_t) : Corotational::example_response(E_t);
    }

  private:
    /// dev e - q_n
    Matrix3<Number>
    branch_strain() const
    {
      return combine(Number(1.), deviator(this->strain()), Number(-1.), q);
    }

    /// r mu (1 - f) |dev e - q_n|^2 [Pa].
    Number
    branch_density() const
    {
      const Matrix3<Number> way = branch_strain();
      return constants.share * constants.mu * (Number(1.) - f) * contract(way, way);
    }

    /// C_t^-1 : C_inf : E.
    Matrix3<Number>
    drawn(const Matrix3<Number> &E) const
    {
      const Number part   = equilibrium.mu / constants.relaxed(f).mu,
                   third  = trace(E) * Number(1. / 3.);
      Matrix3<Number> E_t = deviator(E);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          E_t[i][j] = part * E_t[i][j] + (i == j ? third : Number(0.));
      return E_t;
    }

    /// D_t.
    Matrix3<Number>
    target_of_step(const Matrix3<Number> &D) const
    {
      const Number part
          = constants.share * constants.mu * (Number(1.) - f) / constants.relaxed(f).mu;
      return combine(Number(1.), drawn(D), part, q);
    }

    Constants            constants;   ///< of fast motions, without damping
    CellMaterial<Number> equilibrium; ///< C_inf
    Number               f = Number(0.);
    Matrix3<Number>      q{};
    Number               work_before = Number(0.);
    bool                 is_damped = false, is_convex = false;
  };
} // namespace Exemplar

#endif
