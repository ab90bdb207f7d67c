// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/adjoint/slope_of_contact.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    bool
    begins_at_rest(const Problem &problem)
    {
      return problem.parameters.initial.pose.empty()
             && problem.parameters.initial.pose_function.empty();
    }

    /// Chain rule: the nodes in the middles of edges move with the vertices.
    void
    add_by_vertices(const NodeNumbering &nodes, const Vector &by_nodes, Vector &by_rest_positions)
    {
      for (unsigned int node = 0; node < nodes.n_nodes(); ++node)
        for (unsigned int c = 0; c < 3; ++c)
          if (node < nodes.n_vertices())
            by_rest_positions[3 * node + c] += by_nodes[3 * node + c];
          else
            for (const unsigned int end : nodes.ends(node))
              by_rest_positions[3 * end + c] += 0.5 * by_nodes[3 * node + c];
    }
  } // namespace

  void
  add_slope_of_contact(const Problem &problem, const Direction &direction, SlopeDerivatives &sums)
  {
    const FESpace &fe_space = problem.body.fe_space;
    for (const TouchingTerm *const term : touching_terms(problem))
    {
      TouchingSlopes slopes = term->slopes(problem.state.positions, direction.positions, fe_space);
      sums.by_positions += slopes.by_positions;
      for (std::size_t cell = 0; cell < slopes.by_young.size(); ++cell)
        sums.by_young[cell] += slopes.by_young[cell];
      if (begins_at_rest(problem))
        slopes.by_rest_positions += slopes.by_first_positions;
      add_by_vertices(fe_space.numbering(), slopes.by_rest_positions, sums.by_rest_positions);
      if (!slopes.of_obstacles.empty())
      {
        sums.by_start     = std::move(slopes.by_start);
        sums.of_obstacles = std::move(slopes.of_obstacles);
      }
    }
  }

  bool
  knows_starts_in_contact(const Problem &problem)
  {
    const bool has_pose_function = !problem.parameters.initial.pose_function.empty();
    if (const BodyContacts *const contacts = problem.actions.body_contacts.get())
    {
      const bool has_widths = !contacts->own_widths.empty() || !contacts->joint_widths.empty();
      if (contacts->pieces_were_moved || !contacts->points.empty()
          || (has_pose_function && has_widths))
        return false;
    }
    if (problem.actions.obstacles == nullptr)
      return true;
    const Obstacles &obstacles = *problem.actions.obstacles;
    const auto      &widths    = obstacles.start_widths;
    const bool       is_set_back
        = std::any_of(obstacles.all.begin(), obstacles.all.end(),
                      [](const Obstacle &obstacle) { return obstacle.was_set_back(); });
    const bool has_widths
        = std::any_of(widths.begin(), widths.end(), [](const auto &own) { return !own.empty(); });
    return !is_set_back && (!has_widths || !has_pose_function);
  }
} // namespace Exemplar
