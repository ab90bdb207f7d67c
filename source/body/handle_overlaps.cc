// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/handle_overlaps.h>

#include <cmath>
#include <map>
#include <set>

namespace Exemplar
{
  namespace
  {
    /// Of a handle that overlaps with others.
    std::string
    remedy_of_all(const std::string &handle)
    {
      return ". Handles/" + handle + "/Select selects all nodes of the body: make it smaller.";
    }
  } // namespace

  std::set<unsigned int>
  shared_nodes(const std::vector<Handle> &handles)
  {
    std::set<unsigned int> seen, shared;
    for (const Handle &handle : handles)
      for (const unsigned int node : handle.held_nodes())
        if (!seen.insert(node).second)
          shared.insert(node);
    return shared;
  }

  void
  check_agreement(const std::vector<Handle>                            &handles,
                  const std::set<unsigned int>                         &shared,
                  const std::vector<std::vector<dealii::Tensor<1, 3>>> &displacements,
                  const double                                          time,
                  const Mesh                                           &mesh,
                  const FESpace                                        &fe_space)
  {
    const double tolerance = 1e-10 * mesh.diameter();
    struct Target
    {
      double       displacement;
      unsigned int handle;
    };
    std::map<unsigned int, Target> targets;
    for (unsigned int h = 0; h < handles.size(); ++h)
      for (unsigned int point = 0; point < handles[h].held_nodes().size(); ++point)
      {
        const unsigned int node = handles[h].nodes[point];
        if (shared.count(node) == 0)
          continue;
        const dealii::Tensor<1, 3> &displacement = displacements[h][point];
        for (const unsigned int c : handles[h].components)
        {
          const auto [first, is_new] = targets.emplace(3 * node + c, Target{ displacement[c], h });
          if (std::abs(first->second.displacement - displacement[c]) > tolerance)
            throw UserError("Handles '" + handles[first->second.handle].name + "' and '"
                            + handles[h].name + "' both hold " + name_of_node(node, mesh, fe_space)
                            + ", but move it differently at t = " + shortest_text(time)
                            + (handles[first->second.handle].nodes.size() == fe_space.n_nodes()
                                   ? remedy_of_all(handles[first->second.handle].name)
                               : handles[h].nodes.size() == fe_space.n_nodes()
                                   ? remedy_of_all(handles[h].name)
                                   : ". Change Handles/" + handles[h].name
                                         + "/Select so that they do not overlap."));
        }
      }
  }

  void
  refuse_shared_catches(const std::vector<Handle> &handles,
                        const double               time,
                        const double               rounding,
                        const Mesh                &mesh,
                        const FESpace             &fe_space)
  {
    std::map<unsigned int, const Handle *> holders;
    for (const Handle &handle : handles)
      for (const unsigned int node : handle.held_nodes())
        for (const unsigned int c : handle.components)
        {
          const auto [first, is_new] = holders.emplace(3 * node + c, &handle);
          const Handle &other        = *first->second;
          const Handle &catching     = handle.time.has_caught(time, rounding) ? handle : other;
          if (!is_new && catching.time.has_caught(time, rounding))
            throw UserError("Handles '" + other.name + "' and '" + handle.name + "' both hold "
                            + name_of_node(node, mesh, fe_space) + " at t = " + shortest_text(time)
                            + ", which '" + catching.name
                            + "' catches wherever it is then. Let the other one go before (Handles/"
                            + (&catching == &handle ? other : handle).name
                            + "/Until), or change a Select so that they do not overlap.");
        }
  }
} // namespace Exemplar
