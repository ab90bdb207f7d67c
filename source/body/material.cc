// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/material.h>
#include <exemplar/mesh/physical_names.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

namespace Exemplar
{
  namespace
  {
    CellMaterial<double>
    elasticity_of(const ElasticConstants &constants)
    {
      const double               E = constants.youngs_modulus, nu = constants.poissons_ratio;
      const CellMaterial<double> elasticity = isotropic_of(E, nu);
      if (!std::isfinite(elasticity.lambda) || !std::isfinite(elasticity.mu))
        throw UserError("Material: with Young's modulus " + shortest_text(E)
                        + " Pa and Poisson's ratio " + shortest_text(nu)
                        + " the body is too stiff to compute with. Lower one of them.");
      return elasticity;
    }

    void
    apply(const PaintedConstant &painted, const unsigned int cell, double &value)
    {
      if (!painted.values.empty())
        value = painted.values[cell] * (painted.is_factor ? value : 1.);
    }

    void
    check_constants(const ElasticConstants &values,
                    const unsigned int      cell,
                    const std::string      &origin)
    {
      const auto check = [&](const std::string &name, const double value, const bool is_allowed)
      {
        if (!is_allowed)
          throw UserError(fmt::format(
              "Material/{}{}: cell {}, counted from 0, would get {}. Young's modulus and density "
              "must be greater than 0, Poisson's ratio above -1 and below 0.5.{}",
              name, origin, cell, shortest_text(value),
              origin.empty() ? "" : " Change the map, or how it is used."));
      };
      check("Young's modulus", values.youngs_modulus, values.youngs_modulus >= 1e-300);
      check("Density", values.density, values.density >= 1e-300);
      check("Poisson's ratio", values.poissons_ratio,
            values.poissons_ratio > -1. && values.poissons_ratio < 0.5);
    }

    /// Name of the fibre stiffness, the constant of the law with fibres.
    const char *const alpha = Fibrous<double>::own_constants[0].name;

    CellElasticity<double>
    whole_of(const ElasticConstants &constants)
    {
      const CellMaterial<double> isotropic = elasticity_of(constants);
      const double               fibres    = constants.own.at(alpha);
      if (constants.orthotropy.empty())
        return { isotropic, fibres, {} };
      const std::string key = "Material/Orthotropy";
      const auto tensor = orthotropy_of(parse_orthotropy(constants.orthotropy, key), fibres, key);
      return { tensor.isotropic_part(), fibres, tensor };
    }
  } // namespace

  std::map<unsigned int, ElasticConstants>
  regions_by_id(const MaterialParameters &parameters, const MshFile &names)
  {
    auto regions = parameters.regions;
    for (const auto &[name, constants] : parameters.named_regions)
    {
      const std::string  key = "Material/" + MaterialParameters::region_name(name);
      const unsigned int id  = find_id(names, 3, name, key);
      if (!regions.emplace(id, constants).second)
        throw UserError(fmt::format("{}: the region of this name has material id {}, which "
                                    "another subsection sets, too. Keep one of the two.",
                                    key, id));
    }
    return regions;
  }

  namespace
  {
    std::shared_ptr<const OwnConstants>
    shared_own(const ElasticConstants &values)
    {
      return std::make_shared<const OwnConstants>(values.own);
    }

    /// Constants of a cell; `own` equals values.own.
    CellConstants
    constants_of(const ElasticConstants &values, std::shared_ptr<const OwnConstants> own)
    {
      const CellElasticity<double> whole          = whole_of(values);
      double                       youngs_modulus = values.youngs_modulus;
      double                       poissons_ratio = values.poissons_ratio;
      if (whole.orthotropic)
      {
        const auto &[lambda, mu] = whole.isotropic;
        youngs_modulus           = mu * (3. * lambda + 2. * mu) / (lambda + mu);
        poissons_ratio           = lambda / (2. * (lambda + mu));
      }
      return { whole,          whole.isotropic,   values.density, youngs_modulus,
               poissons_ratio, values.importance, std::move(own), 0. };
    }

    /// The constants beyond Lamé's of the law of general anisotropy.
    std::array<double, 22>
    stiffness(const CellConstants &of_cell, const GrainAxes &axes)
    {
      const auto             grain   = of_cell.whole.tensor().without(of_cell.lambda_of_others);
      const auto             entries = grain.entries(axes);
      std::array<double, 22> numbers;
      numbers[0] = grain.least();
      std::copy(entries.begin(), entries.end(), numbers.begin() + 1);
      return numbers;
    }
  } // namespace

  namespace
  {
    /// The subsection that a region was given by.
    std::string
    section_of(const MaterialParameters &parameters, const MshFile &names, const unsigned int id)
    {
      for (const auto &[name, constants] : parameters.named_regions)
      {
        const std::string section = "Material/" + MaterialParameters::region_name(name);
        if (find_id(names, 3, name, section) == id)
          return section;
      }
      return "Material/" + MaterialParameters::region_name(id);
    }

