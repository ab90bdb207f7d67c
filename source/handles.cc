// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/errors.h>
#include <exemplar/handles.h>
#include <exemplar/number_text.h>
#include <exemplar/prm_tools.h>

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
  } // namespace

  void
  HandleParameters::declare(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection(name);
    select.declare(prm, "The nodes that the handle holds");
    prm.add_parameter(
        "Motion", motion,
        "Displacement [m] of the held nodes from their rest position: three functions "
        "of the rest position x, y, z [m] and of t [s].");
    prm.add_parameter(
        "Components", components,
        "The components that are held; fewer than x, y, z make a roller or a plane of "
        "symmetry.");
    prm.leave_subsection();
  }

  Handles::Handles(const std::vector<HandleParameters> &parameters,
                   const Mesh                          &mesh,
                   const TimeAxis                      &axis)
      : mesh(mesh)
  {
    for (const HandleParameters &p : parameters)
    {
      const std::string key = "Handles/" + p.name;
      handles.push_back({ p.name, p.select.nodes(mesh, key), parse_components(p.components, key),
                          Expression(key + "/Motion", p.motion, "xyzt", 3) });
    }
    dealii::Vector<double> anywhere(3 * mesh.n_nodes());
    move(axis.time(0), anywhere); // are the formulas finite?
    move(axis.time(axis.n_steps()), anywhere);
    const std::set<unsigned int> shared = shared_nodes();
    for (unsigned int step = 0; step <= axis.n_steps() && !shared.empty(); ++step)
      check_agreement(shared, axis.time(step));
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
      for (const unsigned int node : handles[h].nodes)
      {
        if (shared.count(node) == 0)
          continue;
        const dealii::Tensor<1, 3> displacement
            = handles[h].displacement.vector(mesh.get_nodes()[node], time);
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
      for (const unsigned int node : handle.nodes)
      {
        const dealii::Point<3>    &rest         = mesh.get_nodes()[node];
        const dealii::Tensor<1, 3> displacement = handle.displacement.vector(rest, time);
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
