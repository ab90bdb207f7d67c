// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/handle_nodes.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

namespace Exemplar
{
  Motion
  at_middles_too(const Motion                    &motion,
                 const std::vector<unsigned int> &nodes,
                 const FESpace                   &fe_space)
  {
    if (fe_space.is_shell())
      return motion; // tips of normals are places of their own
    const auto position = [&](const unsigned int node)
    { return std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin(); };
    const auto n_vertices = static_cast<std::size_t>(position(fe_space.numbering().n_vertices()));

    std::vector<std::array<std::size_t, 2>> ends; // ends of the edges, as indices into `nodes`
    for (std::size_t i = n_vertices; i < nodes.size(); ++i)
    {
      const auto &[a, b] = fe_space.numbering().ends(nodes[i]);
      ends.push_back(
          { { static_cast<std::size_t>(position(a)), static_cast<std::size_t>(position(b)) } });
    }
    return [=](const std::vector<dealii::Point<3>> &rest, const double time)
    {
      const auto                        end    = rest.begin() + std::ptrdiff_t(n_vertices);
      std::vector<dealii::Tensor<1, 3>> result = motion({ rest.begin(), end }, time);
      for (const auto &[a, b] : ends)
        result.push_back(0.5 * (result.at(a) + result.at(b)));
      return result;
    };
  }

  namespace
  {
    /// 1 for the nodes of a handle, else 0, for the whole body.
    std::vector<double>
    whole_mask(const std::vector<unsigned int> &nodes, const FESpace &fe_space)
    {
      std::vector<double> mask(fe_space.n_nodes(), 0.);
      for (const unsigned int node : nodes)
        mask[node] = 1.;
      return fe_space.exchange().whole(mask.data(), 1, mask.size(), true);
    }

  } // namespace

  std::vector<dealii::Point<3>>
  whole_handle(const std::vector<unsigned int>     &nodes,
               const std::vector<dealii::Point<3>> &places,
               const FESpace                       &fe_space)
  {
    Vector field(fe_space.n_dofs());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (unsigned int c = 0; c < 3; ++c)
        field[3 * nodes[i] + c] = places[i][c];
    const Vector                  all  = whole(fe_space.exchange(), field, true);
    const std::vector<double>     mask = whole_mask(nodes, fe_space);
    std::vector<dealii::Point<3>> chosen;
    for (std::size_t node = 0; node < mask.size(); ++node)
      if (mask[node] > 0.)
        chosen.emplace_back(all[3 * node], all[3 * node + 1], all[3 * node + 2]);
    return chosen;
  }

  std::vector<unsigned int>
  places_in_whole(const std::vector<unsigned int> &nodes, const FESpace &fe_space)
  {
    std::vector<double> n_before = whole_mask(nodes, fe_space);
    double              n        = 0.;
    for (double &entry : n_before)
      n += std::exchange(entry, n);
    const std::vector<double> own = fe_space.exchange().part(std::move(n_before), 1);
    std::vector<unsigned int> places;
    for (const unsigned int node : nodes)
      places.push_back(static_cast<unsigned int>(own[node]));
    return places;
  }

  std::string
  name_of_node(const unsigned int node, const Mesh &mesh, const FESpace &fe_space)
  {
    const auto number
        = [&](const unsigned int vertex) { return mesh.get_contents().node_numbers[vertex]; };
    if (node < mesh.n_nodes())
      return fmt::format("node {}", number(node));
    const auto &[a, b] = fe_space.numbering().ends(node);
    return fmt::format("the middle between nodes {} and {}", number(a), number(b));
  }
} // namespace Exemplar
