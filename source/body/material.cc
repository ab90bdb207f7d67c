// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/material.h>
#include <exemplar/prm/prm_tools.h>

namespace Exemplar
{
  namespace
  {
    const EnumTable<MassMatrix> mass_matrices
        = { { MassMatrix::consistent, "consistent" }, { MassMatrix::lumped, "lumped" } };

    void
    declare_constants(dealii::ParameterHandler &prm, ElasticConstants &constants)
    {
      // a pattern allows its bounds, too, so that 0 as the bound would allow 0
      const dealii::Patterns::Double positive(1e-300);
      prm.add_parameter("Young's modulus", constants.youngs_modulus, "E [Pa], greater than 0.",
                        positive);
      prm.add_parameter("Poisson's ratio", constants.poissons_ratio,
                        "nu [-], greater than -1 and less than 0.5.",
                        dealii::Patterns::Double(-1., 0.5));
      prm.add_parameter("Density", constants.density,
                        "rho [kg/m^3], greater than 0. Used by dynamics and gravity.", positive);
    }

    std::string
    region_name(const unsigned int id)
    {
      return "region " + std::to_string(id);
    }

    void
    check_poissons_ratio(const ElasticConstants &constants, const std::string &section)
    {
      if (!(constants.poissons_ratio > -1. && constants.poissons_ratio < 0.5))
        throw UserError(section + "/Poisson's ratio = " + shortest_text(constants.poissons_ratio)
                        + " is not allowed: it must lie strictly between -1 and 0.5. For a nearly "
                          "incompressible material take 0.49.");
    }

    CellMaterial<double>
    elasticity_of(const ElasticConstants &constants)
    {
      const double E = constants.youngs_modulus, nu = constants.poissons_ratio;
      return { E * nu / ((1. + nu) * (1. - 2. * nu)), E / (2. * (1. + nu)) };
    }
  } // namespace

  void
  MaterialParameters::declare(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Material");
    declare_constants(prm, everywhere);
    declare_enum(prm, "Mass matrix", mass_matrix, mass_matrices,
                 "consistent, or lumped at the nodes. Used by dynamics only.");
    prm.leave_subsection();
  }

  void
  MaterialParameters::declare_regions(dealii::ParameterHandler     &prm,
                                      const std::set<unsigned int> &ids)
  {
    prm.enter_subsection("Material");
    for (const unsigned int id : ids)
    {
      regions[id] = everywhere;
      prm.enter_subsection(region_name(id));
      declare_constants(prm, regions[id]);
      prm.leave_subsection();
    }
    prm.leave_subsection();
  }

  void
  MaterialParameters::check() const
  {
    check_poissons_ratio(everywhere, "Material");
    for (const auto &[id, constants] : regions)
      check_poissons_ratio(constants, "Material/" + region_name(id));
  }

  Material::Material(const MaterialParameters        &parameters,
                     const std::vector<unsigned int> &material_ids)
      : constants_of_cell(material_ids.size(), 0)
  {
    const auto add = [this](const ElasticConstants &c) {
      constants.push_back({ elasticity_of(c), c.density, c.youngs_modulus });
    };
    add(parameters.everywhere);
    for (const auto &[id, region] : parameters.regions)
    {
      bool found = false;
      for (unsigned int cell = 0; cell < material_ids.size(); ++cell)
        if (material_ids[cell] == id)
        {
          constants_of_cell[cell] = constants.size();
          found                   = true;
        }
      if (!found)
      {
        std::string present;
        for (const unsigned int other :
             std::set<unsigned int>(material_ids.begin(), material_ids.end()))
          present += (present.empty() ? "" : ", ") + std::to_string(other);
        throw UserError("Material/" + region_name(id) + ": no cell of the mesh has material id "
                        + std::to_string(id) + " (present: " + present
                        + "). Give a Physical Volume that tag, or rename the subsection.");
      }
      add(region);
    }
  }
} // namespace Exemplar
