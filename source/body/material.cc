// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/body/material.h>

#include <set>
#include <string>

namespace Exemplar
{
  namespace
  {
    CellMaterial<double>
    elasticity_of(const ElasticConstants &constants)
    {
      const double E = constants.youngs_modulus, nu = constants.poissons_ratio;
      return { E * nu / ((1. + nu) * (1. - 2. * nu)), E / (2. * (1. + nu)) };
    }
  } // namespace

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
        throw UserError("Material/" + MaterialParameters::region_name(id)
                        + ": no cell of the mesh has material id " + std::to_string(id)
                        + " (present: " + present
                        + "). Give a Physical Volume that tag, or rename the subsection.");
      }
      add(region);
    }
  }
} // namespace Exemplar
