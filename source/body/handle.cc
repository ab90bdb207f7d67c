// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/handle.h>
#include <exemplar/prm/assignments.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace Exemplar
{
  namespace
  {
    std::vector<unsigned int>
    parse_components(const std::string &text, const std::string &key)
    {
      std::set<unsigned int> components;
      for (const std::string &word : split_trimmed(text, ','))
        if (word == "x" || word == "y" || word == "z")
          components.insert(static_cast<unsigned int>(word[0] - 'x'));
        else
          components.insert(3);
      std::string meant;
      for (const std::string c : { "x", "y", "z" })
        if (text.find(c) != std::string::npos)
          meant += (meant.empty() ? "" : ", ") + c;
      if (components.empty() || components.count(3) == 1)
        throw UserError(key + "/Components = '" + text
                        + "' is not allowed. Allowed: some of x, y, z, separated by commas, such "
                          "as '"
                        + (meant.empty() ? "x, y" : meant) + "'.");
      return { components.begin(), components.end() };
    }

    std::vector<dealii::Point<3>>
    choose(const std::vector<dealii::Point<3>> &all, const std::vector<unsigned int> &nodes)
    {
      std::vector<dealii::Point<3>> chosen;
      for (const unsigned int node : nodes)
        chosen.push_back(all[node]);
      return chosen;
    }

    /// The nodes of a handle, with those that follow from held vertices.
    std::vector<unsigned int>
    held_nodes(const HandleParameters   &parameters,
               std::vector<unsigned int> vertices,
               const FESpace            &fe_space)
    {
      if (fe_space.is_shell() && !parameters.holds_slopes())
        return vertices;
      return fe_space.numbering().with_middles(std::move(vertices));
    }

    std::vector<Handle::FollowingTip>
    find_following_tips(const Handle &handle, const FESpace &fe_space)
    {
      std::vector<Handle::FollowingTip> tips;
      if (!follows_edge(handle.held_components()))
        return tips;
      const auto point_of = [&](const unsigned int node)
      {
        return static_cast<std::size_t>(
            std::lower_bound(handle.nodes.begin(), handle.nodes.end(), node)
            - handle.nodes.begin());
      };
      for (std::size_t point = 0; point < handle.nodes.size(); ++point)
        if (const unsigned int node = handle.nodes[point]; node >= handle.first_slope)
        {
          const unsigned int edge = node - handle.first_slope;
          const ShellEdge   &of   = fe_space.shell().edges()[edge];
          tips.push_back({ point, point_of(of.begin), point_of(of.end),
                           TipFrame(fe_space.shell(), edge, handle.held_components()) });
        }
      return tips;
    }

    /// Check the displacements that a program's function has given for `n_points`.
    std::vector<dealii::Tensor<1, 3>>
    checked(std::vector<dealii::Tensor<1, 3>> displacements,
            const std::size_t                 n_points,
            const std::string                &key,
            const double                      time)
    {
      if (displacements.size() != n_points)
        throw UserError(fmt::format(
            "{}: the function of its motion gives {} displacements, but it holds {} nodes.", key,
            displacements.size(), n_points));
      for (const dealii::Tensor<1, 3> &displacement : displacements)
        if (!std::isfinite(displacement.norm_square()))
          throw SolverFailure(key + ": the function of its motion gives what is not finite at t = "
                              + shortest_text(time) + ".");
      return displacements;
    }
  } // namespace

  Handle
  make_handle(const HandleParameters &p,
              const Mesh             &mesh,
              const FESpace          &fe_space,
              const NamedPoses       &poses,
              const NamedNodes       &named_nodes)
  {
    p.check();
    const std::string key = "Handles/" + p.name;
    Handle            handle{ p.name,
                   held_nodes(p, p.select.nodes(mesh, key + "/Select", named_nodes), fe_space),
                   parse_components(p.components, key),
                   Expression(key + "/Motion", p.motion, "xyzt", 3),
                   Expression(key + "/Progress", p.progress, "t", 1),
                   {},
                   {},
                   p.holding_time() };
    handle.first_slope    = fe_space.numbering().n_places();
    handle.following_tips = find_following_tips(handle, fe_space);
    if (!p.follow_pose.empty())
    {
      const auto pose = fe_space.complete(
          mesh.find_pose(poses, p.follow_pose, key + "/Follow pose"), key + "/Follow pose");
      handle.path.emplace(whole_handle(handle.nodes, rest_positions(handle, fe_space), fe_space),
                          whole_handle(handle.nodes, choose(pose, handle.nodes), fe_space));
      handle.places_in_path = places_in_whole(handle.nodes, fe_space);
    }
    return handle;
  }

  std::vector<dealii::Point<3>>
  rest_positions(const Handle &handle, const FESpace &fe_space)
  {
    std::vector<dealii::Point<3>> places;
    for (const unsigned int node : handle.nodes)
      places.push_back(fe_space.rest_position(node));
    return places;
  }

  dealii::Tensor<1, 3>
  Handle::displacement(const unsigned int      point,
                       const dealii::Point<3> &rest,
                       const double            time) const
  {
    return path ? path->displacement(places_in_path[point], progress.value(rest, time))
                : motion.vector(rest, time);
  }

  std::vector<dealii::Tensor<1, 3>>
  Handle::displacements(const std::vector<dealii::Point<3>> &rest, const double time) const
  {
    std::vector<dealii::Tensor<1, 3>> result;
    if (function)
      result = checked(function(rest, time), rest.size(), "Handles/" + name, time);
    else
      for (unsigned int point = 0; point < nodes.size(); ++point)
        result.push_back(displacement(point, rest[point], time));
    const auto place = [&](const std::size_t point)
    {
      const dealii::Point<3> x = rest[point] + result[point];
      return Vector3<double>{ { x[0], x[1], x[2] } };
    };
    const HeldComponents held = held_components();
    for (const auto &[point, begin, end, frame] : following_tips)
      if (path && !function) // whose edges may have turned with the normals
      {
        const Vector3<double> node = frame.node(place(begin), place(end), place(point));
        for (unsigned int c = 0; c < 3; ++c)
          result[point][c] = node[c] - rest[point][c];
      }
      else
        for (unsigned int c = 0; c < 3; ++c)
          if ((held >> c & 1U) == 0)
            result[point][c] -= 0.5 * (result[begin][c] + result[end][c]);
    return result;
  }
} // namespace Exemplar
