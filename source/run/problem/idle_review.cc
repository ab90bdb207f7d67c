// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/prm/assignments.h>
#include <exemplar/prm/expression.h>
#include <exemplar/run/problem/idle_review.h>
#include <exemplar/run/problem/motion_review.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    bool
    is_at_rest(const Problem &problem)
    {
      const Vector &x = problem.state.positions, &v = problem.state.velocities;
      const Vector &rest   = problem.body.fe_space.rest_positions();
      const double  little = 1e-12 * problem.body.mesh.diameter();
      return std::equal(x.begin(), x.end(), rest.begin(),
                        [&](const double a, const double b) { return std::abs(a - b) <= little; })
             && std::all_of(v.begin(), v.end(), [](const double a) { return a == 0.; });
    }

    /// The components of a force whose formulas are not the number 0.
    std::vector<unsigned int>
    directions_of(const LoadParameters &load)
    {
      const std::vector<std::string> formulas = split_formulas(load.force, 3);
      std::vector<unsigned int>      directions;
      for (unsigned int c = 0; c < formulas.size(); ++c)
        if (parse_number(formulas[c]) != 0.)
          directions.push_back(c);
      return directions;
    }

    /// Whether all of these nodes of this process are held in these directions.
    bool
    are_held(const std::vector<unsigned int> &nodes,
             const std::vector<unsigned int> &directions,
             const std::vector<unsigned int> &held_dofs)
    {
      return std::all_of(nodes.begin(), nodes.end(),
                         [&](const unsigned int node)
                         {
                           return std::all_of(directions.begin(), directions.end(),
                                              [&](const unsigned int c) {
                                                return std::binary_search(held_dofs.begin(),
                                                                          held_dofs.end(),
                                                                          3 * node + c);
                                              });
                         });
    }

    bool
    any_obstacle_moves(const Problem &problem)
    {
      const Obstacles *const obstacles = problem.actions.obstacles.get();
      const TimeAxis        &axis      = problem.time_axis;
      for (unsigned int step = 1; obstacles != nullptr && step <= axis.n_steps(); ++step)
        if (obstacles->move_between(axis.time(step - 1), axis.time(step)))
          return true;
      return false;
    }

    /// Whether the rest pose is an equilibrium with these examples.
    bool
    may_rest(const Examples &examples)
    {
      return examples.poses.size() == 0 || examples.weights.are_additive()
             || (!examples.weights.are_prescribed() && !examples.poses.is_strained(0));
    }
    /// What Examples/Regions = auto found, a note a region.
    void
    describe_regions(const std::vector<WeightRegion> &regions, std::vector<std::string> &notes)
    {
      if (regions.size() == 1)
        notes.push_back("Examples/Regions = auto does nothing: the examples strain the body as one "
                        "region");
      if (regions.size() < 2)
        return;
      notes.push_back(fmt::format("Examples/Regions = auto found {} regions:", regions.size()));
      for (std::size_t i = 0; i < regions.size(); ++i)
        notes.push_back(fmt::format(
            "region {}: {} cells, {} % of the volume, round {}, {}, {}{}", i + 1,
            regions[i].n_cells, short_text(100. * regions[i].volume),
            short_text(regions[i].centre[0]), short_text(regions[i].centre[1]),
            short_text(regions[i].centre[2]),
            regions[i].example.empty() ? "" : ", most strained by " + regions[i].example));
    }
  } // namespace

  std::vector<std::string>
  idle_load_warnings(const Problem &problem)
  {
    const Loads *const loads = problem.actions.loads.get();
    if (loads == nullptr || !loads->has_named_loads())
      return {};
    std::vector<std::string>        warnings;
    const std::vector<unsigned int> held = problem.constraints.handles.held_dofs();
    for (unsigned int load = 0; load < loads->size(); ++load)
      if (const auto directions = directions_of(problem.parameters.loads.named[load]);
          !directions.empty()
          && !problem.body.exchange().any(!are_held(loads->nodes(load), directions, held)))
        warnings.push_back(
            "Loads/" + loads->name(load)
            + " moves nothing: handles hold all nodes that it acts on, in its direction. Select "
              "others in its Select or in that of the handle, or free a component by Components.");
    return warnings;
  }

  std::vector<std::string>
  idle_notes(const Problem &problem)
  {
    std::vector<std::string> notes = problem.actions.notes;
    if (problem.parameters.scene != SceneKind::interpolation && problem.actions.loads == nullptr
        && !problem.parameters.material.has_tension() && problem.parameters.session.empty()
        && may_rest(problem.examples) && !problem.body.exchange().any(!is_at_rest(problem))
        && !is_any_handle_moved(problem) && !any_obstacle_moves(problem))
      notes.push_back("nothing will happen: no handle moves, no load acts, and the body starts at "
                      "rest (Handles/NAME/Motion, Loads/Gravity, Loads/Names)");
    const ExampleWeights &weights = problem.examples.weights;
    if (problem.parameters.examples.weights_per_region && weights.n_regions() == 1
        && weights.size() > 0)
      notes.push_back("Examples/Weights per region does nothing: the body has one region");
    describe_regions(problem.body.weight_regions, notes);
    return notes;
  }
} // namespace Exemplar
