// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/shell_body.h>

#include <algorithm>
#include <cmath>

// What the loops over a shell read.

namespace Exemplar
{
  namespace
  {
    /// Call function(place, i) for the places of n things in batches, those behind the last one with the last one.
    template <typename Function>
    void
    for_each_lane(const std::size_t n, const Function &function)
    {
      for (std::size_t place = 0; n > 0 && place < batched_size(n, 1); ++place)
        function(place, std::min(place, n - 1));
    }

    template <typename Array>
    std::size_t
    bytes_of(const Array &array)
    {
      return array.capacity() * sizeof(array[0]);
    }
  } // namespace

  void
  ShellBody::write_hinges()
  {
    const std::vector<ShellHinge> &hinges = strains.get_hinges();
    const std::size_t              n
        = std::max<std::size_t>(hinges.size(), 1); // with one that nothing reads, if there is none
    arrays.hinge_nodes.assign(batched_size(n, 4), 0);
    for (auto *const numbers : { &arrays.rest_angles, &arrays.last_angles, &arrays.changes })
    {
      numbers->resize(batched_size(n, 1));
      numbers->fill(0.);
    }
    arrays.forms.resize(batched_size(n, 12));
    arrays.lengths.resize(batched_size(n, 4));
    for_each_lane(hinges.size(),
                  [&](const std::size_t place, const std::size_t h)
                  {
                    for (unsigned int i = 0; i < 4; ++i)
                      arrays.hinge_nodes[batch_index(place, 4, i)] = hinges[h].nodes[i];
                    arrays.rest_angles[place] = hinges[h].rest - hinges[h].shift;
                  });
    write_branches();
    const std::size_t n_triangles = parts.mesh.triangles().size();
    for (auto *const places : { &arrays.nodes, &arrays.hinges, &arrays.slopes })
      places->assign(batched_size(n_triangles, 3), 0);
    arrays.strains.resize(batched_size(n_triangles, n_shell_strains));
    arrays.targets.resize(batched_size(n_triangles, n_shell_strains));
    arrays.areas.resize(batched_size(n_triangles, 1));
    arrays.frames.resize(batched_size(n_triangles, 9));
    arrays.found.resize(batched_size(n_triangles, TriangleResult::size));
    for_each_lane(n_triangles,
                  [&](const std::size_t place, const std::size_t t)
                  {
                    for (unsigned int i = 0; i < 3; ++i)
                    {
                      const std::size_t at   = batch_index(place, 3, i);
                      const ShellTurn  &turn = strains.turns(t)[i];
                      arrays.nodes[at]       = parts.mesh.triangles()[t].nodes[i];
                      arrays.hinges[at]      = std::max(turn.hinge, 0);
                      arrays.slopes[at]      = std::max(turn.slope, 0);
                    }
                  });
  }

  void
  ShellBody::write_branches()
  {
    for_each_lane(
        strains.get_hinges().size(), [&](const std::size_t place, const std::size_t h)
        { arrays.last_angles[place] = strains.last_angle(h) - strains.get_hinges()[h].shift; });
  }

  void
  ShellBody::write_triangles()
  {
    const std::vector<ShellTriangle> &all = parts.mesh.triangles();
    arrays.rest.resize(batched_size(all.size(), TriangleNumber::size));
    scales_at_rest.resize(all.size());
    for_each_lane(all.size(),
                  [&](const std::size_t place, const std::size_t t)
                  {
                    const ShellTriangle &triangle = all[t];
                    const auto           set = [&](const std::size_t number, const double value)
                    { arrays.rest[batch_index(place, TriangleNumber::size, number)] = value; };
                    for (unsigned int i = 0; i < 3; ++i)
                    {
                      const auto &g = triangle.gradients[i];
                      const auto &b = triangle.bending[i];
                      for (unsigned int j = 0; j < 2; ++j)
                        set(TriangleNumber::gradients + 2 * i + j, g[j]);
                      for (unsigned int k = 0; k < 3; ++k)
                        set(TriangleNumber::bending + 3 * i + k, b[k]);
                      set(TriangleNumber::lengths + i, triangle.lengths[i]);
                      set(TriangleNumber::of_hinge + i, strains.turns(t)[i].of_hinge);
                      set(TriangleNumber::of_slope + i, strains.turns(t)[i].of_slope);
                      scales_at_rest[t][i] = std::hypot(g[0], g[1]);
                      scales_at_rest[t][3 + i]
                          = std::sqrt(b[0] * b[0] + b[1] * b[1] + 2. * b[2] * b[2]);
                    }
                    set(TriangleNumber::lambda, elasticities[t].lambda);
                    set(TriangleNumber::mu, elasticities[t].mu);
                    set(TriangleNumber::volume, triangle.volume());
                  });
  }

  std::size_t
  ShellBody::memory_of_arrays() const
  {
    return bytes_of(arrays.hinge_nodes) + bytes_of(arrays.nodes) + bytes_of(arrays.hinges)
           + bytes_of(arrays.slopes) + bytes_of(arrays.rest_angles) + bytes_of(arrays.last_angles)
           + bytes_of(arrays.changes) + bytes_of(arrays.forms) + bytes_of(arrays.lengths)
           + bytes_of(arrays.rest) + bytes_of(arrays.past) + bytes_of(arrays.strains)
           + bytes_of(arrays.targets) + bytes_of(arrays.areas) + bytes_of(arrays.frames)
           + bytes_of(arrays.found) + bytes_of(arrays.products) + bytes_of(scales_at_rest)
           + bytes_of(moments) + bytes_of(moment_scales);
  }
} // namespace Exemplar
