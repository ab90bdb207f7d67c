// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/scene/scene_parameters.h>

// Settings that a neo-Hookean background requires in other sections of a scene.

namespace Exemplar
{
  void
  SceneParameters::check_background() const
  {
    if (!model.is_neo_hookean())
      return;
    const std::string key             = "Model/Background = neo-hookean";
    const std::string or_corotational = ", or set Model/Background = corotational.";
    if (scene == SceneKind::interpolation)
      throw UserError(
          key
          + " is for static and dynamic scenes: in an interpolation examples alone act. "
            "Choose another Scene"
          + or_corotational);
    if (material.law_of_grain())
      throw UserError(
          key
          + " is for isotropic materials. Remove the fibres (Material/Fibre stiffness = "
            "0, Orthotropy empty)"
          + or_corotational);
    if (material.may_yield())
      throw UserError(key + " is for elastic materials. Set Material/Yield stress = 0"
                      + or_corotational);
    if (examples.in_use() && examples.energy != ExampleEnergy::blended)
      throw UserError(key
                      + " with examples needs Examples/Energy = blended, in which the body has an "
                        "energy of its own beside the wish to be like the examples. Set that"
                      + or_corotational);
    if (examples.in_use() && examples.elasticity().is_own())
      throw UserError(key
                      + " is for examples with the elasticity of the material. Remove "
                        "Examples/Example modulus and Example Poisson ratio"
                      + or_corotational);
    if (examples.in_use() && material.importance_varies())
      throw UserError(key
                      + " is for bodies in which examples are equally important everywhere. Set "
                        "Material/Importance factor = 1"
                      + or_corotational);
  }
} // namespace Exemplar
