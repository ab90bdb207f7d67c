// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/handle_overlaps.h>

#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

namespace Exemplar
{
  namespace
  {
    /// Advice for a handle that selects the whole body.
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

  namespace
  {
    /// A node that two handles must not both hold.
    struct Conflict
    {
      unsigned int first, second; ///< indices of the two handles
      unsigned int node;
    };

    /// A conflict in the form that is the same on all processes.
    struct AgreedConflict
    {
      const Handle &first, &second;
      std::string   node; ///< name_of_node()
    };

    /// Index of a local node in the whole body.
    std::size_t
    index_in_whole(const unsigned int node, const FESpace &fe_space)
    {
      const Exchange     &exchange = fe_space.exchange();
      std::vector<double> indices(exchange.n_nodes(fe_space.n_nodes()));
      std::iota(indices.begin(), indices.end(), 0.);
      return static_cast<std::size_t>(exchange.part(std::move(indices), 1)[node]);
    }

    /// Agree on one conflict of all processes: the first in the order of second handles and their
    /// nodes, which a single process would find, so that the message does not depend on the number
    /// of processes. Collective.
    std::optional<AgreedConflict>
    agree(const std::optional<Conflict> &own,
          const std::vector<Handle>     &handles,
          const Mesh                    &mesh,
          const FESpace                 &fe_space)
    {
      constexpr double none     = std::numeric_limits<double>::max();
      const Exchange  &exchange = fe_space.exchange();
      const double     n_nodes  = exchange.n_nodes(fe_space.n_nodes());
      const double     place
          = own ? own->second * n_nodes + static_cast<double>(index_in_whole(own->node, fe_space))
                : none;
      const double first = min_of_all(exchange, place);
      if (first == none)
        return {};
      const bool is_own = place == first;
      const auto handle = [&](const unsigned int number) -> const Handle &
      { return handles[static_cast<std::size_t>(exchange.max(number))]; };
      const Handle &other   = handle(is_own ? own->first : 0);
      const Handle &holding = handle(is_own ? own->second : 0);
      return AgreedConflict{
        other, holding, exchange.first_text(is_own ? name_of_node(own->node, mesh, fe_space) : "")
      };
    }

    std::optional<Conflict>
    find_disagreement(const std::vector<Handle>                            &handles,
                      const std::set<unsigned int>                         &shared,
                      const std::vector<std::vector<dealii::Tensor<1, 3>>> &displacements,
                      const double                                          tolerance)
    {
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
            const Target target = { displacement[c], h };
            const Target first  = targets.emplace(3 * node + c, target).first->second;
            if (std::abs(first.displacement - displacement[c]) > tolerance)
              return Conflict{ first.handle, h, node };
          }
        }
      return {};
    }

    /// The handle of the two that has caught the shared node by this time, or null.
    const Handle *
    find_catching(const Handle &first,
                  const Handle &second,
                  const double  time,
                  const double  rounding)
    {
      for (const Handle *handle : { &second, &first })
        if (handle->time.has_caught(time, rounding))
          return handle;
      return nullptr;
    }

    std::optional<Conflict>
    find_shared_catch(const std::vector<Handle> &handles, const double time, const double rounding)
    {
      std::map<unsigned int, unsigned int> holders;
      for (unsigned int h = 0; h < handles.size(); ++h)
        for (const unsigned int node : handles[h].held_nodes())
          for (const unsigned int c : handles[h].components)
          {
            const auto [first, is_new] = holders.emplace(3 * node + c, h);
            if (!is_new && find_catching(handles[first->second], handles[h], time, rounding))
              return Conflict{ first->second, h, node };
          }
      return {};
    }
  } // namespace

  void
  check_agreement(const std::vector<Handle>                            &handles,
                  const std::set<unsigned int>                         &shared,
                  const std::vector<std::vector<dealii::Tensor<1, 3>>> &displacements,
                  const double                                          time,
                  const Mesh                                           &mesh,
                  const FESpace                                        &fe_space)
  {
    const auto conflict
        = agree(find_disagreement(handles, shared, displacements, 1e-10 * mesh.diameter()), handles,
                mesh, fe_space);
    if (!conflict)
      return;
    const auto &[first, second, node] = *conflict;
    std::string remedy = ". Change Handles/" + second.name + "/Select so that they do not overlap.";
    for (const Handle *handle : { &second, &first })
      if (!fe_space.exchange().any(handle->nodes.size() < fe_space.n_nodes()))
        remedy = remedy_of_all(handle->name);
    throw UserError("Handles '" + first.name + "' and '" + second.name + "' both hold " + node
                    + ", but move it differently at t = " + shortest_text(time) + remedy);
  }

  void
  refuse_shared_catches(const std::vector<Handle> &handles,
                        const double               time,
                        const double               rounding,
                        const Mesh                &mesh,
                        const FESpace             &fe_space)
  {
    const auto conflict
        = agree(find_shared_catch(handles, time, rounding), handles, mesh, fe_space);
    if (!conflict)
      return;
    const auto &[first, second, node] = *conflict;
    const Handle &catching            = *find_catching(first, second, time, rounding);
    throw UserError("Handles '" + first.name + "' and '" + second.name + "' both hold " + node
                    + " at t = " + shortest_text(time) + ", which '" + catching.name
                    + "' catches wherever it is then. Let the other one go before (Handles/"
                    + (&catching == &second ? first : second).name
                    + "/Until), or change a Select so that they do not overlap.");
  }
} // namespace Exemplar
