// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/map_name.h>
#include <exemplar/run/inputs/painted_maps.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    /// A map and its use, parsed from MAP [from A to B] [absolute].
    struct MapUse
    {
      MapName map;
      bool    is_factor = true;
      bool    has_range = false;    ///< from A to B
      double  at_0 = 0., at_1 = 1.; ///< values for 0 and 1 in the map
    };

    MapUse
    parse_use(const std::string &text, const std::string &key)
    {
      MapUse             use{ split_map_name(text, key) };
      std::istringstream in(use.map.rest);
      bool               is_understood = true;
      for (std::string word; in >> word;)
        if (word == "absolute")
          use.is_factor = false;
        else if (std::string low, to, high; word == "from" && in >> low >> to >> high && to == "to")
        {
          use.has_range = true;
          use.at_0      = parse_number(low);
          use.at_1      = parse_number(high);
        }
        else
          is_understood = false;
      if (!is_understood || !std::isfinite(use.at_0) || !std::isfinite(use.at_1))
        throw UserError(
            key + " = '" + text
            + "' is not understood. Allowed: MAP, and 'from A to B' and 'absolute' behind "
              "it, where MAP is FILE.ply:ATTRIBUTE or FILE.csv[:COLUMN].");
      return use;
    }

    const std::vector<double> &
    find_map(const MapName &map, const Inputs &inputs, const std::string &key)
    {
      const auto found = inputs.maps.find(map.name());
      if (found == inputs.maps.end() || found->second.size() != inputs.surface->vertices.size())
        throw UserError(key + ": there is no map '" + map.name()
                        + "' with a value for each vertex of the surface among the inputs. Hand it "
                          "in by this name, or read it from its file.");
      return found->second;
    }

    /// All values of a constant in the scene: everywhere, and in each region.
    std::vector<double>
    values_in_scene(const MaterialParameters &material, double ElasticConstants::*const member)
    {
      std::vector<double> values{ material.everywhere.*member };
      for (const auto &region : material.regions)
        values.push_back(region.second.*member);
      for (const auto &region : material.named_regions)
        values.push_back(region.second.*member);
      return values;
    }

    /// Divisor that makes shares of percentages, of bytes, and of other values.
    double
    divisor_of(const double maximum)
    {
      for (const double unit : { 100., 255. })
        if (maximum > 0.8 * unit && maximum <= unit)
          return unit;
      return maximum;
    }

    /// Warn of values outside [0, 1], for which a range from A to B extrapolates.
    void
    doubt_range(std::vector<std::string>  &warnings,
                const std::string         &map,
                const std::vector<double> &values,
                const MapUse              &use)
    {
      constexpr double rounding = 1e-3; // rounding of painting programs
      double           minimum = 0., maximum = 1.;
      for (const double value : values)
      {
        minimum = std::min(minimum, value); // ignores NaN
        maximum = std::max(maximum, value);
      }
      if (minimum >= -rounding && maximum <= 1. + rounding)
        return;
      const double farthest = maximum > 1. + rounding ? maximum : minimum;
      warnings.push_back(
          map + ": 'from A to B' says what the values 0 and 1 stand for, but the map has "
          + short_text(farthest) + ", of which "
          + short_text(use.at_0 + farthest * (use.at_1 - use.at_0)) + " is made. "
          + (maximum > 1. + rounding
                 ? "Divide its values by " + short_text(divisor_of(maximum)) + "."
                 : std::string("Paint values from 0 to 1.")));
    }

    /// Warn of values that suggest the other use of a map. Nobody paints a whole body a hundred
    /// times as stiff or dense as its scene says, unless that says 1; jelly has some 1000 Pa.
    void
    doubt(std::vector<std::string>  &warnings,
          const std::string         &map,
          const std::vector<double> &values,
          const bool                 are_factors)
    {
      const auto [minimum, maximum] = std::minmax_element(values.begin(), values.end());
      const std::string range       = short_text(*minimum) + " to " + short_text(*maximum);
      if (are_factors && *minimum >= 100.)
        warnings.push_back(map + ": its values " + range
                           + " are factors of the constant that Material gives. If they "
                             "are in Pa or kg/m^3, write 'absolute' behind the map.");
      if (!are_factors && *maximum < 100. && map.find("Young") != std::string::npos)
        warnings.push_back(map + ": E is " + range
                           + " Pa, less than that of jelly, which has some 1000 Pa. If "
                             "these are factors of Material/Young's modulus, leave "
                             "'absolute' out.");
    }

    /// The painted constant is linear over triangles, so that bounds at vertices hold everywhere.
    PaintedConstant
    painted(const SurfaceSources &from,
            const std::string    &name,
            const std::string    &text,
            double ElasticConstants::*const member,
            const double                    low,
            const double                    high)
    {
      if (text.empty())
        return {};
      const std::string   key    = "Material/" + name + " map";
      const MapUse        use    = parse_use(text, key);
      std::vector<double> values = find_map(use.map, from.inputs, key);
      if (use.has_range)
        doubt_range(from.warnings, key + " = '" + text + "'", values, use);
      const auto factors = use.is_factor ? values_in_scene(from.scene.material, member)
                                         : std::vector<double>{ 1. };
      for (std::size_t v = 0; v < values.size(); ++v)
      {
        const double painted_value = values[v];
        values[v]                  = use.at_0 + painted_value * (use.at_1 - use.at_0);
        for (const double factor : factors)
          if (!(values[v] * factor > low && values[v] * factor < high))
            throw UserError(fmt::format(
                "{} = '{}': vertex {}{} It must be greater than {}{} everywhere. Paint other "
                "values there, or say 'from A to B' behind the map.",
                key, text, v + 1,
                std::isnan(painted_value)
                    ? " has no value in the table."
                    : fmt::format(" has the value {}, which makes {} of it.",
                                  short_text(painted_value), short_text(values[v] * factor)),
                short_text(low), high < 1. ? " and less than " + short_text(high) : ""));
      }
      const bool scales_one = *std::max_element(factors.begin(), factors.end()) <= 1.;
      if (low >= 0. && use.is_factor != scales_one)
        doubt(from.warnings, key + " = '" + text + "'", values, use.is_factor);
      return { from.selector.at_cells(values), use.is_factor };
    }

    /// A map whose values are used as they are.
    MapName
    plain_map(const std::string &text, const std::string &key)
    {
      MapName map = split_map_name(text, key);
      if (!map.rest.empty())
        throw UserError(key + ": " + in_quotes(text)
                        + " is not understood. Give FILE.ply:ATTRIBUTE or FILE.csv[:COLUMN].");
      return map;
    }

    /// One component of the directions of fibres.
    std::vector<double>
    component(const SurfaceSources &from, const std::string &text)
    {
      const std::string          key    = "Material/Fibre direction maps";
      const MapName              map    = plain_map(text, key);
      const std::vector<double> &values = find_map(map, from.inputs, key);
      for (std::size_t v = 0; v < values.size(); ++v)
        if (!std::isfinite(values[v]))
          throw UserError(
              fmt::format("{}: in {} vertex {} has no number. Give one for each vertex.", key,
                          map.name(), v + 1));
      return from.selector.at_cells(values);
    }

    std::vector<double>
    share(const SurfaceSources &from, const std::string &text, const std::string &key)
    {
      const MapName       map     = plain_map(text, key);
      std::vector<double> values  = find_map(map, from.inputs, key);
      double              maximum = 0.;
      for (const double value : values)
        maximum = std::max(maximum, value); // ignores NaN
      for (std::size_t v = 0; v < values.size(); ++v)
      {
        values[v] = std::isnan(values[v]) ? 0. : values[v]; // vertex not in the table
        if (!(values[v] >= 0. && values[v] <= 1. + 1e-6))
          throw UserError(fmt::format(
              "{}: in {} vertex {} has the value {}, but shares lie between 0 and 1. {}", key,
              map.name(), v + 1, short_text(values[v]),
              values[v] > 1.
                  ? fmt::format("The greatest value is {}: divide all by {}, or paint it anew.",
                                short_text(maximum), short_text(divisor_of(maximum)))
                  : "Paint it anew."));
      }
      return from.selector.at_cells(values);
    }
  } // namespace

  PaintedMaterial
  read_painted_material(const SurfaceSources &from)
  {
    const MaterialParameters        &m = from.scene.material;
    std::vector<std::vector<double>> direction;
    for (const std::string &map : m.fibre_direction_maps)
      direction.push_back(component(from, map));
    std::vector<double> importance;
    if (!m.importance_map.empty())
      importance = share(from, m.importance_map, "Material/Importance map");
    std::vector<double> tension;
    if (!m.fibre_tension_map.empty() && m.has_tension())
      tension = share(from, m.fibre_tension_map, "Material/Fibre tension map");
    return { painted(from, "Young's modulus", m.youngs_modulus_map,
                     &ElasticConstants::youngs_modulus, 0., 1e300),
             painted(from, "Poisson's ratio", m.poissons_ratio_map,
                     &ElasticConstants::poissons_ratio, -1., 0.5),
             painted(from, "Density", m.density_map, &ElasticConstants::density, 0., 1e300),
             { importance },
             { tension },
             painted(from, "Thickness", m.thickness_map, &ElasticConstants::thickness, 1e-6, 1e300),
             direction };
  }

  std::vector<std::vector<double>>
  read_painted_shares(const SurfaceSources &from)
  {
    std::vector<std::vector<double>> shares;
    if (from.scene.examples.are_painted())
      for (const std::string &map : from.scene.examples.weight_maps)
        shares.push_back(share(from, map, "Examples/Weight maps"));
    return shares;
  }
} // namespace Exemplar