    /// Tensions of the sections, whose constants are `of_sections` by the indices that cells have.
    FibreTensions
    tensions_of(const std::vector<ElasticConstants> &of_sections,
                const std::vector<std::string>      &sections,
                const std::vector<unsigned int>     &section_of_cell,
                std::vector<double>                  factors)
    {
      FibreTensions             all;
      std::vector<unsigned int> source_of_section;
      for (std::size_t i = 0; i < of_sections.size(); ++i)
      {
        const ElasticConstants &constants = of_sections[i];
        if (constants.has_tension())
          all.sources.push_back(
              { sections[i], constants.fibre_tension, constants.fibre_tension_curve });
        source_of_section.push_back(constants.has_tension() ? all.sources.size() : 0);
      }
      if (all.sources.empty())
        return all;
      for (const unsigned int section : section_of_cell)
        all.of_cells.push_back(source_of_section[section]);
      all.factors = std::move(factors);
      return all;
    }
  } // namespace

  FibreTensions
  FibreTensions::part(const std::vector<unsigned int> &cells) const
  {
    FibreTensions result;
    result.sources = sources;
    for (const unsigned int cell : cells)
    {
      if (!of_cells.empty())
        result.of_cells.push_back(of_cells[cell]);
      if (!factors.empty())
        result.factors.push_back(factors[cell]);
    }
    return result;
  }

  Material::Material(const MaterialParameters        &parameters,
                     const std::vector<unsigned int> &material_ids,
                     const MshFile                   &names,
                     const PaintedMaterial           &painted,
                     std::vector<GrainAxes>           axes_of_cells)
      : constants_of_cell(material_ids.size(), 0), axes(std::move(axes_of_cells)),
        stiffness_of_volume(parameters.volume_stiffness)
  {
    std::vector<ElasticConstants> bases{ parameters.everywhere };
    std::vector<std::string>      sections{ "Material" };
    constants.push_back(constants_of(parameters.everywhere, shared_own(parameters.everywhere)));
    const std::set<unsigned int> ids(material_ids.begin(), material_ids.end());
    for (const auto &[id, region] : regions_by_id(parameters, names))
    {
      for (unsigned int cell = 0; cell < material_ids.size(); ++cell)
        if (material_ids[cell] == id)
          constants_of_cell[cell] = constants.size();
      if (ids.count(id) == 0)
      {
        std::string present;
        for (const unsigned int other : ids)
          present += fmt::format("{}{}", present.empty() ? "" : ", ", other);
        throw UserError(
            fmt::format("Material/{}: no cell of the mesh has material id {} (present: {}). Give a "
                        "Physical Volume that tag, or rename the subsection.",
                        MaterialParameters::region_name(id), id, present));
      }
      constants.push_back(constants_of(region, shared_own(region)));
      bases.push_back(region);
      sections.push_back(section_of(parameters, names, id));
    }
    fibre_tensions = tensions_of(bases, sections, constants_of_cell, painted.fibre_tension.values);
    if (!painted.youngs_modulus.values.empty() || !painted.poissons_ratio.values.empty()
        || !painted.density.values.empty() || !painted.importance.values.empty())
      paint(painted, bases);
    find_stiffnesses();
  }

  void
  Material::find_stiffnesses()
  {
    const bool is_any = std::any_of(constants.begin(), constants.end(),
                                    [](const CellConstants &values)
                                    { return values.whole.orthotropic.has_value(); });
    stiffnesses.resize(is_any ? constants_of_cell.size() : 0);
    for (unsigned int cell = 0; cell < stiffnesses.size(); ++cell)
      stiffnesses[cell] = stiffness(constants[constants_of_cell[cell]], grain_axes(cell));
  }

  bool
  Material::importance_varies() const
  {
    return std::any_of(constants.begin(), constants.end(),
                       [](const CellConstants &values) { return values.importance != 1.; });
  }

  double
  Material::norm_estimate(const unsigned int cell) const
  {
    const CellConstants &of_cell = constants[constants_of_cell[cell]];
    return of_cell.elasticity.norm_estimate() + of_cell.whole.tensor().norm_of_grain();
  }

  void
  Material::paint(const PaintedMaterial &painted, const std::vector<ElasticConstants> &bases)
  {
    std::vector<std::shared_ptr<const OwnConstants>> own;
    for (const ElasticConstants &base : bases)
      own.push_back(shared_own(base));
    constants.clear();
    for (unsigned int cell = 0; cell < constants_of_cell.size(); ++cell)
    {
      ElasticConstants values = bases[constants_of_cell[cell]];
      apply(painted.youngs_modulus, cell, values.youngs_modulus);
      apply(painted.poissons_ratio, cell, values.poissons_ratio);
      apply(painted.density, cell, values.density);
      apply(painted.importance, cell, values.importance);
      check_constants(values, cell, " map");
      constants.push_back(constants_of(values, own[constants_of_cell[cell]]));
      constants_of_cell[cell] = cell;
    }
  }

