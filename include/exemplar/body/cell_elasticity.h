// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_elasticity_h
#define exemplar_cell_elasticity_h

#include <exemplar/body/orthotropy.h>

#include <optional>

// The elasticity of a cell, and of its examples, for double and for numbers with derivatives.

namespace Exemplar
{
  /// C of a cell: isotropic with fibres along its first axis or without, or orthotropic.
  template <typename Number>
  struct CellElasticity
  {
    Isotropic<Number> isotropic;       ///< of the matrix around fibres; nearest to an orthotropic C
    Number            fibre_stiffness; ///< [Pa]
    std::optional<Orthotropy<Number>> orthotropic; ///< C, where it is given by nine constants

    /// The whole of C, in the axes of the cell.
    Orthotropy<Number>
    tensor() const
    {
      return orthotropic ? *orthotropic : Orthotropy<Number>(isotropic, fibre_stiffness);
    }

    bool
    has_grain() const
    {
      return orthotropic || fibre_stiffness > Number(0.);
    }

    /// The part of C that patches take: lambda of an isotropic material [Pa].
    Number
    lambda_of_patches() const
    {
      return has_grain() ? tensor().lambda_of_patches() : isotropic.lambda;
    }

    /// (1 - eta) C + eta C_e for an isotropic C_e.
    CellElasticity
    blended(const Number &eta, const Isotropic<Number> &examples) const
    {
      const Number   rest = Number(1.) - eta;
      CellElasticity sum{ { rest * isotropic.lambda + eta * examples.lambda,
                            rest * isotropic.mu + eta * examples.mu },
                          rest * fibre_stiffness,
                          {} };
      if (orthotropic)
      {
        sum.orthotropic = orthotropic->sum(rest, eta, { examples, Number(0.) });
        sum.isotropic   = sum.orthotropic->isotropic_part();
      }
      return sum;
    }

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      bool     is_orthotropic = orthotropic.has_value();
      archive &isotropic.lambda &isotropic.mu &fibre_stiffness &is_orthotropic;
      if (!is_orthotropic)
        return;
      if constexpr (Archive::is_loading::value)
        orthotropic.emplace();
      archive &*orthotropic;
    }
  };

  /// C and C_e of a cell whose examples have an elasticity of their own. The energy density of the
  /// body and of its examples,
  ///
  ///   (1 - eta)/2 e:C:e + eta/2 (e - E):C_e:(e - E) = 1/2 (e - D):C':(e - D) + 1/2 D:C_y:D,
  ///   C' = (1 - eta) C + eta C_e,  D = C'^-1:eta C_e:E,  C_y = (1 - eta)/eta C':C_e^-1:C, Eq. (38)
  ///
  /// is that of a body with elasticity C' whose examples have the strains D, plus a form of the
  /// weights alone.
  template <typename Number>
  class BlendedElasticity
  {
  public:
    BlendedElasticity(const CellElasticity<Number> &body,
                      const Isotropic<Number>      &isotropic,
                      const Number                 &eta,
                      const GrainAxes              &axes)
        : body(body), examples{ isotropic, Number(0.), {} }, sum(body.blended(eta, isotropic)),
          eta(eta), axes(axes)
    {
    }

    /// C_e.
    const CellElasticity<Number> &
    of_examples() const
    {
      return examples;
    }

    /// C'.
    const CellElasticity<Number> &
    of_both() const
    {
      return sum;
    }

    /// The target strain D of an example strain E.
    Matrix3<Number>
    drawn_strain(const Matrix3<Number> &E) const
    {
      return sum.tensor().strain(axes, times(eta, examples.tensor().stress(axes, E)));
    }

    /// The derivative by E of a function with this derivative by D.
    Matrix3<Number>
    by_strain(const Matrix3<Number> &by_drawn) const
    {
      return times(eta, examples.tensor().stress(axes, sum.tensor().strain(axes, by_drawn)));
    }

    /// The stress C_y:D [Pa] of a target strain D, by which the energy of the examples exceeds that
    /// of D; 0 where eta is 0.
    Matrix3<Number>
    excess_stress(const Matrix3<Number> &D) const
    {
      if (!(eta > Number(0.)))
        return {};
      const Matrix3<Number> E = examples.tensor().strain(axes, body.tensor().stress(axes, D));
      return times((Number(1.) - eta) / eta, sum.tensor().stress(axes, E));
    }

    /// The part of C_y that patches take: lambda of an isotropic material, 0 of another one [Pa].
    Number
    excess_of_patches() const
    {
      if (body.has_grain())
        return Number(0.);
      // the transverse stress of a unit stretch is lambda
      Matrix3<Number> stretch{};
      stretch[0][0] = Number(1.);
      return excess_stress(stretch)[1][1];
    }

  private:
    CellElasticity<Number> body, examples, sum;
    Number                 eta;
    GrainAxes              axes;
  };
} // namespace Exemplar

#endif
