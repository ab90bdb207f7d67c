// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/shape/surface_checks.h>
#include <exemplar/surface/shape/surface_edges.h>
#include <exemplar/surface/shape/surface_geometry.h>

#include <utility>

namespace Exemplar
{
  namespace
  {
    /// The triangles to turn so that neighbours agree: in each shell the minority.
    std::vector<bool>
    minority(const TriangleSurface &surface, const std::vector<TriangleSide> &sides)
    {
      const std::size_t                                       n = surface.triangles.size();
      std::vector<std::vector<std::pair<unsigned int, bool>>> neighbours(n); // true: agrees
      for_each_edge(sides,
                    [&](const TriangleSide *const first, const TriangleSide *const last)
                    {
                      if (last - first != 2)
                        return;
                      const bool agree = first[0].forward != first[1].forward;
                      neighbours[first[0].triangle].emplace_back(first[1].triangle, agree);
                      neighbours[first[1].triangle].emplace_back(first[0].triangle, agree);
                    });
      std::vector<bool> turn(n, false), seen(n, false);
      for (unsigned int seed = 0; seed < n; ++seed)
      {
        if (seen[seed])
          continue;
        std::vector<unsigned int> part{ seed };
        seen[seed]         = true;
        std::size_t n_turn = 0;
        for (std::size_t i = 0; i < part.size(); ++i)
        {
          n_turn += turn[part[i]] ? 1 : 0;
          for (const auto &[other, agree] : neighbours[part[i]])
            if (!seen[other])
            {
              seen[other] = true;
              turn[other] = turn[part[i]] == agree;
              part.push_back(other);
            }
        }
        if (2 * n_turn > part.size())
          for (const unsigned int t : part)
            turn[t] = !turn[t];
      }
      return turn;
    }
  } // namespace

  std::vector<unsigned int>
  turn_to_majority(TriangleSurface &surface)
  {
    const auto                turn = minority(surface, sorted_sides(surface));
    std::vector<unsigned int> turned;
    for (unsigned int t = 0; t < turn.size(); ++t)
      if (turn[t])
      {
        std::swap(surface.triangles[t][1], surface.triangles[t][2]);
        turned.push_back(t);
      }
    return turned;
  }

  unsigned int
  turn_outermost_outwards(TriangleSurface &surface)
  {
    std::vector<unsigned int> shells;
    const unsigned int        n        = number_shells(surface, sorted_sides(surface), shells);
    const auto                around   = enclosing_shells(surface, shells, n);
    unsigned int              n_turned = 0;
    for (unsigned int shell = 0; shell < n; ++shell)
    {
      if (around[shell] != n || enclosed_volume(shell_of(surface, shells, shell)) >= 0.)
        continue;
      ++n_turned;
      for (std::size_t t = 0; t < shells.size(); ++t)
        if (shells[t] == shell)
          std::swap(surface.triangles[t][1], surface.triangles[t][2]);
    }
    return n_turned;
  }

  void
  drop_unused_vertices(TriangleSurface &surface)
  {
    constexpr unsigned int    none = static_cast<unsigned int>(-1);
    std::vector<unsigned int> index(surface.vertices.size(), none);
    for (const auto &t : surface.triangles)
      for (const unsigned int vertex : t)
        index[vertex] = 0;
    unsigned int n = 0;
    for (std::size_t i = 0; i < index.size(); ++i)
      if (index[i] != none)
      {
        surface.vertices[n] = surface.vertices[i];
        index[i]            = n++;
      }
    surface.vertices.resize(n);
    for (auto &t : surface.triangles)
      for (unsigned int &vertex : t)
        vertex = index[vertex];
  }
} // namespace Exemplar
