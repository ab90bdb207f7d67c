// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/run/scene/scene_parameters.h>

// Settings that cells with a yield stress require in other sections of a scene.

namespace Exemplar
{
  namespace
  {
    void
    check_viscosity(const ElasticConstants &constants, const std::string &section)
    {
      const double viscosity = constants.own.at("Flow viscosity");
      if (viscosity > 0. && constants.own.at("Yield stress") > 0.)
        throw UserError(
            section + "/Flow viscosity = " + shortest_text(viscosity)
            + " lets plastic strain grow in the time of a dynamic scene, but this scene is "
              "static: its increments have no length in time. Set "
            + section + "/Flow viscosity = 0, or Scene = dynamic.");
    }

    void
    check_orthotropy(const ElasticConstants &constants, const std::string &section)
    {
      if (!constants.orthotropy.empty() && constants.own.at("Yield stress") > 0.)
        throw UserError(
            section
            + "/Yield stress is for materials without orthotropy, as what yields is isotropic; "
              "fibres may go through it (Fibre stiffness). Give the two to different regions, or "
              "set "
            + section + "/Yield stress = 0.");
    }
  } // namespace

  void
  SceneParameters::check_plasticity() const
  {
    if (!material.may_yield())
      return;
    const std::string key = "Material/Yield stress";
    if (scene == SceneKind::interpolation)
      throw UserError(
          key
          + " is for static and dynamic scenes: in an interpolation nothing pulls at the "
            "body. Set it to 0, or choose another Scene.");
    material.for_each_section(check_orthotropy);
    if (model.law() != CellLaw::corotational && !material.law_of_grain())
      throw UserError(
          key
          + " is for Model/Strain = corotational with Model/Gradient = consistent, whose cells "
            "know a plastic strain in their own frame. Set these two, or "
          + key + " = 0.");
    if (examples.in_use() && examples.energy != ExampleEnergy::blended)
      throw UserError(
          key
          + " with examples needs Examples/Energy = blended, in which the body has an energy of "
            "its own beside the wish to be like the examples, so that yielding does not depend "
            "on Examples/Importance. Set Examples/Energy = blended, or "
          + key + " = 0.");
    if (examples.in_use() && examples.elasticity().is_own())
      throw UserError(
          key
          + " is for examples with the elasticity of the material. Remove Examples/Example "
            "modulus and Example Poisson ratio, or set "
          + key + " = 0.");
    if (examples.in_use() && material.importance_varies())
      throw UserError(
          key
          + " is for bodies in which examples are equally important everywhere, as they "
            "share the energy with what yields. Set Material/Importance factor = 1, or "
          + key + " = 0.");
    if (scene == SceneKind::statics)
      material.for_each_section(check_viscosity);
  }
} // namespace Exemplar
