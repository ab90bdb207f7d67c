// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "shell_scene.h"

// Shells of the literature. The deviations are the element's own: a script in numpy has the same ones.

namespace Exemplar::Testing
{
  namespace
  {
    using Marks = std::function<bool(const Place &)>;

    constexpr double rounding_of_place = 1e-9;

    bool
    is_at(const double x, const double place)
    {
      return std::abs(x - place) < rounding_of_place * (1. + std::abs(place));
    }

    /// The edges both of whose ends are in one of these planes of symmetry across an axis.
    HeldTips
    edges_in(const ShellMesh &mesh, const std::vector<std::pair<Marks, unsigned int>> &planes)
    {
      HeldTips held(mesh.edges().size(), 0);
      for (unsigned int edge = 0; edge < held.size(); ++edge)
        for (const auto &[marks, axis] : planes)
          if (marks(mesh.vertex(mesh.edges()[edge].begin))
              && marks(mesh.vertex(mesh.edges()[edge].end)))
            held[edge] = 1U << axis;
      return held;
    }

    /// Components of the marked vertices.
    std::vector<unsigned int>
    components(const ShellMesh                                                &mesh,
               const std::vector<std::pair<Marks, std::vector<unsigned int>>> &of)
    {
      std::vector<bool> found(3 * mesh.n_vertices(), false);
      for (const auto &[marks, components] : of)
        for (unsigned int i = 0; i < mesh.n_vertices(); ++i)
          if (marks(mesh.vertex(i)))
            for (const unsigned int c : components)
              found[3 * i + c] = true;
      std::vector<unsigned int> list;
      for (unsigned int dof = 0; dof < found.size(); ++dof)
        if (found[dof])
          list.push_back(dof);
      return list;
    }

    Vector
    small_displacements(ShellScene &scene, const Vector &load)
    {
      return scene.solve(
          scene.assemble(Tangent::exact, rest_positions(scene.body->get_strains()), {}), load);
    }

    /// A cylinder's part of angles up to `angle` from its top on and of a length, with triangles that
    /// share diagonals of one direction.
    ShellMesh
    cylinder(const unsigned int n,
             const double       radius,
             const double       angle,
             const double       length,
             const double       thickness)
    {
      return rectangle(
          n, n,
          [=](const double s, const double y) {
            return Place{ { radius * std::sin(angle * s), length * y,
                            radius * std::cos(angle * s) } };
          },
          thickness);
    }

    double
    scordelis_lo(const unsigned int n)
    {
      const double    angle = 40. * std::acos(-1.) / 180.;
      const ShellMesh mesh  = cylinder(n, 25., angle, 25., 0.25);
      const Marks     top   = [](const Place &x) { return is_at(x[0], 0.); },
                  middle    = [](const Place &x) { return is_at(x[1], 25.); },
                  diaphragm = [](const Place &x) { return is_at(x[1], 0.); };
      const HeldTips held   = edges_in(mesh, { { top, 0 }, { middle, 1 } });
      ShellScene     scene(
              mesh, {}, held,
              components(mesh, { { top, { 0 } }, { middle, { 1 } }, { diaphragm, { 0, 2 } } }), 0.);
      Vector load(3 * mesh.n_nodes());
      for (const ShellTriangle &triangle : mesh.triangles())
        for (const unsigned int node : triangle.nodes)
          load[3 * node + 2] -= 90. * triangle.area / 3. * ShellScene::E / 4.32e8;
      return -small_displacements(scene, load)[3 * ((n + 1) * (n + 1) - 1) + 2] / 0.3024;
    }

