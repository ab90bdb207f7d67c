// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/skin/surface_anchors.h>

#include "fold_bodies.h"

#include <gtest/gtest.h>

#include <map>

namespace Exemplar::Testing
{
  namespace
  {
    /// The bar from x = 1 on split into two limbs, z > 0.1 and z < -0.1.
    Mesh
    forked_bar()
    {
      const Mesh                               bar = small_bar(5);
      std::vector<std::array<unsigned int, 4>> cells;
      std::map<unsigned int, unsigned int>     number;
      std::vector<dealii::Point<3>>            nodes;
      for (auto cell : bar.get_cells())
      {
        dealii::Point<3> middle;
        for (const unsigned int node : cell)
          middle += .25 * bar.get_nodes()[node];
        if (middle[0] > 1. && std::abs(middle[2]) < .1)
          continue;
        for (unsigned int &node : cell)
        {
          const auto added = number.emplace(node, nodes.size());
          if (added.second)
            nodes.push_back(bar.get_nodes()[node]);
          node = added.first->second;
        }
        cells.push_back(cell);
      }
      return Mesh(make_msh(nodes, cells), "fork.msh");
    }

    TEST(SurfaceAnchors, AVertexStaysOnItsLimbWhereAnotherIsNearer)
    {
      const Mesh fork = forked_bar();
      for (const double z : { -.06, -.14 }) // nearer to the other limb, inside it
        for (const bool inside_out : { false, true })
        {
          SurfaceMesh              surface = boundary_as_surface(fork);
          std::vector<std::size_t> moved;
          for (std::size_t v = 0; v < surface.vertices.size(); ++v)
            if (auto &x = surface.vertices[v];
                x[0] > 1.3 && x[0] < 3.9 && std::abs(x[1]) < .4 && std::abs(x[2] - .1) < 1e-9)
            {
              x[2] = z;
              moved.push_back(v);
            }
          if (inside_out)
            for (auto &face : surface.faces)
              std::swap(face[0], face[1]);
          ASSERT_GT(moved.size(), 10u);
          const auto anchors = find_anchors(surface, fork);
          for (const std::size_t v : moved)
          {
            const auto &x = surface.vertices[v];
            // the edge of what has moved is steep, and faces other ways
            if (x[0] > 1.5 && x[0] < 3.7 && std::abs(x[1]) < .2)
            {
              EXPECT_NEAR(anchors[v].place[2], .1, 1e-9);
            }
          }
        }
    }

    TEST(SurfaceAnchors, AVertexOnAnInnerShellStaysInItsCell)
    {
      // a shell inside a bar, its faces looking inwards as those of a cavity do
      const Mesh  bar   = small_bar(3);
      SurfaceMesh shell = boundary_as_surface(small_bar(2));
      for (auto &x : shell.vertices)
        x = { { .2 + .9 * x[0], .7 * x[1], .7 * x[2] } };
      SurfaceMesh    both = boundary_as_surface(bar);
      const unsigned n    = both.vertices.size();
      both.vertices.insert(both.vertices.end(), shell.vertices.begin(), shell.vertices.end());
      for (const auto &face : shell.faces)
        both.faces.push_back({ n + face[1], n + face[0], n + face[2] });
      const auto anchors = find_anchors(both, bar);
      for (std::size_t v = 0; v < both.vertices.size(); ++v)
        for (unsigned int c = 0; c < 3; ++c)
          EXPECT_NEAR(anchors[v].place[c], both.vertices[v][c], 1e-12);
    }
  } // namespace
} // namespace Exemplar::Testing
