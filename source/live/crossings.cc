// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/crossings.h>
#include <exemplar/obstacles/box_tree.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace Exemplar::Live
{
  namespace
  {
    using TriangleList = std::vector<std::array<unsigned int, 3>>;
    using EdgeEnds     = std::array<unsigned int, 2>;
    using Tensor1      = dealii::Tensor<1, 3>;

    /// Number of an edge, and of a triangle that it passes through, with the depth [m].
    struct Crossing
    {
      std::pair<unsigned int, unsigned int> pair;
      double                                depth;
    };

    std::vector<EdgeEnds>
    edges_of(const TriangleList &triangles)
    {
      std::set<EdgeEnds> edges;
      for (const auto &t : triangles)
        for (unsigned int i = 0; i < 3; ++i)
          edges.insert(
              EdgeEnds{ { std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3]) } });
      return { edges.begin(), edges.end() };
    }

    /// How deep the edge from p to q is in a triangle; 0: it does not pass through it.
    double
    depth_of(const Tensor1 &p, const Tensor1 &q, const std::array<Tensor1, 3> &corners)
    {
      const Tensor1 across
          = dealii::cross_product_3d(corners[1] - corners[0], corners[2] - corners[0]);
      const double size = across.norm();
      const double a = across * (p - corners[0]), b = across * (q - corners[0]);
      if (!(size > 0.) || !(a * b < 0.))
        return 0.;
      const Tensor1 x = p + a / (a - b) * (q - p);
      for (unsigned int i = 0; i < 3; ++i)
        if (across * dealii::cross_product_3d(corners[(i + 1) % 3] - corners[i], x - corners[i])
            < 0.)
          return 0.;
      return std::min(std::abs(a), std::abs(b)) / size;
    }

    std::vector<Crossing>
    crossings_in(const TriangleList          &triangles,
                 const std::vector<EdgeEnds> &edges,
                 const Places                &places)
    {
      std::vector<AxisBox> boxes(triangles.size());
      for (std::size_t t = 0; t < triangles.size(); ++t)
        for (const unsigned int v : triangles[t])
          boxes[t].add(places[v]);
      const BoxTree         tree(boxes);
      std::vector<Crossing> found;
      for (unsigned int e = 0; e < edges.size(); ++e)
      {
        AxisBox box;
        for (const unsigned int v : edges[e])
          box.add(places[v]);
        tree.visit(box,
                   [&](const unsigned int t)
                   {
                     const auto &[i, j, k] = triangles[t];
                     for (const unsigned int v : edges[e])
                       if (v == i || v == j || v == k)
                         return;
                     const double depth = depth_of(places[edges[e][0]], places[edges[e][1]],
                                                   { { places[i], places[j], places[k] } });
                     if (depth > 0.)
                       found.push_back({ { e, t }, depth });
                   });
      }
      return found;
    }
  } // namespace

  Crossings
  crossings_of(const TriangleList        &triangles,
               const std::vector<Places> &picture,
               const std::vector<Places> &run)
  {
    const std::vector<EdgeEnds> edges = edges_of(triangles);
    Crossings                   result;
    for (std::size_t frame = 0; frame < picture.size(); ++frame)
    {
      const std::vector<Crossing> shown = crossings_in(triangles, edges, picture[frame]);
      if (shown.empty())
        continue;
      std::set<std::pair<unsigned int, unsigned int>> of_run;
      for (const Crossing &crossing : crossings_in(triangles, edges, run[frame]))
        of_run.insert(crossing.pair);
      double deepest = 0.;
      for (const Crossing &crossing : shown)
        if (of_run.count(crossing.pair) == 0)
          deepest = std::max(deepest, crossing.depth);
      result.n_frames += deepest > 0. ? 1 : 0;
      result.deepest = std::max(result.deepest, deepest);
    }
    return result;
  }

  Crossings
  crossings_of(const RunMotion &motion, const KeyedShapes &shapes)
  {
    std::vector<std::array<unsigned int, 3>> triangles;
    const auto                               add
        = [&](const std::vector<std::vector<unsigned int>> &polygons, const std::size_t first)
    {
      for (const auto &polygon : polygons)
        for (std::size_t k = 2; k < polygon.size(); ++k)
          triangles.push_back({ { static_cast<unsigned int>(first + polygon[0]),
                                  static_cast<unsigned int>(first + polygon[k - 1]),
                                  static_cast<unsigned int>(first + polygon[k]) } });
    };
    const bool with_obstacles = motion.obstacle_frames.size() == motion.frames.size();
    // what is worn may pass into the body
    add(motion.surfaces.front().surface.faces, 0);
    if (with_obstacles)
      add(motion.obstacles, motion.rest.size());
    std::vector<Places> picture, run = motion.frames;
    for (std::size_t frame = 0; frame < run.size(); ++frame)
    {
      picture.push_back(shapes.places(frame));
      for (Places *places : { &picture.back(), &run[frame] })
        if (with_obstacles)
          places->insert(places->end(), motion.obstacle_frames[frame].begin(),
                         motion.obstacle_frames[frame].end());
    }
    return crossings_of(triangles, picture, run);
  }
} // namespace Exemplar::Live
