// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/padded_nodes.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/words.h>
#include <exemplar/potential/fibre_tension_term.h>

#include <deal.II/base/memory_consumption.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    const char *const allowed_curve
        = "Allowed: 'stretch: factor; stretch: factor; ...', at least two pairs, with ascending "
          "stretches above 0 and factors of at least 0, such as 0.5: 0; 1: 1; 1.5: 0.";

    double
    length(const Vector3<double> &a)
    {
      return std::sqrt(dot(a, a));
    }

    dealii::Point<3>
    rest_centre(const FESpace &fe_space, const unsigned int cell)
    {
      dealii::Point<3> centre;
      for (unsigned int a = 0; a < 4; ++a)
        centre += 0.25 * fe_space.rest_position(fe_space.nodes(cell)[a]);
      return centre;
    }

    bool
    is_of(const std::string &variables, const std::string &formula, const std::string &key)
    {
      try
      {
        const Expression expression(key, formula, variables, 1);
        return true;
      }
      catch (const UserError &)
      {
        return false; // or wrong, as the formula with all variables says better
      }
    }
  } // namespace

  TensionCurve::TensionCurve(const std::string &text, const std::string &key)
  {
    if (trim(text).empty())
      return;
    std::istringstream pairs(text);
    for (std::string pair; std::getline(pairs, pair, ';');)
    {
      const std::size_t colon   = pair.find(':');
      const double      stretch = parse_number(trim(pair.substr(0, colon)));
      const double      factor
          = colon == std::string::npos ? std::nan("") : parse_number(trim(pair.substr(colon + 1)));
      if (!(stretch > (table.empty() ? 0. : table.back().first)) || !(factor >= 0.)
          || !std::isfinite(stretch) || !std::isfinite(factor))
        throw UserError(key + " = '" + text + "': '" + trim(pair) + "' is not understood. "
                        + allowed_curve);
      integrals.push_back(table.empty() ? 0.
                                        : integrals.back()
                                              + 0.5 * (stretch - table.back().first)
                                                    * (factor + table.back().second));
      table.emplace_back(stretch, factor);
    }
    if (table.size() < 2)
      throw UserError(key + " = '" + text + "' has one pair alone. " + allowed_curve);
  }

  TensionCurve::Value
  TensionCurve::of_table(const double stretch) const
  {
    if (table.empty())
      return { stretch, 1., 0. };
    const auto above
        = std::upper_bound(table.begin(), table.end(), stretch,
                           [](const double s, const auto &pair) { return s < pair.first; });
    if (above == table.begin())
      return { (stretch - above->first) * above->second, above->second, 0. };
    const auto   below = above - 1;
    const double past = stretch - below->first, integral = integrals[below - table.begin()];
    if (above == table.end())
      return { integral + past * below->second, below->second, 0. };
    const double slope = (above->second - below->second) / (above->first - below->first);
    return { integral + past * (below->second + 0.5 * slope * past), below->second + slope * past,
             slope };
  }

  TensionCurve::Value
  TensionCurve::at(const double stretch) const
  {
    const double at_rest = of_table(1.).energy;
    Value        value   = of_table(std::max(stretch, least_stretch));
    value.energy -= at_rest;
    if (stretch < least_stretch)
    {
      value.slope = value.force / least_stretch;
      value.energy -= 0.5 * value.slope * (least_stretch * least_stretch - stretch * stretch);
      value.force = value.slope * stretch;
    }
    return value;
  }

  Vector3<double>
  FibreTensionTerm::Fibre::change(const Vector3<double> &of_now, const Tangent kind) const
  {
    const double slope = kind == Tangent::convex ? std::max(curve.slope, 0.) : curve.slope;
    const double along
        = stretch > 0. ? (slope - force_factor) * dot(now, of_now) / (stretch * stretch) : 0.;
    Vector3<double> result;
    for (int i = 0; i < 3; ++i)
      result[i] = force_factor * of_now[i] + along * now[i];
    return result;
  }

  FibreTensionTerm::FibreTensionTerm(const Material            &material,
                                     const FESpace             &fe_space,
                                     const std::vector<double> &held)
      : of_material(material.tensions()), material(material), fe_space(fe_space), held(held),
        kernels(best_kernels(fe_space.element())), node_positions(4 * fe_space.n_nodes()),
        node_sums(4 * fe_space.n_nodes()), tension(fe_space.n_cells(), 0.)
  {
    for (const FibreTensions::Source &source : of_material.sources)
    {
      const std::string key        = source.section + "/Fibre tension";
      const bool        is_of_time = is_of("t", source.formula, key);
      laws.push_back({ Expression(key, source.formula, is_of_time ? "t" : "xyzt", 1), !is_of_time,
                       !is_of("xyz", source.formula, key),
                       TensionCurve(source.curve, key + " curve") });
      are_constant &= laws.back().curve.is_constant();
      are_steady &= !laws.back().depends_on_time;
    }
    for (unsigned int cell = 0; cell < of_material.of_cells.size(); ++cell)
      if (of_material.of_cells[cell] > 0)
        active_cells.push_back(cell);
    keep_shares();
    amounts.assign(active_cells.size() * points_per_cell(fe_space.element()), 0.);
  }

  void
  FibreTensionTerm::attach(const SymmetricPattern &pattern, const FreeDofs &free_dofs)
  {
    scatter.emplace(fe_space, pattern, free_dofs);
  }

  void
  FibreTensionTerm::follow_parameters()
  {
    keep_shares();
    find_tensions();
  }

  std::vector<double>
  FibreTensionTerm::tensions_at(const double at) const
  {
    std::vector<double> of_laws;
    for (const Law &law : laws)
      of_laws.push_back(law.depends_on_place ? 0. : law.formula.value(dealii::Point<3>(), at));
    std::vector<double> result;
    result.reserve(active_cells.size());
    for (const unsigned int cell : active_cells)
    {
      const unsigned int i      = of_material.of_cells[cell] - 1;
      const double       factor = of_material.factors.empty() ? 1. : of_material.factors[cell];
      const double       value  = !held.empty() && held[cell] != not_held
                                      ? held[cell]
                                      : factor
                                     * (laws[i].depends_on_place
                                                   ? laws[i].formula.value(rest_centre(fe_space, cell), at)
                                                   : of_laws[i]);
      if (!(value >= 0.))
        throw SolverFailure(
            fmt::format("{}/Fibre tension = {} is {} Pa at t = {} in cell {}, counted from 0, but "
                        "fibres do not push: "
                        "their energy would have no minimum. Give at least 0, such as max(0, ...).",
                        of_material.sources[i].section, of_material.sources[i].formula,
                        short_text(value), short_text(at), cell));
      result.push_back(value);
    }
    return result;
  }

  void
  FibreTensionTerm::set_time(const double new_time)
  {
    time = new_time;
    if (!are_known || !are_steady || held != held_then)
      find_tensions();
  }

  void
  FibreTensionTerm::find_tensions()
  {
    const std::vector<double> values = tensions_at(time);
    const auto n_points = static_cast<unsigned int>(points_per_cell(fe_space.element()));
    held_then           = held;
    are_known           = true;
    amounts.clear();
    for (std::size_t i = 0; i < active_cells.size(); ++i)
    {
      tension[active_cells[i]] = values[i];
      for (unsigned int k = 0; k < n_points; ++k)
        amounts.push_back(values[i] * fe_space.volume(n_points * active_cells[i] + k));
    }
  }

  bool
  FibreTensionTerm::differs(const double one, const double other) const
  {
    const bool is_free
        = held.empty() || std::find(held.begin(), held.end(), not_held) != held.end();
    return is_free && tensions_at(one) != tensions_at(other);
  }

  std::optional<EnergyFlow>
  FibreTensionTerm::energy_flow(const State &start, const State &end) const
  {
    const std::vector<double> before = tensions_at(start.time);
    const auto n_points = static_cast<unsigned int>(points_per_cell(fe_space.element()));
    double     by_start = 0., by_end = 0.;
    for (std::size_t i = 0; i < active_cells.size(); ++i)
    {
      const unsigned int cell   = active_cells[i];
      const double       change = tension[cell] - before[i];
      for (unsigned int k = 0; change != 0. && k < n_points; ++k)
      {
        const unsigned int point = n_points * cell + k;
        const double       share = change * fe_space.volume(point);
        by_start += share * curve(cell).at(fibre(point, start.positions)->stretch).energy;
        by_end += share * curve(cell).at(fibre(point, end.positions)->stretch).energy;
      }
    }
    return EnergyFlow{ true, 0., 0.5 * (by_start + by_end), 0.5 * std::abs(by_end - by_start) };
  }

  std::optional<FibreTensionTerm::Fibre>
  FibreTensionTerm::fibre(const unsigned int point, const Vector &positions) const
  {
    const unsigned int cell = fe_space.cell_of(point);
    if (of_material.of_cells.empty() || of_material.of_cells[cell] == 0)
      return {};
    const auto           &along = material.grain_axes(cell).along;
    const Vector3<double> rest  = { { along[0], along[1], along[2] } };
    Vector3<double>       now{};
    const auto            nodes = fe_space.nodes(cell);
    const auto            g     = fe_space.gradients(point);
    for (unsigned int a = 0; a < nodes.size(); ++a)
    {
      const double share = dot(g[a], rest);
      for (int i = 0; i < 3; ++i)
        now[i] += share * positions[3 * nodes[a] + i];
    }
    Fibre found = at_vector(cell, now);
    found.rest  = rest;
    return found;
  }

  FibreTensionTerm::Fibre
  FibreTensionTerm::at_vector(const unsigned int cell, const Vector3<double> &now) const
  {
    Fibre found{};
    found.now          = now;
    found.stretch      = length(now);
    found.curve        = curve(cell).at(found.stretch);
    found.force_factor = found.stretch < TensionCurve::least_stretch
                             ? found.curve.slope
                             : found.curve.force / found.stretch;
    return found;
  }

  void
  FibreTensionTerm::keep_shares()
  {
    const auto n_points = static_cast<unsigned int>(points_per_cell(fe_space.element()));
    nodes.clear();
    shares.clear();
    std::vector<unsigned int> order(nodes_per_cell(fe_space.element()));
    for (const unsigned int cell : active_cells)
    {
      const auto of_cell = fe_space.nodes(cell);
      std::iota(order.begin(), order.end(), 0);
      std::sort(order.begin(), order.end(),
                [&](const unsigned int a, const unsigned int b)
                { return of_cell[a] < of_cell[b]; });
      for (const unsigned int a : order)
        nodes.push_back(of_cell[a]);
      const auto           &along = material.grain_axes(cell).along;
      const Vector3<double> rest  = { { along[0], along[1], along[2] } };
      for (unsigned int point = n_points * cell; point < n_points * (cell + 1); ++point)
        for (const unsigned int a : order)
          shares.push_back(dot(fe_space.gradients(point)[a], rest));
    }
  }

  void
  FibreTensionTerm::add(const TermPoint &at, ElasticSums &sums)
  {
    constexpr std::size_t n_at_once = 64; // few enough for the fastest memory
    const FibreArrays     fibres{ nodes.data(), shares.data() };
    const std::size_t     n = active_cells.size() * points_per_cell(fe_space.element());
    double                vectors[4 * n_at_once];
    double                energy = sums->energy;
    pad_nodes(at.positions, node_positions);
    node_sums.fill(0.);
    for (std::size_t begin = 0; begin < n; begin += n_at_once)
    {
      const std::size_t end = std::min(begin + n_at_once, n);
      kernels.fibre_vectors(fibres, begin, end, node_positions.data(), vectors);
      energy += are_constant ? kernels.pull_fibres(&amounts[begin], end - begin,
                                                   TensionCurve::least_stretch, vectors)
                             : find_forces(begin, end, vectors);
      kernels.add_fibre_forces(fibres, begin, end, vectors, node_sums.data());
    }
    sums->energy = energy;
    for (std::size_t node = 0; node < fe_space.n_nodes(); ++node)
    {
      for (unsigned int c = 0; c < 3; ++c)
        sums->gradient[3 * node + c] += node_sums[4 * node + c];
      sums->force_scale[node] += node_sums[4 * node + 3];
    }
  }

  double
  FibreTensionTerm::find_forces(const std::size_t begin,
                                const std::size_t end,
                                double           *vectors) const
  {
    double energy = 0.;
    for (std::size_t i = begin; i < end; ++i, vectors += 4)
    {
      const double stretch
          = std::sqrt(vectors[0] * vectors[0] + vectors[1] * vectors[1] + vectors[2] * vectors[2]);
      const bool                is_usual = stretch >= TensionCurve::least_stretch;
      const TensionCurve::Value value
          = curve(active_cells[i / points_per_cell(fe_space.element())]).at(stretch);
      const double factor = amounts[i] * (is_usual ? value.force / stretch : value.slope);
      energy += amounts[i] * value.energy;
      for (int c = 0; c < 3; ++c)
        vectors[c] *= factor;
      vectors[3] = amounts[i] * value.force;
    }
    return energy;
  }

  Matrix3<double>
  FibreTensionTerm::stiffness(const std::size_t point,
                              const Vector     &positions,
                              const Tangent     kind) const
  {
    const unsigned int  n_nodes = nodes_per_cell(fe_space.element());
    const std::size_t   active  = point / points_per_cell(fe_space.element());
    const unsigned int *of_cell = &nodes[n_nodes * active];
    Vector3<double>     now{};
    for (unsigned int a = 0; a < n_nodes; ++a)
      for (int i = 0; i < 3; ++i)
        now[i] += shares[n_nodes * point + a] * positions[3 * of_cell[a] + i];
    const Fibre     f = at_vector(active_cells[active], now);
    Matrix3<double> columns{};
    for (int j = 0; j < 3; ++j)
    {
      Vector3<double> unit{};
      unit[j]                      = amounts[point];
      const Vector3<double> column = f.change(unit, kind);
      for (int i = 0; i < 3; ++i)
        columns[i][j] = column[i];
    }
    return columns;
  }

  void
  FibreTensionTerm::add_tangent(const TermPoint     &at,
                                const Tangent        kind,
                                std::vector<double> &values,
                                std::vector<double> & /*columns*/)
  {
    const unsigned int n_points = points_per_cell(fe_space.element()),
                       n_nodes  = nodes_per_cell(fe_space.element());
    std::vector<double> blocks(3 * n_block_columns(n_nodes));
    for (std::size_t active = 0; active < active_cells.size(); ++active)
    {
      if (tension[active_cells[active]] == 0.)
        continue;
      std::fill(blocks.begin(), blocks.end(), 0.);
      for (std::size_t point = n_points * active; point < n_points * (active + 1); ++point)
      {
        const Matrix3<double> K     = stiffness(point, at.positions, kind); // symmetric
        const double         *share = &shares[n_nodes * point];
        double               *entry = blocks.data();
        for (unsigned int a = 0; a < n_nodes; ++a)
          for (unsigned int b = 0; b <= a; ++b)
            for (int j = 0; j < 3; ++j)
              for (int i = 0; i < 3; ++i)
                *entry++ += share[a] * share[b] * K[j][i];
      }
      scatter->add_blocks(active_cells[active], blocks.data(), values);
    }
  }

  void
  FibreTensionTerm::add_response(const TermPoint &at,
                                 const Tangent    kind,
                                 const Vector    &displacement,
                                 ElasticSums     &sums)
  {
    const auto n_points = static_cast<unsigned int>(points_per_cell(fe_space.element()));
    for (const unsigned int cell : scatter->cells_beside_held_nodes())
      for (unsigned int point = n_points * cell; point < n_points * (cell + 1); ++point)
        if (const std::optional<Fibre> f = fibre(point, at.positions))
        {
          const Vector3<double> change = f->change(fibre(point, displacement)->now, kind);
          const auto            nodes  = fe_space.nodes(cell);
          for (unsigned int a = 0; a < nodes.size(); ++a)
            for (int i = 0; i < 3; ++i)
              sums->gradient[3 * nodes[a] + i] += fe_space.volume(point) * tension[cell]
                                                  * dot(fe_space.gradients(point)[a], f->rest)
                                                  * change[i];
        }
  }

  std::size_t
  FibreTensionTerm::memory_consumption() const
  {
    return dealii::MemoryConsumption::memory_consumption(active_cells)
           + dealii::MemoryConsumption::memory_consumption(shares)
           + dealii::MemoryConsumption::memory_consumption(nodes)
           + node_positions.memory_consumption() + node_sums.memory_consumption()
           + dealii::MemoryConsumption::memory_consumption(tension)
           + dealii::MemoryConsumption::memory_consumption(amounts)
           + dealii::MemoryConsumption::memory_consumption(held_then)
           + (scatter ? scatter->memory_consumption() : 0);
  }

  const FibreTensionTerm *
  find_tension_term(const PotentialTerms &terms)
  {
    for (const auto &term : terms)
      if (const auto *found = dynamic_cast<const FibreTensionTerm *>(term.get()))
        return found;
    return nullptr;
  }

  std::vector<std::string>
  describe_tensions(FibreTensionTerm          &term,
                    const Material            &material,
                    const FESpace             &fe_space,
                    const std::vector<double> &times)
  {
    constexpr double much = 0.8; // of the stiffness along a fibre
    double           part = 0.;
    for (const double time : times)
    {
      term.set_time(time);
      for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
        if (term.tensions()[cell] > 0.)
          part = std::max(part, term.tensions()[cell]
                                    / (material.youngs_modulus(cell)
                                       + material.own_number("Fibre stiffness", cell)));
    }
    part = fe_space.exchange().max(part);
    if (!(part >= much))
      return {};
    return { fmt::format("Material/Fibre tension is up to {} times E + Fibre stiffness: a free "
                         "fibre would shorten to {} of its length, "
                         "where cells hardly resist. Take a smaller tension, a greater Young's "
                         "modulus, or a Fibre tension curve "
                         "that falls towards short fibres.",
                         short_text(part), short_text(std::max(0., 1. - part))) };
  }
} // namespace Exemplar
