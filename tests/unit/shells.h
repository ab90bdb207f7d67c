// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_shells_h
#define exemplar_tests_shells_h

#include <exemplar/body/shell_strains.h>

#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <vector>

// Small shells, and states of them.
namespace Exemplar::Testing
{
  using Place = Vector3<double>;

  /// A rectangle of two triangles a cell, which a function places; with `alternating` diagonals turn
  /// from cell to cell.
  inline ShellMesh
  rectangle(const unsigned int                              nx,
            const unsigned int                              ny,
            const std::function<Place(double x, double y)> &place,
            const double                                    thickness,
            const bool                                      alternating = false,
            const ShellKind                                 kind        = ShellKind::plate)
  {
    std::vector<Place>                       vertices;
    std::vector<std::array<unsigned int, 3>> triangles;
    for (unsigned int j = 0; j <= ny; ++j)
      for (unsigned int i = 0; i <= nx; ++i)
        vertices.push_back(place(static_cast<double>(i) / nx, static_cast<double>(j) / ny));
    for (unsigned int j = 0; j < ny; ++j)
      for (unsigned int i = 0; i < nx; ++i)
      {
        const unsigned int a = j * (nx + 1) + i, b = a + 1, c = a + nx + 2, d = a + nx + 1;
        if (alternating && (i + j) % 2 == 1)
          triangles.insert(triangles.end(), { { { a, b, d } }, { { b, c, d } } });
        else
          triangles.insert(triangles.end(), { { { a, b, c } }, { { a, c, d } } });
      }
    return { vertices, triangles, std::vector<double>(triangles.size(), thickness), kind };
  }

  /// A curved patch with triangles of all shapes.
  inline ShellMesh
  bumpy_patch(const ShellKind kind = ShellKind::plate)
  {
    std::mt19937                     engine(7);
    std::uniform_real_distribution<> random(-0.04, 0.04);
    return rectangle(
        4, 3,
        [&](const double x, const double y)
        {
          return Place{ { x + random(engine), 0.8 * y + random(engine),
                          0.3 * std::sin(3. * x) * y + random(engine) } };
        },
        0.05, true, kind);
  }

  /// A closed surface around a volume: an octahedron whose edges are halved, moved here and there.
  inline ShellMesh
  bumpy_ball(const ShellKind kind = ShellKind::plate)
  {
    std::mt19937                                  engine(9);
    std::uniform_real_distribution<>              random(-0.05, 0.05);
    std::vector<Place>                            corners, vertices;
    std::vector<std::array<unsigned int, 3>>      triangles;
    std::map<std::array<double, 3>, unsigned int> numbers;
    const auto                                    number_of = [&](const Place &x)
    {
      const auto [found, is_new]
          = numbers.emplace(std::array<double, 3>{ { x[0], x[1], x[2] } }, vertices.size());
      if (is_new)
        vertices.push_back(combine(1. / norm(x), x, 1.,
                                   Place{ { random(engine), random(engine), random(engine) } }));
      return found->second;
    };
    for (const double x : { -1., 1. })
      for (const double y : { -1., 1. })
        for (const double z : { -1., 1. })
        {
          Place       a{ { x, 0., 0. } }, b{ { 0., y, 0. } };
          const Place c{ { 0., 0., z } };
          if (x * y * z < 0.)
            std::swap(a, b);
          const auto middle
              = [](const Place &p, const Place &q) { return combine(0.5, p, 0.5, q); };
          const std::array<unsigned int, 6> n{ { number_of(a), number_of(b), number_of(c),
                                                 number_of(middle(a, b)), number_of(middle(b, c)),
                                                 number_of(middle(c, a)) } };
          triangles.insert(triangles.end(), { { { n[0], n[3], n[5] } },
                                              { { n[3], n[1], n[4] } },
                                              { { n[5], n[4], n[2] } },
                                              { { n[3], n[4], n[5] } } });
        }
    return { vertices, triangles, std::vector<double>(triangles.size(), 0.05), kind };
  }

  /// At rest, with slope nodes as they are told.
  inline Vector
  rest_positions(const ShellStrains &strains)
  {
    const ShellMesh &mesh = strains.get_mesh();
    Vector           positions(3 * mesh.n_nodes());
    const auto       set = [&](const unsigned int node, const Place &place)
    {
      for (int c = 0; c < 3; ++c)
        positions[3 * node + c] = place[c];
    };
    for (unsigned int i = 0; i < mesh.n_vertices(); ++i)
      set(i, mesh.vertex(i));
    for (unsigned int edge = 0; edge < mesh.edges().size(); ++edge)
      if (strains.is_held(edge))
        set(mesh.slope_node(edge), mesh.tip(edge));
    return positions;
  }

  /// A state away from that: vertices bent by a function, then all moved at random by `size` [m].
  inline Vector
  disturbed(
      const ShellStrains                        &strains,
      const double                               size,
      const std::function<Place(const Place &)> &bend = [](const Place &x) { return x; })
  {
    Vector                           positions = rest_positions(strains);
    const ShellMesh                 &mesh      = strains.get_mesh();
    std::mt19937                     engine(3);
    std::uniform_real_distribution<> random(-size, size);
    for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
    {
      const bool is_slope = node >= mesh.n_vertices() && !strains.is_held(node - mesh.n_vertices());
      const Place x       = is_slope ? Place{} : bend(place_in(positions, node));
      for (int c = 0; c < (is_slope ? 1 : 3); ++c)
        positions[3 * node + c] = x[c] + random(engine);
    }
    return positions;
  }

  /// Every n-th edge, from the first on.
  inline HeldTips
  every(const unsigned int n, const ShellMesh &mesh)
  {
    HeldTips held(mesh.edges().size(), 0);
    for (std::size_t edge = 0; edge < held.size(); edge += n)
      held[edge] = held_in_space;
    return held;
  }
} // namespace Exemplar::Testing

#endif
