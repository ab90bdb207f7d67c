// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/material.h>

// Examples with an elasticity of their own. The energy density of the body and of its examples,
//
//   (1 - eta)/2 e:C:e + eta/2 (e - E):C_e:(e - E) = 1/2 (e - D):C':(e - D) + 1/2 D:C_y:D,
//   C' = (1 - eta) C + eta C_e,  D = C'^-1:eta C_e:E,  C_y = (1 - eta)/eta C':C_e^-1:C,   Eq. (38)
//
// is that of a body with elasticity C' whose examples have the strains D, plus a form of the
// weights alone.

namespace Exemplar
{
  namespace
  {
    /// C_e of a cell whose constants without examples are `body`.
    Orthotropy
    elasticity_for(const CellConstants &body, const ExampleElasticity &own)
    {
      const double E  = own.youngs_modulus.value_or(body.youngs_modulus);
      const double nu = own.poissons_ratio.value_or(body.poissons_ratio);
      return Orthotropy({ E * nu / ((1. + nu) * (1. - 2. * nu)), E / (2. * (1. + nu)) }, 0.);
    }
  } // namespace

  Material
  Material::with_examples(const ExampleElasticity &own, const double importance) const
  {
    Material result         = *this;
    result.of_examples      = own;
    result.importance_there = importance;
    if (!has_elasticity_of_examples())
      result.of_body = constants;
    const char *const alpha = Fibrous<double>::own_constants[0].name;
    for (std::size_t i = 0; i < result.constants.size(); ++i)
    {
      const CellConstants &body     = result.of_body[i];
      CellConstants       &values   = result.constants[i];
      const double         eta      = importance * body.importance;
      const double         fibres   = body.own->at(alpha);
      const Orthotropy     examples = elasticity_for(body, own);
      const auto           wish     = examples.isotropic_part();
      values.grain                  = body.grain.sum(1. - eta, eta, examples);
      if (fibres > 0.)
      {
        OwnConstants changed = *body.own;
        changed[alpha]       = (1. - eta) * fibres;
        values.own           = std::make_shared<const OwnConstants>(std::move(changed));
      }
      if (body.is_orthotropic)
        values.elasticity = values.grain.isotropic_part();
      else
        values.elasticity = { (1. - eta) * body.elasticity.lambda + eta * wish.lambda,
                              (1. - eta) * body.elasticity.mu + eta * wish.mu };
      values.lambda_of_patches = body.is_orthotropic || fibres > 0.
                                     ? values.grain.lambda_of_patches()
                                     : values.elasticity.lambda;
    }
    result.find_stiffnesses();
    return result;
  }

  Material::BodyConstants
  Material::of_body_alone(const unsigned int cell) const
  {
    const unsigned int   i     = constants_of_cell[cell];
    const CellConstants &body  = has_elasticity_of_examples() ? of_body[i] : constants[i];
    const char *const    alpha = Fibrous<double>::own_constants[0].name;
    return { body.youngs_modulus, body.poissons_ratio, body.own->at(alpha), body.is_orthotropic };
  }

  BlendedElasticity::BlendedElasticity(const CellConstants     &constants,
                                       const ExampleElasticity &of_examples,
                                       const double             eta,
                                       const GrainAxes         &axes)
      : body(constants.grain), examples(elasticity_for(constants, of_examples)), eta(eta),
        axes(axes),
        body_is_isotropic(!constants.is_orthotropic && !(constants.grain.norm_of_grain() > 0.))
  {
  }

  BlendedElasticity
  Material::blend(const unsigned int cell) const
  {
    const CellConstants &body = of_body[constants_of_cell[cell]];
    return { body, of_examples, importance_there * body.importance, grain_axes(cell) };
  }

  Matrix3<double>
  BlendedElasticity::drawn_strain(const Matrix3<double> &E) const
  {
    return body.sum(1. - eta, eta, examples)
        .strain(axes, combine(eta, examples.stress(axes, E), 0., E));
  }

  Matrix3<double>
  BlendedElasticity::excess_stress(const Matrix3<double> &D) const
  {
    if (!(eta > 0.))
      return {};
    const Matrix3<double> E = examples.strain(axes, body.stress(axes, D));
    const Matrix3<double> T = body.sum(1. - eta, eta, examples).stress(axes, E);
    return combine((1. - eta) / eta, T, 0., T);
  }

  double
  BlendedElasticity::excess_of_patches() const
  {
    if (!body_is_isotropic)
      return 0.;
    // the transverse stress of a unit stretch is lambda
    Matrix3<double> stretch{};
    stretch[0][0] = 1.;
    return excess_stress(stretch)[1][1];
  }
} // namespace Exemplar
