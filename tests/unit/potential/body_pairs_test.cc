// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/barrier.h>
#include <exemplar/potential/body_pair_search.h>
#include <exemplar/potential/contact_forces.h>

#include "meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace Exemplar::Testing
{
  namespace
  {
    using Corners4 = std::array<SpaceVector3, 4>;

    SpaceVector3
    random_vector(std::mt19937 &generator, const double size)
    {
      std::uniform_real_distribution<double> number(-size, size);
      SpaceVector3                           result;
      for (unsigned int c = 0; c < 3; ++c)
        result[c] = number(generator);
      return result;
    }

    /// A surface of one pair alone: a triangle 0, 1, 2 and a node 3, or edges 0, 1 and 2, 3, of the sizes of a meter at rest.
    class OnePair
    {
    public:
      explicit OnePair(const BodyPairKind kind, const double width = 0.5)
          : mesh(two_tetrahedra(), "bar.msh"), fe_space(mesh), surface(mesh, fe_space),
            contacts(parameters(), mesh, fe_space)
      {
        contacts.width  = width;
        contacts.widths = { width };
        surface.nodes.clear();
        for (const unsigned int node : { 0U, 1U, 2U, 3U, 4U })
          surface.nodes.push_back({ node, 0.5, 0., 300. });
        // each part belongs to a triangle
        if (kind == BodyPairKind::edge_edge)
        {
          surface.triangles
              = { { { { 0, 1, 4 } }, 0, 0.8, 0., 400. }, { { { 2, 3, 4 } }, 0, 0.8, 0., 400. } };
          set_edges({ { { 0, 1 } },
                      { { 0, 4 } },
                      { { 1, 4 } },
                      { { 2, 3 } },
                      { { 2, 4 } },
                      { { 3, 4 } } });
          surface.edges[0] = { { { 0, 1 } }, 1.2, 0.4, 0., 200. };
          surface.edges[3] = { { { 2, 3 } }, 0.7, 0.2, 0., 300. };
          leave_out_all_but({ kind, 0, 3 });
        }
        else
        {
          surface.triangles
              = { { { { 0, 1, 2 } }, 0, 0.8, 0., 400. }, { { { 0, 3, 4 } }, 0, 0.8, 0., 400. } };
          set_edges({ { { 0, 1 } },
                      { { 0, 2 } },
                      { { 0, 3 } },
                      { { 0, 4 } },
                      { { 1, 2 } },
                      { { 3, 4 } } });
          leave_out_all_but({ kind, 3, 0 });
        }
      }

      std::vector<BodyTouch>
      touches(const Corners4 &x, const double range = 1.) const
      {
        KeptBodyPairs          kept;
        std::vector<BodyTouch> result;
        BodyPairSearch(surface, contacts, kept).append(positions_of(x), range, result);
        return result;
      }

      BodyPairSearch::Limit
      max_step(const Corners4 &x, const Corners4 &ways) const
      {
        KeptBodyPairs kept;
        return BodyPairSearch(surface, contacts, kept)
            .max_step(positions_of(x), positions_of(ways));
      }

    private:
      void
      set_edges(const std::vector<std::array<unsigned int, 2>> &all)
      {
        surface.edges.clear();
        for (const auto &nodes : all)
          surface.edges.push_back({ nodes, 1., 0.3, 0., 200. });
      }

      void
      leave_out_all_but(const BodyPair &wanted)
      {
        const auto leave_out = [&](const BodyPair &pair)
        {
          if (pair.key() != wanted.key())
            contacts.own_widths[pair.key()] = 0.;
        };
        for (unsigned int i = 0; i < surface.nodes.size(); ++i)
          for (unsigned int t = 0; t < surface.triangles.size(); ++t)
            leave_out({ BodyPairKind::node_triangle, i, t });
        for (unsigned int i = 0; i < surface.edges.size(); ++i)
          for (unsigned int j = i + 1; j < surface.edges.size(); ++j)
            leave_out({ BodyPairKind::edge_edge, i, j });
      }

      static ContactParameters
      parameters()
      {
        ContactParameters result;
        result.self = true;
        return result;
      }

      static Vector
      positions_of(const Corners4 &x)
      {
        Vector result(15);
        for (unsigned int i = 0; i < 4; ++i)
          for (unsigned int c = 0; c < 3; ++c)
            result[3 * i + c] = x[i][c];
        return result;
      }

      Mesh           mesh;
      FESpace        fe_space;
      ContactSurface surface;
      BodyContacts   contacts;
    };

    /// Corners of a pair that is near itself: anywhere, or edges that are almost or wholly parallel and triangles without much area.
    Corners4
    random_corners(std::mt19937 &generator, const BodyPairKind kind, const unsigned int sample)
    {
      Corners4 x;
      for (SpaceVector3 &corner : x)
        corner = random_vector(generator, 0.5);
      const double thin = sample % 3 == 0 ? 1. : sample % 3 == 1 ? 1e-2 : 1e-4;
      if (kind == BodyPairKind::edge_edge && thin < 1.)
        x[3] = x[2] + (x[1] - x[0]) + random_vector(generator, thin);
      if (kind == BodyPairKind::node_triangle && thin < 1.)
        x[2] = 0.3 * x[0] + 0.7 * x[1] + random_vector(generator, thin);
      return x;
    }

    unsigned int
    region_of(const Nearest &at)
    {
      unsigned int region = at.n_free;
      for (unsigned int i = 0; i < 3; ++i)
        region = 9 * region + 3 * (at.a[i] > 0.) + (at.b[i] > 0.);
      return region;
    }

    /// Energies, gradients and second derivatives of random pairs against differences.
    void
    check_derivatives(const BodyPairKind kind)
    {
      const OnePair pair(kind);
      std::mt19937  generator(7);
      unsigned int  n_compared = 0, n_partial = 0;
      for (unsigned int sample = 0; sample < 6000; ++sample)
      {
        const Corners4 x   = random_corners(generator, kind, sample);
        const auto     all = pair.touches(x);
        if (all.empty() || all[0].gap.distance < 0.02)
          continue;
        const BodyTouch &touch = all[0];
        Corners4         v;
        for (SpaceVector3 &way : v)
          way = random_vector(generator, 1.);
        // what is thin changes over small lengths
        const double h     = (sample % 3 == 2 ? 1e-8 : 1e-6);
        const auto   moved = [&](const double part)
        {
          Corners4 y = x;
          for (unsigned int i = 0; i < 4; ++i)
            y[i] += part * v[i];
          return pair.touches(y, 1.1).at(0);
        };
        const BodyTouch before = moved(-h), after = moved(h);
        if (region_of(before.at.nearest) != region_of(after.at.nearest))
          continue; // where the second derivative jumps
        const ContactGradient gradient = gradient_of(touch), gradient_before = gradient_of(before),
                              gradient_after = gradient_of(after);
        const ContactHessian hessian         = hessian_of(touch, Tangent::exact);
        double               slope = 0., size = 0., curvature = 0., size_of_curvature = 0.;
        SpaceVector3         force;
        for (unsigned int i = 0; i < 4; ++i)
        {
          // by the numbers of the nodes: the triangle's come first
          slope += gradient[i] * v[touch.gap.nodes[i]];
          size += gradient[i].norm();
          force += gradient[i];
          for (unsigned int j = 0; j < 4; ++j)
          {
            curvature += v[touch.gap.nodes[i]] * (hessian[i][j] * v[touch.gap.nodes[j]]);
            size_of_curvature += hessian[i][j].norm();
          }
        }
        double change = 0.;
        for (unsigned int i = 0; i < 4; ++i)
          change += (gradient_after[i] - gradient_before[i]) * v[touch.gap.nodes[i]];
        const double rounding = 1e-15 * touch.full_stiffness / h;
        EXPECT_NEAR((energy_of(after) - energy_of(before)) / (2. * h), slope,
                    1e-6 * size + rounding)
            << sample;
        EXPECT_NEAR(change / (2. * h), curvature, 2e-5 * size_of_curvature + 1e2 * rounding)
            << sample;
        EXPECT_LT(force.norm(), 1e-12 * size);
        EXPECT_GT(touch.full_stiffness, 0.);
        ++n_compared;
        n_partial += touch.part.m < 1.;
      }
      EXPECT_GT(n_compared, 1500U);
      EXPECT_GE(n_partial, kind == BodyPairKind::edge_edge ? 500U : 0U);
    }
  } // namespace

  TEST(BodyPairs, DerivativesOfNodesAndTrianglesAreThoseOfTheEnergy)
  {
    check_derivatives(BodyPairKind::node_triangle);
  }

  TEST(BodyPairs, DerivativesOfEdgesAreThoseOfTheEnergy)
  {
    check_derivatives(BodyPairKind::edge_edge);
  }

  TEST(BodyPairs, StiffnessIsOfTheSofterSideAndTheLesserArea)
  {
    // nodes: 300 N over .5 m^2; the triangle 400 over .8; edges 200 over .4 and 300 over .2
    const Corners4 apart{ { SpaceVector3(), dealii::Point<3>(1., 0., 0.),
                            dealii::Point<3>(0., 1., 0.), dealii::Point<3>(0.2, 0.2, 0.1) } };
    EXPECT_DOUBLE_EQ(OnePair(BodyPairKind::node_triangle).touches(apart).at(0).full_stiffness,
                     0.1 * 500. * 0.5);
    EXPECT_DOUBLE_EQ(OnePair(BodyPairKind::edge_edge).touches(apart).at(0).full_stiffness,
                     0.1 * 500. * 0.2);
  }

  TEST(BodyPairs, NothingIsPassedOnTheWay)
  {
    for (const BodyPairKind kind : { BodyPairKind::node_triangle, BodyPairKind::edge_edge })
    {
      const OnePair pair(kind, 1e-3);
      std::mt19937  generator(3);
      unsigned int  n_met = 0;
      for (unsigned int sample = 0; sample < 3000; ++sample)
      {
        const Corners4 x = random_corners(generator, kind, sample);
        Corners4       ways;
        for (SpaceVector3 &way : ways)
          way = random_vector(generator, 2.);
        const BodyPairSearch::Limit limit = pair.max_step(x, ways);
        // the least distance on a fine grid of the way that is allowed
        double       least = std::numeric_limits<double>::infinity(), last = 0.;
        const double first = pair.touches(x, 1e5).at(0).gap.distance;
        for (unsigned int i = 0; i <= 200; ++i)
        {
          Corners4 y = x;
          for (unsigned int k = 0; k < 4; ++k)
            y[k] += limit.part * i / 200. * ways[k];
          const auto there = pair.touches(y, 1e5);
          last             = there.at(0).gap.distance;
          least            = std::min(least, last);
        }
        // a tenth of the distance is left at the end, and on the way a tenth of what was left before
        EXPECT_GE(last, 0.0999 * first) << sample;
        EXPECT_GE(least, 0.00999 * first) << sample;
        EXPECT_EQ(limit.is_met, limit.part < 1.);
        n_met += limit.is_met;
      }
      EXPECT_GT(n_met, 100U);
    }
  }

  TEST(BodyPairs, WhatIsKeptChangesNoResult)
  {
    const Mesh        mesh(two_tetrahedra(), "bar.msh");
    const FESpace     fe_space(mesh);
    ContactParameters parameters;
    parameters.self     = true;
    parameters.distance = "0.15";
    ContactSurface surface(mesh, fe_space);
    BodyContacts   contacts(parameters, mesh, fe_space);
    KeptBodyPairs  kept;
    std::mt19937   generator(5);
    Vector         x = fe_space.rest_positions();
    for (unsigned int step = 0; step < 300; ++step)
    {
      for (unsigned int node = 0; node < 5; ++node)
      {
        const SpaceVector3 way = random_vector(generator, 0.03);
        for (unsigned int c = 0; c < 3; ++c)
          x[3 * node + c] += way[c] + 0.2; // all of it moves on
      }
      KeptBodyPairs          none;
      std::vector<BodyTouch> with, without;
      BodyPairSearch(surface, contacts, kept).append(x, 1. + step % 3, with);
      BodyPairSearch(surface, contacts, none).append(x, 1. + step % 3, without);
      ASSERT_EQ(with.size(), without.size());
      for (std::size_t i = 0; i < with.size(); ++i)
      {
        EXPECT_EQ(with[i].pair.key(), without[i].pair.key());
        EXPECT_EQ(with[i].gap.distance, without[i].gap.distance);
      }
    }
  }
} // namespace Exemplar::Testing
