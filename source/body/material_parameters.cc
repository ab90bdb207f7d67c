// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/grain_axes.h>
#include <exemplar/body/material_parameters.h>
#include <exemplar/body/orthotropy.h>
#include <exemplar/kernels/cell_model.h>
#include <exemplar/prm/key_table.h>

#include <fmt/core.h>

namespace Exemplar
{
  namespace
  {
    const EnumTable<MassMatrix> mass_matrices
        = { { MassMatrix::consistent, "consistent" }, { MassMatrix::lumped, "lumped" } };

    /// Constants of a material with a name [Pa], [-], [kg/m^3], and where they are from.
    struct KnownMaterial
    {
      const char *name, *youngs_modulus, *poissons_ratio, *density, *source;
    };

    const std::vector<KnownMaterial> known_materials
        = { { "rubber", "2e6", "0.49", "930",
              "natural rubber, Ashby, Materials Selection in Mechanical Design" },
            { "silicone", "0.6e6", "0.49", "1080", "Dragon Skin 30, 100 % modulus, Smooth-On" },
            { "foam", "0.5e6", "0.3", "30", "very light flexible polymer foam, Ashby" },
            { "jelly", "3e3", "0.49", "1020", "dessert gelatine, of the order of magnitude alone" },
            { "muscle", "12e3", "0.49", "1090",
              "Engler et al. 2004, passive and across; density IT'IS" },
            { "fat", "3.25e3", "0.49", "911", "Samani et al. 2007, adipose tissue; density IT'IS" },
            { "skin", "0.42e6", "0.48", "1109", "Agache et al. 1980, in vivo; density IT'IS" },
            { "wood", "11e9", "0.35", "420", "softwood C24 along the grain, EN 338" },
            { "steel", "210e9", "0.3", "7850", "EN 1993-1-1" } };

    EnumTable<MaterialPreset>
    names_of_presets()
    {
      EnumTable<MaterialPreset> table{ { MaterialPreset::none, "none" } };
      for (const KnownMaterial &material : known_materials)
        table.emplace_back(static_cast<MaterialPreset>(table.size()), material.name);
      return table;
    }

    const EnumTable<MaterialPreset> presets = names_of_presets();

    std::string
    documentation_of_presets()
    {
      std::string text = "What Young's modulus, Poisson's ratio and Density are where this section "
                         "does not say: none "
                         "(their own defaults)";
      for (const KnownMaterial &material : known_materials)
        text
            += fmt::format("; {}: E {}, nu {}, rho {} ({})", material.name, material.youngs_modulus,
                           material.poissons_ratio, material.density, material.source);
      return text + ".";
    }

    /// Constants by name of all laws beside Young's modulus, Poisson's ratio and density.
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
      keys.add("Preset", constants.preset, presets, documentation_of_presets());
      keys.add("Young's modulus", constants.youngs_modulus, "E [Pa], greater than 0.", positive);
      keys.add("Poisson's ratio", constants.poissons_ratio,
               "nu [-], greater than -1 and less than 0.5.", Bounds{ -1., 0.5 });
      keys.add("Density", constants.density,
               "rho [kg/m^3], greater than 0. Used by dynamics and gravity.", positive);
      keys.add("Thickness", constants.thickness,
               "t [m] of a shell, at least 1e-6 and at most half of the mean length of its edges; "
               "0 where there is "
               "none.",
               Bounds{ 0. });
      keys.add("Importance factor", constants.importance,
               "Factor of Examples/Importance [-]: 0 is plain elasticity in these cells.",
               Bounds{ 0., 1. });
      for (const auto &[name, constant] : constants_of_laws())
        keys.add(name, constants.own[name], constant.documentation,
                 Bounds{ constant.min, constant.max });
      keys.add(
          "Fibre direction", constants.fibre_direction,
          "Along which fibres lie at rest, of any length: three numbers or formulas of x, y, z "
          "[m], or "
          "'from SELECTION to SELECTION' with selections as in Handles: along the gradient of the "
          "harmonic function that is 0 on the one and 1 on the other, as the fibres of muscles are "
          "drawn. It is the first axis of Orthotropy, too.",
          "; ");
      keys.add(
          "Fibre tension", constants.fibre_tension,
          "T [Pa] with which fibres pull along Fibre direction, a formula of x, y, z [m] at rest, "
          "taken at the centre "
          "of a cell, and t [s], at least 0: of muscles 1e5 to 3e5. A step has that of its end.",
          "; ");
      keys.add("Fibre tension curve", constants.fibre_tension_curve,
               "Force-length curve: factors of Fibre tension by the stretch of a fibre, 'stretch: "
               "factor; stretch: factor; "
               "...', linear between and constant outside, as 0.5: 0; 1: 1; 1.5: 0. Empty: 1.",
               "; ");
      keys.add(
          "Orthotropy", constants.orthotropy,
          "E_1, E_2, E_3, nu_23, nu_13, nu_12, G_23, G_13, G_12 [Pa] and [-], separated by commas, "
          "instead of Young's modulus and Poisson's ratio, with which the body must be stable: "
          "the first axis along Fibre direction, the second along Cross direction. nu_ab is minus "
          "the "
          "strain along b over that along a of a tension along a. Empty: isotropic.");
      keys.add(
          "Cross direction", constants.cross_direction,
          "The second axis of Orthotropy: three numbers or formulas of x, y, z, of which the part "
          "across Fibre direction counts. Empty: any, for materials that are the same all around "
          "their fibres.",
          "; ");
    }

