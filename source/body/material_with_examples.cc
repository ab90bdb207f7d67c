// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/material.h>

// Examples with an elasticity of their own, Eq. (38).

namespace Exemplar
{
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
      const CellConstants &body   = result.of_body[i];
      CellConstants       &values = result.constants[i];
      values.whole                = body.whole.blended(importance * body.importance,
                                                       own.isotropic(body.youngs_modulus, body.poissons_ratio));
      values.elasticity           = values.whole.isotropic;
      if (body.whole.fibre_stiffness > 0.)
      {
        OwnConstants changed = *body.own;
        changed[alpha]       = values.whole.fibre_stiffness;
        values.own           = std::make_shared<const OwnConstants>(std::move(changed));
      }
    }
    result.find_stiffnesses();
    return result;
  }

  BlendedElasticity<double>
  Material::blend(const unsigned int cell) const
  {
    const CellConstants &body = of_body[constants_of_cell[cell]];
    return { body.whole, of_examples.isotropic(body.youngs_modulus, body.poissons_ratio),
             importance_there * body.importance, grain_axes(cell) };
  }

  CellElasticity<double>
  Material::whole_of_examples(const unsigned int cell) const
  {
    return has_elasticity_of_examples() ? blend(cell).of_examples()
                                        : constants[constants_of_cell[cell]].whole;
  }
} // namespace Exemplar
