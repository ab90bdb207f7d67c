// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/run/problem/problem_parts.h>

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <limits>

// Constraints of the body of a problem.

namespace Exemplar
{
  namespace
  {
    /// Degrees of freedom of the whole body that this process has, in its own numbering.
    std::vector<unsigned int>
    dofs_here(const Exchange &exchange, const std::vector<unsigned int> &in_whole)
    {
      std::vector<unsigned int> here;
      for (const unsigned int dof : in_whole)
        if (const int node = exchange.node_here(dof / 3); node >= 0)
          here.push_back(3 * static_cast<unsigned int>(node) + dof % 3);
      return here;
    }

    /// The ascending numbers of both lists.
    std::vector<unsigned int>
    united(const std::vector<unsigned int> &a, const std::vector<unsigned int> &b)
    {
      std::vector<unsigned int> all;
      std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
      return all;
    }

    std::string
    names_of_selections(const std::vector<HandleParameters> &handles)
    {
      std::string names;
      for (const HandleParameters &handle : handles)
        names += (names.empty() ? "Handles/" : " or Handles/") + handle.name + "/Select";
      return names;
    }

    /// The least radius [m] of a sphere about a node that contains a whole cell.
    double
    reach_of_a_cell(const Body &body, const unsigned int node)
    {
      double minimum = std::numeric_limits<double>::max();
      for (unsigned int c = 0; c < body.mesh.n_cells(); ++c)
        if (const auto cell = body.mesh.corners(c);
            std::find(cell.begin(), cell.end(), node) != cell.end())
        {
          double reach = 0.;
          for (const unsigned int corner : cell)
            reach = std::max(reach,
                             body.mesh.get_nodes()[corner].distance(body.mesh.get_nodes()[node]));
          minimum = std::min(minimum, reach);
        }
      return minimum;
    }

    std::vector<unsigned int>
    held_dofs(const SceneParameters                             &parameters,
              const Body                                        &body,
              const Handles                                     &handles,
              const std::optional<StaticallyDeterminateSupport> &support)
    {
      const std::vector<unsigned int> fixed = body.fe_space.numbering().fixed_dofs();
      if (support)
        return united(dofs_here(body.exchange(), support->held_dofs), fixed);
      const std::vector<unsigned int> held = united(handles.held_dofs(), fixed);
      if (!body.exchange().any(held.size() < body.fe_space.n_dofs()))
        throw UserError(parameters.name
                        + ": the handles hold every node, so there is nothing to solve. Make "
                        + names_of_selections(parameters.handles)
                        + " smaller; it counts in metres, in which the body is "
                        + short_text(body.mesh.diameter()) + " large.");
      return held;
    }

    /// The tips of normals that handles hold; none in an interpolation, in which handles hold nothing.
    HeldTips
    tips_of(const Handles &handles, const std::optional<StaticallyDeterminateSupport> &support)
    {
      HeldTips tips = handles.held_tips();
      if (support)
        std::fill(tips.begin(), tips.end(), HeldComponents(0));
      return tips;
    }
  } // namespace

  Constraints::Constraints(const SceneParameters &parameters,
                           const Body            &body,
                           const TimeAxis        &axis,
                           const BodyInputs      &inputs)
      : handles(parameters.handles,
                body.mesh,
                body.fe_space,
                axis,
                inputs.fields.poses,
                inputs.fields.nodes,
                inputs.undivided.motions),
        support(inputs.fields.support),
        free_dofs(
            body.fe_space.n_dofs(), held_dofs(parameters, body, handles, support), body.exchange()),
        held_tips(tips_of(handles, support))
  {
    if (body.exchange().any(free_dofs.size() == 0))
      throw UserError(fmt::format(
          "{}: of {} processes some would have no node to move. Start fewer with mpirun -n.",
          parameters.name, body.exchange().n_processes()));
  }

  namespace
  {
    /// Remedy for a handle with a single node.
    std::string
    remedy_of_single_node(const Handles &handles, const unsigned int h, const Body &body)
    {
      const auto  &nodes = handles.nodes(h);
      const double reach
          = min_of_all(body.exchange(), nodes.empty() ? std::numeric_limits<double>::max()
                                                      : reach_of_a_cell(body, nodes[0]));
      return "Enlarge Handles/" + handles.name(h) + "/Select by " + short_text(1.01 * reach)
             + " m, and it holds a whole " + (body.mesh.is_shell() ? "triangle." : "tetrahedron.");
    }
  } // namespace

