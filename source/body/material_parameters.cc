// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/material_parameters.h>
#include <exemplar/kernels/cell_model.h>
#include <exemplar/prm/key_table.h>

namespace Exemplar
{
  namespace
  {
    const EnumTable<MassMatrix> mass_matrices
        = { { MassMatrix::consistent, "consistent" }, { MassMatrix::lumped, "lumped" } };

    /// Those that laws add to the three above, each once.
    std::map<std::string, LawConstant>
    constants_of_laws()
    {
      std::map<std::string, LawConstant> all;
      for (const CellLaw law : all_laws())
        for (const LawConstant &constant : own_constants(law))
          all.emplace(constant.name, constant);
      return all;
    }

    void
    declare_constants(KeyTable &keys, ElasticConstants &constants)
    {
      const Bounds positive = Bounds::positive();
      keys.add("Young's modulus", constants.youngs_modulus, "E [Pa], greater than 0.", positive);
      keys.add("Poisson's ratio", constants.poissons_ratio,
               "nu [-], greater than -1 and less than 0.5.", Bounds{ -1., 0.5 });
      keys.add("Density", constants.density,
               "rho [kg/m^3], greater than 0. Used by dynamics and gravity.", positive);
      for (const auto &[name, constant] : constants_of_laws())
        keys.add(name, constants.own[name], constant.documentation,
                 Bounds{ constant.min, constant.max });
    }

    void
    check_poissons_ratio(const ElasticConstants &constants, const std::string &section)
    {
      if (!(constants.poissons_ratio > -1. && constants.poissons_ratio < 0.5))
        throw UserError(section + "/Poisson's ratio = " + shortest_text(constants.poissons_ratio)
                        + " is not allowed: it must lie strictly between -1 and 0.5. For a nearly "
                          "incompressible material take 0.499; up to 0.4999 is tested.");
    }
  } // namespace

  OwnConstants
  default_own_constants()
  {
    OwnConstants values;
    for (const auto &[name, constant] : constants_of_laws())
      values[name] = constant.value;
    return values;
  }

  bool
  MaterialParameters::may_yield() const
  {
    bool may = false;
    for_each_region([&](const ElasticConstants &constants, const std::string & /*section*/)
                    { may |= constants.own.at("Yield stress") > 0.; });
    return may;
  }

  std::string
  MaterialParameters::region_name(const unsigned int id)
  {
    return region_name(std::to_string(id));
  }

  std::string
  MaterialParameters::region_name(const std::string &name)
  {
    return "region " + name;
  }

  void
  MaterialParameters::declare(KeyTable &keys)
  {
    keys.enter_subsection("Material");
    declare_constants(keys, everywhere);
    keys.add("Mass matrix", mass_matrix, mass_matrices,
             "consistent, or lumped at the nodes. Used by dynamics, and by gravity on quadratic "
             "elements.");
    const std::string usage = ": MAP [from A to B] [absolute], where MAP is FILE.ply:ATTRIBUTE or "
                              "FILE.csv[:COLUMN] with "
                              "a value for each vertex of Mesh/Surface. The values are factors of "
                              "what this section and "
                              "those of regions say; with 'absolute' they stand instead of it. "
                              "'from A to B' makes A of "
                              "the value 0 and B of 1.";
    keys.add_file("Young's modulus map", youngs_modulus_map, "E painted on the surface" + usage);
    keys.add_file("Poisson's ratio map", poissons_ratio_map, "nu painted on the surface" + usage);
    keys.add_file("Density map", density_map, "rho painted on the surface" + usage);
    keys.leave_subsection();
  }

  void
  MaterialParameters::declare_regions(KeyTable                     &keys,
                                      const std::set<unsigned int> &ids,
                                      const std::set<std::string>  &names)
  {
    const auto declare_region = [&](ElasticConstants &constants, const std::string &subsection)
    {
      constants = everywhere;
      keys.enter_subsection(subsection);
      declare_constants(keys, constants);
      keys.leave_subsection();
    };
    keys.enter_subsection("Material");
    for (const unsigned int id : ids)
      declare_region(regions[id], region_name(id));
    for (const std::string &name : names)
      declare_region(named_regions[name], region_name(name));
    keys.leave_subsection();
  }

  void
  MaterialParameters::check() const
  {
    for_each_region(check_poissons_ratio);
  }
} // namespace Exemplar
