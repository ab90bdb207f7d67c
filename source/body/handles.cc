// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/handles.h>
#include <exemplar/prm/assignments.h>

#include <cmath>
#include <map>
#include <set>

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
      if (components.empty() || components.count(3) == 1)
        throw UserError(key + "/Components = '" + text
                        + "' is not allowed. Allowed: some of x, y, z, separated by commas.");
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
  } // namespace

  Handles::Handles(const std::vector<HandleParameters> &parameters,
                   const Mesh                          &mesh,
                   const TimeAxis                      &axis,
                   const NamedPoses                    &poses,
                   const NamedNodes                    &nodes)
      : mesh(mesh)
  {
    for (const HandleParameters &p : parameters)
      handles.push_back(make_handle(p, poses, nodes));
    dealii::Vector<double> anywhere(3 * mesh.n_nodes());
    move(axis.time(0), anywhere); // are the formulas finite?
    move(axis.time(axis.n_steps()), anywhere);
    const std::set<unsigned int> shared = shared_nodes();
    for (unsigned int step = 0; step <= axis.n_steps() && !shared.empty(); ++step)
      check_agreement(shared, axis.time(step));
    look_for_straight_turns(axis);
  }

  Handles::Handle
  Handles::make_handle(const HandleParameters &p,
                       const NamedPoses       &poses,
                       const NamedNodes       &named_nodes) const
  {
    p.check();
    const std::string key = "Handles/" + p.name;
    Handle            handle{ p.name,
                   p.select.nodes(mesh, key, named_nodes),
                   parse_components(p.components, key),
                   Expression(key + "/Motion", p.motion, "xyzt", 3),
                   Expression(key + "/Progress", p.progress, "t", 1),
                   {} };
    if (!p.follow_pose.empty())
      handle.path.emplace(
          rest_positions(handle),
          choose(mesh.find_pose(poses, p.follow_pose, key + "/Follow pose"), handle.nodes));
    return handle;
  }

  std::vector<dealii::Point<3>>
  Handles::rest_positions(const Handle &handle) const
  {
    return choose(mesh.get_nodes(), handle.nodes);
  }

  dealii::Tensor<1, 3>
  Handles::Handle::displacement(const unsigned int      point,
                                const dealii::Point<3> &rest,
                                const double            time) const
  {
    return path ? path->displacement(point, progress.values(rest, time)[0])
                : motion.vector(rest, time);
  }

  std::set<unsigned int>
  Handles::shared_nodes() const
  {
    std::set<unsigned int> seen, shared;
    for (const Handle &handle : handles)
      for (const unsigned int node : handle.nodes)
        if (!seen.insert(node).second)
          shared.insert(node);
    return shared;
  }

  void
  Handles::check_agreement(const std::set<unsigned int> &shared, const double time) const
  {
    const double tolerance = 1e-10 * mesh.diameter();
    struct Target
    {
      double       displacement;
      unsigned int handle;
    };
    std::map<unsigned int, Target> targets;
    for (unsigned int h = 0; h < handles.size(); ++h)
      for (unsigned int point = 0; point < handles[h].nodes.size(); ++point)
      {
        const unsigned int node = handles[h].nodes[point];
        if (shared.count(node) == 0)
          continue;
        const dealii::Tensor<1, 3> displacement
            = handles[h].displacement(point, mesh.get_nodes()[node], time);
        for (const unsigned int c : handles[h].components)
        {
          const auto [first, is_new] = targets.emplace(3 * node + c, Target{ displacement[c], h });
          if (std::abs(first->second.displacement - displacement[c]) > tolerance)
            throw UserError(
                "Handles '" + handles[first->second.handle].name + "' and '" + handles[h].name
                + "' both hold node " + std::to_string(mesh.get_contents().node_numbers[node])
                + ", but move it differently at t = " + shortest_text(time) + ". Change Handles/"
                + handles[h].name + "/Select so that they do not overlap.");
        }
      }
  }

  std::vector<unsigned int>
  Handles::held_dofs() const
  {
    std::set<unsigned int> dofs;
    for (const Handle &handle : handles)
      for (const unsigned int node : handle.nodes)
        for (const unsigned int c : handle.components)
          dofs.insert(3 * node + c);
    return { dofs.begin(), dofs.end() };
  }

  void
  Handles::move(const double time, dealii::Vector<double> &positions) const
  {
    for (const Handle &handle : handles)
      for (unsigned int point = 0; point < handle.nodes.size(); ++point)
      {
        const unsigned int         node         = handle.nodes[point];
        const dealii::Point<3>    &rest         = mesh.get_nodes()[node];
        const dealii::Tensor<1, 3> displacement = handle.displacement(point, rest, time);
        for (const unsigned int c : handle.components)
          positions[3 * node + c] = rest[c] + displacement[c];
      }
  }

  dealii::Tensor<1, 3>
  Handles::sum_over(const unsigned int handle, const dealii::Vector<double> &field) const
  {
    dealii::Tensor<1, 3> sum;
    for (const unsigned int node : handles[handle].nodes)
      for (const unsigned int c : handles[handle].components)
        sum[c] += field[3 * node + c];
    return sum;
  }
} // namespace Exemplar
