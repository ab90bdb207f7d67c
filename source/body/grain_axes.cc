// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/words.h>
#include <exemplar/body/grain_axes.h>
#include <exemplar/body/material.h>
#include <exemplar/prm/expression.h>

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace Exemplar
{
  namespace
  {
    using Direction = dealii::Tensor<1, 3>;

    dealii::Point<3>
    centre(const Mesh &mesh, const unsigned int cell)
    {
      dealii::Point<3> sum;
      for (const unsigned int node : mesh.get_cells()[cell])
        sum += 0.25 * mesh.get_nodes()[node];
      return sum;
    }

    constexpr double rounding = 1e-9; ///< relative one of a gradient

    /// Make directions unit vectors. Where the harmonic function is constant, as in a limb that hangs on one of the
    /// selections alone, they become those of the neighbours, from cell to cell. Returns the number of these cells.
    unsigned int
    continue_into_dead_ends(const Mesh &mesh, std::vector<Direction> &directions)
    {
      double maximum = 0.;
      for (const Direction &direction : directions)
        maximum = std::max(maximum, direction.norm());
      std::vector<unsigned int> without;
      for (unsigned int cell = 0; cell < directions.size(); ++cell)
        if (directions[cell].norm() > rounding * maximum)
          directions[cell] /= directions[cell].norm();
        else
          without.push_back(cell);
      const auto n_without = static_cast<unsigned int>(without.size());
      for (const unsigned int cell : without)
        directions[cell] = Direction();
      for (bool goes_on = maximum > 0.; goes_on && !without.empty();)
      {
        std::vector<Direction> at_nodes(mesh.n_nodes());
        for (unsigned int cell = 0; cell < directions.size(); ++cell)
          for (const unsigned int node : mesh.get_cells()[cell])
            at_nodes[node] += directions[cell];
        const auto is_reached = [&](const unsigned int cell)
        {
          Direction sum;
          for (const unsigned int node : mesh.get_cells()[cell])
            sum += at_nodes[node];
          if (sum.norm() > rounding)
            directions[cell] = sum / sum.norm();
          return sum.norm() > rounding;
        };
        const auto rest = std::remove_if(without.begin(), without.end(), is_reached);
        goes_on         = rest != without.end();
        without.erase(rest, without.end());
      }
      return n_without;
    }

    /// Directions of the harmonic function between two selections; a warning goes to `warnings` if it leaves many cells
    /// without.
    std::vector<Direction>
    between(const FibreEnds          &ends,
            const Mesh               &mesh,
            const std::string        &key,
            const NamedNodes         &named,
            std::vector<std::string> &warnings)
    {
      constexpr double many = 0.02; // of the cells
      const auto from = ends.from.nodes(mesh, key, named), to = ends.to.nodes(mesh, key, named);
      std::vector<unsigned int> both;
      std::set_intersection(from.begin(), from.end(), to.begin(), to.end(),
                            std::back_inserter(both));
      if (!both.empty())
        throw UserError(
            fmt::format("{}: '{}' and '{}' share {} nodes, so fibres cannot go from the one to "
                        "the other. Select nodes apart from each other.",
                        key, ends.from.text, ends.to.text, both.size()));
      std::vector<Direction> directions = harmonic_gradients(mesh, from, to);
      const unsigned int     n          = continue_into_dead_ends(mesh, directions);
      if (n > many * mesh.n_cells())
        warnings.push_back(fmt::format(
            "{}: in {} of {} cells no way leads from '{}' to '{}': they are in one of the "
            "selections, or hang on one of them alone. Their fibres go on as those of their "
            "neighbours. Select smaller ends, such as faces of the body, if that is not meant.",
            key, n, mesh.n_cells(), ends.from.text, ends.to.text));
      return directions;
    }

    std::vector<Direction>
    by_formulas(const std::string &text, const Mesh &mesh, const std::string &key)
    {
      const Expression       expression(key, text, "xyz", 3);
      std::vector<Direction> directions;
      for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
        directions.push_back(expression.vector(centre(mesh, cell), 0.));
      return directions;
    }

    /// Directions in all cells as given by formulas, selections or maps, before they are
    /// normalised.
    class Directions
    {
    public:
      /// Warnings are appended.
      Directions(const Mesh                             &mesh,
                 const NamedNodes                       &named,
                 const std::vector<std::vector<double>> &painted,
                 std::vector<std::string>               &warnings)
          : mesh(mesh), named(named), warnings(warnings)
      {
        for (unsigned int cell = 0; !painted.empty() && cell < mesh.n_cells(); ++cell)
        {
          const double components[] = { painted[0][cell], painted[1][cell], painted[2][cell] };
          of_maps.emplace_back(dealii::make_array_view(components));
        }
      }

      /// Fibre directions of a subsection; each text is evaluated once.
      const std::vector<Direction> &
      along(const ElasticConstants &constants, const std::string &section)
      {
        return of_maps.empty() ? of_text(constants.fibre_direction, section + "/Fibre direction")
                               : of_maps;
      }

      const std::vector<Direction> &
      across(const ElasticConstants &constants, const std::string &section)
      {
        return of_text(constants.cross_direction, section + "/Cross direction");
      }

    private:
      const std::vector<Direction> &
      of_text(const std::string &text, const std::string &key)
      {
        std::vector<Direction> &found = of_texts[text];
        if (found.empty())
        {
          const auto ends = split_fibre_ends(text, key);
          found = ends ? between(*ends, mesh, key, named, warnings) : by_formulas(text, mesh, key);
        }
        return found;
      }

      const Mesh                                   &mesh;
      const NamedNodes                             &named;
      std::vector<std::string>                     &warnings;
      std::vector<Direction>                        of_maps;
      std::map<std::string, std::vector<Direction>> of_texts;
    };

    /// Advice in the message about directions that are 0.
    std::string
    remedy_of_no_direction(const std::string &text)
    {
      if (text.empty())
        return "Paint another direction there.";
      if (split_fibre_ends(text, "").has_value())
        return "No way leads from the one selection to the other, and none from a cell that has a "
               "direction: all nodes are in one of them, or in a part of the body that hangs on "
               "one "
               "alone. Select faces of the body, such as boundary 1, or thinner boxes.";
      return "Give formulas that are not all 0 there.";
    }

    std::string
    say_where(const Mesh                      &mesh,
              const std::vector<unsigned int> &cells,
              const std::size_t                n_with_grain)
    {
      const dealii::Point<3> x = centre(mesh, cells.front());
      return fmt::format("{} of the {} cells with fibres, the first around ({}, {}, {})",
                         cells.size(), n_with_grain, short_text(x[0]), short_text(x[1]),
                         short_text(x[2]));
    }

    std::array<double, 3>
    as_array(const Direction &direction)
    {
      return { { direction[0], direction[1], direction[2] } };
    }

    /// The unit vector that is perpendicular to a and nearest to the axis that a is farthest from.
    Direction
    any_across(const Direction &a)
    {
      unsigned int farthest = 0;
      for (unsigned int d = 1; d < 3; ++d)
        if (std::abs(a[d]) < std::abs(a[farthest]))
          farthest = d;
      Direction b;
      b[farthest] = 1.;
      b -= (a * b) * a;
      return b / b.norm();
    }

    /// Set the axes of the cells to which a subsection applies.
    void
    set_axes(const ElasticConstants          &constants,
             const std::string               &section,
             const std::vector<unsigned int> &cells,
             const Mesh                      &mesh,
             Directions                      &directions,
             std::vector<GrainAxes>          &axes)
    {
      if (!constants.has_fibres() || cells.empty())
        return;
      const auto               &along     = directions.along(constants, section);
      const bool                has_cross = !constants.cross_direction.empty();
      double                    maximum   = 0.;
      std::vector<unsigned int> without, parallel;
      for (const unsigned int cell : cells)
        maximum = std::max(maximum, along[cell].norm());
      for (const unsigned int cell : cells)
      {
        const double length = along[cell].norm();
        if (!(length > rounding * maximum) || !std::isfinite(length))
        {
          without.push_back(cell);
          continue;
        }
        const Direction a = along[cell] / length;
        axes[cell].along  = as_array(a);
        Direction b       = any_across(a);
        if (has_cross)
        {
          const Direction &given = directions.across(constants, section)[cell];
          b                      = given - (a * given) * a;
          if (!(b.norm() > 1e-6 * given.norm()))
            parallel.push_back(cell);
          b /= b.norm();
        }
        axes[cell].across = as_array(b);
      }
      if (!without.empty())
        throw UserError(section + "/Fibre direction"
                        + (constants.fibre_direction.empty()
                               ? " maps"
                               : " = '" + constants.fibre_direction + "'")
                        + " is 0 in " + say_where(mesh, without, cells.size()) + ". "
                        + remedy_of_no_direction(constants.fibre_direction));
      if (!parallel.empty())
        throw UserError(section + "/Cross direction = '" + constants.cross_direction
                        + "' is 0 or along Fibre direction in "
                        + say_where(mesh, parallel, cells.size())
                        + ". Give one that points across.");
    }
  } // namespace

  std::optional<FibreEnds>
  split_fibre_ends(const std::string &text, const std::string &key)
  {
    const std::string trimmed = trim(text), from = "from ", to = " to ";
    if (trimmed.compare(0, from.size(), from) != 0)
      return {};
    const std::size_t at = trimmed.find(to);
    if (at == std::string::npos)
      throw UserError(
          key + " = '" + text
          + "' is not understood. Allowed: three formulas separated by ';', or 'from SELECTION "
            "to SELECTION', such as from boundary 1 to boundary 2.");
    return FibreEnds{ { trim(trimmed.substr(from.size(), at - from.size())) },
                      { trim(trimmed.substr(at + to.size())) } };
  }

  std::string
  absolute_fibre_direction(const std::string &text, const std::filesystem::path &directory)
  {
    const auto ends = split_fibre_ends(text, "Material/Fibre direction");
    return ends ? "from " + Selection::absolute(ends->from.text, directory) + " to "
                      + Selection::absolute(ends->to.text, directory)
                : text;
  }

  std::vector<GrainAxes>
  find_grain_axes(const MaterialParameters               &parameters,
                  const Mesh                             &mesh,
                  const NamedNodes                       &named,
                  const std::vector<std::vector<double>> &painted,
                  std::vector<std::string>               &warnings)
  {
    if (!parameters.has_fibres())
      return {};
    std::map<unsigned int, std::vector<unsigned int>> cells; // cells of each material id
    for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
      cells[mesh.get_material_ids()[cell]].push_back(cell);
    Directions             directions(mesh, named, painted, warnings);
    std::vector<GrainAxes> axes(mesh.n_cells());
    for (const auto &[id, constants] : regions_by_id(parameters, mesh.get_contents()))
      if (const auto of_region = cells.find(id); of_region != cells.end())
      {
        set_axes(constants, "Material/" + MaterialParameters::region_name(id), of_region->second,
                 mesh, directions, axes);
        cells.erase(of_region);
      }
    std::vector<unsigned int> others;
    for (const auto &of_id : cells)
      others.insert(others.end(), of_id.second.begin(), of_id.second.end());
    set_axes(parameters.everywhere, "Material", others, mesh, directions, axes);
    return axes;
  }
} // namespace Exemplar