  double
  Material::number(const CellLaw law, const unsigned int cell, const std::size_t k) const
  {
    const CellConstants  &of_cell = constants[constants_of_cell[cell]];
    constexpr std::size_t n       = CellMaterial<double>::n_numbers;
    if (k < n)
      return of_cell.elasticity.number(k);
    if (law == CellLaw::anisotropic)
      return (stiffnesses.empty() ? stiffness(of_cell, grain_axes(cell))
                                  : stiffnesses[cell])[k - n];
    const std::vector<LawConstant> own = own_constants(law);
    if (k < n + own.size())
      return of_cell.own->at(own[k - n].name);
    return axes.empty() ? 0. : axes[cell].along[k - n - own.size()];
  }

  namespace
  {
    /// The value of a constant in a cell: changed, or as before.
    double
    changed_to(const std::vector<double> &values, const unsigned int cell, const double before)
    {
      return values.empty() ? before : values[values.size() == 1 ? 0 : cell];
    }

    void
    check_number(const std::vector<double> &values,
                 const std::size_t          n_cells,
                 const std::string         &key)
    {
      if (values.size() > 1 && values.size() != n_cells)
        throw UserError(
            fmt::format("{}: there are {} numbers for {} cells. Give one for all, or one a cell.",
                        key, values.size(), n_cells));
    }
  } // namespace

  Material
  Material::with(const ChangedConstants &changed) const
  {
    if (has_elasticity_of_examples())
    {
      Material body    = *this;
      body.constants   = of_body;
      body.of_examples = {};
      return body.with(changed).with_examples(of_examples, importance_there);
    }
    check_number(changed.youngs_modulus, constants_of_cell.size(), "Material/Young's modulus");
    check_number(changed.poissons_ratio, constants_of_cell.size(), "Material/Poisson's ratio");
    check_number(changed.density, constants_of_cell.size(), "Material/Density");
    Material         result;
    ElasticConstants values;
    result.axes           = axes;
    result.fibre_tensions = fibre_tensions;
    result.constants.reserve(constants_of_cell.size());
    result.constants_of_cell.reserve(constants_of_cell.size());
    const OwnConstants *own = nullptr; // source of values.own
    for (unsigned int cell = 0; cell < constants_of_cell.size(); ++cell)
    {
      const CellConstants &before = constants[constants_of_cell[cell]];
      if (own != before.own.get())
        values.own = *(own = before.own.get());
      values.youngs_modulus = changed_to(changed.youngs_modulus, cell, before.youngs_modulus);
      values.poissons_ratio = changed_to(changed.poissons_ratio, cell, before.poissons_ratio);
      values.density        = changed_to(changed.density, cell, before.density);
      values.importance     = before.importance;
      check_constants(values, cell, "");
      result.constants_of_cell.push_back(cell);
      result.constants.push_back(constants_of(values, before.own));
      if (changed.youngs_modulus.empty() && changed.poissons_ratio.empty())
      {
        result.constants.back()         = before; // bitwise unchanged
        result.constants.back().density = values.density;
      }
      else if (before.whole.orthotropic)
        throw UserError("Material/Orthotropy has nine constants of its own, so Young's modulus and "
                        "Poisson's ratio of the body cannot change. Change its density alone.");
    }
    result.find_stiffnesses();
    return result;
  }

  Material
  Material::without_dilatation() const
  {
    Material rest = *this;
    for (CellConstants &values : rest.constants)
    {
      const double lambda = values.whole.lambda_of_patches();
      if (values.elasticity.lambda == lambda)
        values.elasticity = values.elasticity.without_dilatation();
      else
        values.elasticity.lambda -= lambda;
      values.lambda_of_others = lambda;
    }
    rest.find_stiffnesses();
    return rest;
  }

  Material
  Material::part(const std::vector<unsigned int> &cells) const
  {
    Material                             result;
    std::map<unsigned int, unsigned int> number; // indices in the result, by index here
    result.fibre_tensions = fibre_tensions.part(cells);
    for (const unsigned int cell : cells)
    {
      const unsigned int here = constants_of_cell[cell];
      if (number.emplace(here, result.constants.size()).second)
        result.constants.push_back(constants[here]);
      result.constants_of_cell.push_back(number[here]);
      if (!axes.empty())
        result.axes.push_back(axes[cell]);
      if (!stiffnesses.empty())
        result.stiffnesses.push_back(stiffnesses[cell]);
    }
    return result;
  }
} // namespace Exemplar