    double
    pinched_cylinder(const unsigned int n)
    {
      const ShellMesh mesh  = cylinder(n, 300., std::acos(-1.) / 2., 300., 3.);
      const Marks     top   = [](const Place &x) { return is_at(x[0], 0.); },
                  side      = [](const Place &x) { return std::abs(x[2]) < 1e-6; },
                  diaphragm = [](const Place &x) { return is_at(x[1], 0.); },
                  middle    = [](const Place &x) { return is_at(x[1], 300.); };
      const HeldTips held   = edges_in(mesh, { { top, 0 }, { side, 2 }, { middle, 1 } });
      ShellScene     scene(
              mesh, {}, held,
              components(
                  mesh,
                  { { top, { 0 } }, { side, { 2 } }, { middle, { 1 } }, { diaphragm, { 0, 2 } } }));
      Vector             load(3 * mesh.n_nodes());
      const unsigned int loaded = 3 * (n * (n + 1)) + 2; // at the top in the middle
      load[loaded]              = -0.25 * ShellScene::E / 3e6;
      return -small_displacements(scene, load)[loaded] / 1.8248e-5;
    }

    TEST(ShellBenchmarks, HaveTheDeflectionOfScordelisAndLo)
    {
      EXPECT_NEAR(scordelis_lo(8), 0.88, 0.01);
      EXPECT_NEAR(scordelis_lo(32), 0.985, 0.005);
    }

    TEST(ShellBenchmarks, HaveTheDeflectionOfAPinchedCylinder)
    {
      EXPECT_NEAR(pinched_cylinder(32), 1.14, 0.01);
      EXPECT_NEAR(pinched_cylinder(64), 1.05, 0.01);
    }

    /// The positions at rest under a load, by Newton's method from `x` on.
    Vector
    equilibrium(ShellScene &scene, const Vector &load, Vector x)
    {
      const auto evaluate = [&](const Vector &at)
      {
        ElasticEvaluation result = scene.evaluate(at, {});
        result.energy -= load * at;
        result.gradient -= load;
        return result;
      };
      ElasticEvaluation at = evaluate(x);
      for (unsigned int iteration = 0; iteration < 200; ++iteration)
      {
        Vector step;
        try
        {
          step = scene.solve(scene.assemble(Tangent::exact, x, {}), at.gradient);
        }
        catch (const SolverFailure &)
        {
          step = scene.solve(scene.assemble(Tangent::convex, x, {}), at.gradient);
        }
        if (step.linfty_norm() < 1e-10)
          return x;
        double            part = 1.;
        Vector            next = x;
        ElasticEvaluation there;
        do
        {
          next = x;
          next.add(-part, step);
          there = evaluate(next);
          part *= 0.5;
        } while (part > 1e-6 && there.energy > at.energy + 1e-12 * std::abs(at.energy));
        x  = next;
        at = there;
      }
      ADD_FAILURE() << "no equilibrium";
      return x;
    }

    TEST(ShellBenchmarks, AreElasticasOfStrips)
    {
      const double t = 0.01, width = 0.25;
      ShellMesh    mesh = rectangle(
             32, 8,
             [=](const double x, const double y) {
            return Place{ { x, width * y, 0. } };
          },
             t);
      const Marks clamp = [](const Place &x) { return is_at(x[0], 0.); };
      HeldTips    held  = edges_in(mesh, { { clamp, 0 } });
      for (HeldComponents &tip : held)
        tip = tip != 0 ? held_in_space : 0;
      ShellScene scene(mesh, {}, held, components(mesh, { { clamp, { 0, 1, 2 } } }), 0.);
      Vector     x = rest_positions(scene.body->get_strains());
      const std::pair<double, double> published[]
          = { { 1., 0.3017 }, { 5., 0.7138 }, { 10., 0.8106 } };
      for (const auto &[load, deflection] : published)
      {
        Vector force(x.size());
        for (unsigned int j = 0; j <= 8; ++j)
          force[3 * (33 * j + 32) + 2]
              = (j % 8 == 0 ? 0.5 : 1.) / 8. * load * ShellScene::E * width * t * t * t / 12.;
        x = equilibrium(scene, force, x);
        EXPECT_NEAR(x[3 * (33 * 4 + 32) + 2], deflection, 0.01 * deflection);
      }
    }
  } // namespace
} // namespace Exemplar::Testing