  std::vector<std::string>
  Constraints::describe_single_nodes(const Body &body) const
  {
    std::vector<std::string> all;
    for (unsigned int h = 0; h < handles.size(); ++h)
      if (handles.n_nodes(h) == 1)
        all.push_back("Handle '" + handles.name(h)
                      + "' holds a single node, about which the body can turn. "
                      + remedy_of_single_node(handles, h, body));
    return all;
  }

  std::vector<std::string>
  Constraints::describe_pulled_nodes(const SceneParameters &parameters, const Body &body) const
  {
    const HandleParameters   usual;
    std::vector<std::string> all;
    for (unsigned int h = 0; h < parameters.handles.size(); ++h)
      if (const HandleParameters &handle = parameters.handles[h];
          handle.select.is_of_space() && handle.motion != usual.motion
          && handle.components == usual.components && handles.n_nodes(h) == 1)
        all.push_back("Handle '" + handle.name + "' pulls at the single node in its "
                      + handle.select.text
                      + ", so the strain there depends on the size of the cells. "
                      + remedy_of_single_node(handles, h, body));
    return all;
  }

  void
  Constraints::check(const SceneParameters &parameters, const Body &body, const TimeAxis &axis)
  {
    check_rigid_motions(parameters, body);
    for (unsigned int step = 1; step < axis.n_steps() && handles.have_times(); ++step)
      if (handles.follow_time(axis.time(step)))
        check_rigid_motions(parameters, body);
    handles.follow_time(axis.time(0));
  }

  void
  Constraints::follow_handles(const SceneParameters &parameters, const Body &body)
  {
    free_dofs.reinit(held_dofs(parameters, body, handles, support));
    held_tips = tips_of(handles, support);
  }

  bool
  Constraints::follow_time(const double time, const SceneParameters &parameters, const Body &body)
  {
    if (!handles.follow_time(time)) // the same in all processes
      return false;
    follow_handles(parameters, body);
    return true;
  }

  void
  Constraints::change_handles(const std::function<void(Handles &)> &change,
                              const SceneParameters                &parameters,
                              const Body                           &body)
  {
    const auto holding = handles.holding();
    try
    {
      change(handles);
      check_rigid_motions(parameters, body);
      follow_handles(parameters, body);
    }
    catch (const UserError &)
    {
      handles.restore(holding);
      throw;
    }
  }

  void
  Constraints::check_rigid_motions(const SceneParameters &parameters, const Body &body) const
  {
    if (parameters.scene != SceneKind::statics)
      return;
    const bool has_obstacles = !parameters.obstacles.empty();
    if (has_obstacles && parameters.obstacles.free != FreeBodies::refused)
      return;
    const auto free_of_pieces
        = n_free_rigid_motions(body.mesh, body.fe_space, handles.held_dofs(),
                               body.ties.joined_pieces(), handles.held_tips());
    const auto         loose  = std::max_element(free_of_pieces.begin(), free_of_pieces.end());
    const unsigned int n_free = *loose;
    const std::string  of_piece
        = free_of_pieces.size() == 1
              ? ""
              : fmt::format(
                  " of the piece with element {}",
                  body.mesh.whole().pieces.first_elements[loose - free_of_pieces.begin()]);
    std::string single_nodes;
    for (const std::string &sentence : describe_single_nodes(body))
      single_nodes += " " + sentence;
    if (n_free > 0)
      throw UserError(fmt::format(
          "{}: the handles leave {} of 6 rigid motions{} free, so a static scene has no unique "
          "equilibrium.{}{} a subsection of Handles that holds three nodes not on a line (a box, a "
          "sphere or a boundary), or hold more Components.{}",
          parameters.name, n_free, of_piece, single_nodes,
          single_nodes.empty() ? " Add" : " Or add",
          has_obstacles ? " Or let obstacles hold the body, with Obstacles/Free = friction or weak "
                          "springs."
                        : ""));
  }
} // namespace Exemplar
