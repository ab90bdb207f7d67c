// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/skin/own_sheets.h>

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    /// Strips of squares, 10 of 3 vertices each, which no face joins.
    SurfaceMesh
    strips(const unsigned int n_strips)
    {
      SurfaceMesh surface;
      for (unsigned int s = 0; s < n_strips; ++s)
        for (unsigned int i = 0; i < 10; ++i)
          for (unsigned int j = 0; j < 3; ++j)
          {
            const unsigned int v = 30 * s + 3 * i + j;
            surface.vertices.push_back({ { double(i), double(j), double(s) } });
            if (i < 9 && j < 2)
              surface.faces.push_back({ v, v + 1, v + 4, v + 3 });
          }
      return surface;
    }

    using Labels = std::vector<int>; ///< of each vertex, the sheet that carries it

    /// What becomes of the labels, and how often a vertex was moved.
    unsigned int
    n_moves(const SurfaceMesh &surface, Labels &labels)
    {
      unsigned int n = 0;
      put_on_own_sheets(
          surface,
          [&](const unsigned int a, const unsigned int b) { return labels[a] != labels[b]; },
          [&](const unsigned int v, const std::vector<unsigned int> &right)
          {
            ++n;
            for (const unsigned int w : right)
              EXPECT_EQ(labels[w], labels[right.front()]);
            labels[v] = labels[right.front()];
          });
      return n;
    }

    TEST(OwnSheets, AFewVerticesOnTheOtherSheetComeBackToThatOfTheirNeighbours)
    {
      Labels labels(30, 7);
      for (const unsigned int v : { 0, 3, 6, 9, 4, 7, 29 }) // a rim two wide, and a corner
        labels[v] = 1;
      EXPECT_EQ(n_moves(strips(1), labels), 7u);
      EXPECT_EQ(labels, Labels(30, 7));
    }

    TEST(OwnSheets, PartsThatNoFaceJoinsMayHangOnDifferentSheets)
    {
      Labels labels(60, 1);
      std::fill(labels.begin() + 30, labels.end(), 2);
      const Labels expected = labels;
      EXPECT_EQ(n_moves(strips(2), labels), 0u);
      labels[31] = 1;
      EXPECT_EQ(n_moves(strips(2), labels), 1u);
      EXPECT_EQ(labels, expected);
    }

    TEST(OwnSheets, AVertexOfNoFaceStaysWhereItIs)
    {
      SurfaceMesh surface = strips(1);
      surface.vertices.push_back({ { 0., 0., 9. } });
      Labels labels(31, 1);
      labels[30] = 2;
      EXPECT_EQ(n_moves(surface, labels), 0u);
      labels[4] = 2;
      EXPECT_EQ(n_moves(surface, labels), 1u);
      EXPECT_EQ(labels[30], 2);
    }
  } // namespace
} // namespace Exemplar::Testing