    /// Check Orthotropy, and keys that exclude it.
    void
    check_orthotropy(const ElasticConstants &constants, const std::string &section)
    {
      if (constants.orthotropy.empty())
        return;
      const std::string           key = section + "/Orthotropy";
      const std::array<double, 9> c   = parse_orthotropy(constants.orthotropy, key);
      static_cast<void>(orthotropy_of(c, 0., key));
      const bool is_round = c[1] == c[2] && c[4] == c[5] && c[7] == c[8]
                            && std::abs(2. * c[6] * (1. + c[3]) - c[1]) < 1e-6 * c[1];
      if (!is_round && constants.cross_direction.empty())
        throw UserError(
            key + " differs across the fibres, but no " + section
            + "/Cross direction says which way is which. Give it as three numbers, such as "
              "0; 1; 0, or make E_2 = E_3, nu_12 = nu_13, G_12 = G_13 and G_23 = E_2 / (2 (1 + "
              "nu_23)).");
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

  bool
  ElasticConstants::has_grain() const
  {
    return own.at(Fibrous<double>::own_constants[0].name) > 0. || !orthotropy.empty();
  }

  std::vector<Assignment>
  MaterialParameters::with_presets(const std::vector<Assignment> &assignments)
  {
    std::vector<Assignment> all;
    for (const Assignment &a : assignments)
      if (a.key == "Preset" && !a.subsections.empty() && a.subsections[0] == "Material"
          && find_assignment(assignments, a.path()) == &a)
        for (const KnownMaterial &material : known_materials)
          if (a.value == material.name)
          {
            all.push_back({ a.subsections, "Young's modulus", material.youngs_modulus, a.place });
            all.push_back({ a.subsections, "Poisson's ratio", material.poissons_ratio, a.place });
            all.push_back({ a.subsections, "Density", material.density, a.place });
          }
    all.insert(all.end(), assignments.begin(), assignments.end());
    return all;
  }

  std::vector<std::string>
  MaterialParameters::describe_presets() const
  {
    std::vector<std::string> all;
    for_each_section(
        [&](const ElasticConstants &constants, const std::string &section)
        {
          if (constants.preset != MaterialPreset::none
              && (&constants == &everywhere || constants.preset != everywhere.preset))
            all.push_back(fmt::format(
                "{}/Preset = {}: E {} Pa, nu {}, rho {} kg/m^3", section,
                enum_name(constants.preset, presets), shortest_text(constants.youngs_modulus),
                shortest_text(constants.poissons_ratio), shortest_text(constants.density)));
        });
    return all;
  }

  bool
  ElasticConstants::has_tension() const
  {
    return parse_number(fibre_tension) != 0.; // NaN of a formula, too
  }

  bool
  MaterialParameters::has_tension() const
  {
    bool has = false;
    for_each_section([&](const ElasticConstants &constants, const std::string & /*section*/)
                     { has |= constants.has_tension(); });
    return has;
  }

  bool
  MaterialParameters::has_fibres() const
  {
    bool has = false;
    for_each_section([&](const ElasticConstants &constants, const std::string & /*section*/)
                     { has |= constants.has_fibres(); });
    return has;
  }

  std::optional<CellLaw>
  MaterialParameters::law_of_grain() const
  {
    std::optional<CellLaw> law;
    for_each_section(
        [&](const ElasticConstants &constants, const std::string & /*section*/)
        {
          if (!constants.orthotropy.empty())
            law = CellLaw::anisotropic;
          else if (constants.has_grain() && !law)
            law = CellLaw::fibrous;
        });
    return law;
  }

  std::vector<std::pair<Selection, std::string>>
  MaterialParameters::selections() const
  {
    std::vector<std::pair<Selection, std::string>> all;
    for_each_section(
        [&](const ElasticConstants &constants, const std::string &section)
        {
          const std::string key = section + "/Fibre direction";
          if (const auto ends = split_fibre_ends(constants.fibre_direction, key);
              ends && constants.has_fibres() && fibre_direction_maps.empty())
            for (const Selection &end : { ends->from, ends->to })
              all.emplace_back(end, key);
        });
    return all;
  }

  OwnConstants
  default_own_constants()
  {
    OwnConstants values;
    for (const auto &[name, constant] : constants_of_laws())
      values[name] = constant.value;
    return values;
  }

  bool
  MaterialParameters::has(const std::string &constant) const
  {
    bool has = false;
    for_each_section([&](const ElasticConstants &constants, const std::string & /*section*/)
                     { has |= constants.own.at(constant) > 0.; });
    return has;
  }

  bool
  MaterialParameters::chooses_laws() const
  {
    bool chooses = false;
    for (const CellLaw law : all_laws())
      if (const char *const key = traits_of(law).chosen_by[0])
        chooses |= has(key);
    return chooses;
  }

  bool
  MaterialParameters::importance_varies() const
  {
    bool varies = !importance_map.empty();
    for_each_section([&](const ElasticConstants &constants, const std::string & /*section*/)
                     { varies |= constants.importance != 1.; });
    return varies;
  }

  std::string
  MaterialParameters::region_name(const unsigned int id)
  {
    return region_name(fmt::format("{}", id));
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
    keys.add("Volume stiffness", volume_stiffness,
             "Of a closed shell (Mesh/Kind): resistance [Pa] of the volume that each of its pieces "
             "encloses, a bulk modulus of what is inside; 0: none. Examples say how that volume "
             "changes, as they do of strains.",
             Bounds{ 0. });
    keys.add_file("Young's modulus map", youngs_modulus_map,
                  "E painted on the surface: MAP [from A to B] [absolute], where MAP is "
                  "FILE.ply:ATTRIBUTE or "
                  "FILE.csv[:COLUMN] with a value for each vertex of Mesh/Surface. The values are "
                  "factors of what "
                  "this section and those of regions say; with 'absolute' they stand instead of "
                  "it. 'from A to B' "
                  "makes A of the value 0 and B of 1.");
    keys.add_file("Poisson's ratio map", poissons_ratio_map,
                  "nu painted on the surface, as Young's modulus map says.");
    keys.add_file("Density map", density_map,
                  "rho painted on the surface, as Young's modulus map says.");
    keys.add_file("Thickness map", thickness_map,
                  "Of a shell: its thickness painted on it, as Young's modulus map says.");
    keys.add_file(
        "Importance map", importance_map,
        "Importance painted on the surface: FILE.ply:ATTRIBUTE or FILE.csv[:COLUMN] with a "
        "value from 0 to 1 for each vertex of Mesh/Surface, a factor of what this section "
        "and those of regions say.");
    keys.add_file("Fibre tension map", fibre_tension_map,
                  "Fibre tension painted on the surface: FILE.ply:ATTRIBUTE or FILE.csv[:COLUMN] "
                  "with a value from 0 to 1 for each vertex of Mesh/Surface, a factor of what this "
                  "section and those "
                  "of regions say.");
    keys.add_files(
        "Fibre direction maps", fibre_direction_maps,
        "Fibre direction painted on the surface, instead of formulas: three maps, of its x, y "
        "and z, each FILE.ply:ATTRIBUTE or FILE.csv[:COLUMN], separated by commas.");
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
    const bool has_maps = !fibre_direction_maps.empty();
    if (has_maps && fibre_direction_maps.size() != 3)
      throw UserError(
          fmt::format("Material/Fibre direction maps has {} maps, but a direction has three "
                      "components. Give three, of x, y and z.",
                      fibre_direction_maps.size()));
    for_each_section(
        [&](const ElasticConstants &constants, const std::string &section)
        {
          check_poissons_ratio(constants, section);
          check_orthotropy(constants, section);
          if (constants.has_fibres() && constants.fibre_direction.empty() && !has_maps)
            throw UserError(section + "/"
                            + (!constants.orthotropy.empty() ? "Orthotropy"
                               : constants.has_grain()       ? "Fibre stiffness"
                                                             : "Fibre tension")
                            + " needs to know the direction of the fibres. Set " + section
                            + "/Fibre direction, such as 1; 0; 0.");
          if (!constants.fibre_direction.empty() && has_maps)
            throw UserError(
                section
                + "/Fibre direction and Material/Fibre direction maps are both given, but "
                  "only one of them can say where fibres go. Remove one of them.");
          if (!constants.orthotropy.empty()
              && !(youngs_modulus_map.empty() && poissons_ratio_map.empty()))
            throw UserError(section
                            + "/Orthotropy has nine constants of its own, which no map of Young's "
                              "modulus or Poisson's ratio can paint. Remove the map.");
        });
  }

  std::string
  too_thin_text(const std::string &key, const double thickness)
  {
    return key + " = " + shortest_text(thickness)
           + ": a shell (Mesh/Kind) needs a thickness of at least 1e-6 m. Set it to what the sheet "
             "measures, 0.001 for a millimetre.";
  }
} // namespace Exemplar
