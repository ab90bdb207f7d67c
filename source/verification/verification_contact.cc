// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/problem/obstacle_start.h>
#include <exemplar/verification/verification.h>
#include <exemplar/verification/verification_scene.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

// Bodies that meet obstacles: doc/contact.md.

namespace Exemplar::Verification
{
  namespace
  {
    constexpr double g = 9.81, cube_mass = 1.; // of .1 m and 1000 kg/m^3

    std::string
    floor(const std::string &shape, const double friction, const std::string &more = "")
    {
      return section("Obstacles", set("Names", "floor") + set("Lag tolerance", 1e-8)
                                      + section("floor", set("Shape", shape)
                                                             + set("Friction", friction) + more));
    }

    /// A stiff cube of .1 m about x = .05 m, which touches the floor.
    std::string
    cube_on_floor(const double friction, const double step, const double end)
    {
      return set("Scene", "dynamic") + box({ { 0.1, 0.1, 0.1 } }, { { 2, 2, 2 } })
             + section("Material", set("Young's modulus", 1e7) + set("Poisson's ratio", 0.3))
             + section("Time", set("Step", step) + set("End", end))
             + section("Solver", set("Step tolerance", 1e-9) + set("Maximum iterations", 400.))
             + floor("plane 0 0 -0.05 0 0 1", friction);
    }

    std::string
    gravity(const double x, const double z)
    {
      return section("Loads", set("Gravity", fmt::format("{:.17g}, 0, {:.17g}", x, z)));
    }

    double
    speed(const Problem &problem)
    {
      return total(mass_times(*problem.actions.mass, problem.state.velocities))[0] / cube_mass;
    }

    std::vector<Measurement>
    weight_on_floor()
    {
      Scene scene(cube_on_floor(0., 0.01, 2.) + gravity(0., -g)
                  + section("Time", set("Mass damping", 20.)));
      scene.solve();
      return { { "force of the floor / N", cube_mass * g,
                 find_obstacle_term(scene.problem)->report()[0].force[2], Comparison::relative,
                 1e-6 } };
    }

    /// The cube on a slope, which gravity makes, at the end of the time [s].
    std::vector<double>
    speeds_on_slope(const double tangent, const double end)
    {
      const double length = std::sqrt(1. + tangent * tangent);
      Scene scene(cube_on_floor(0.5, 0.02, end) + gravity(g * tangent / length, -g / length));
      std::vector<double> speeds;
      while (scene.problem.state.step < scene.problem.time_axis.n_steps())
      {
        scene.problem.advance();
        speeds.push_back(speed(scene.problem));
      }
      return speeds;
    }

    std::vector<Measurement>
    slope()
    {
      const double slip_speed = 1e-3 * 0.1 * std::sqrt(3.), part = 0.995, tangent = 0.5 * 1.005;
      const auto   creeps = speeds_on_slope(part * 0.5, 1.), slides = speeds_on_slope(tangent, 2.);
      const std::size_t n = slides.size();
      return { { "creep at tan = .995 mu / slip speed", 1. - std::sqrt(1. - part),
                 creeps.back() / slip_speed, Comparison::absolute, 0.01 },
               { "acceleration at tan = 1.005 mu / m/s^2",
                 g * (tangent - 0.5) / std::sqrt(1. + tangent * tangent),
                 (slides[n - 1] - slides[n - 26]) / (25. * 0.02), Comparison::relative, 0.005 } };
    }

    std::vector<Measurement>
    sliding_cube()
    {
      const double h = 0.02, v = 10., friction = 0.3;
      Scene        scene(cube_on_floor(friction, h, 3.6) + gravity(0., -g)
                         + section("Initial", set("Velocity", "10; 0; 0")));
      double       way = 0.;
      while (scene.problem.state.step < scene.problem.time_axis.n_steps())
      {
        scene.problem.advance();
        way += h * speed(scene.problem);
      }
      return { { "way until it stops / m", v * v / (2. * friction * g) - h * v / 2., way,
                 Comparison::relative, 0.01 } };
    }

    std::vector<Measurement>
    oblique_impact()
    {
      const double friction = 0.2;
      Scene        scene(set("Scene", "dynamic") + box({ { 0.1, 0.1, 0.1 } }, { { 2, 2, 2 } })
                         + section("Material", set("Young's modulus", 1e7) + set("Poisson's ratio", 0.3))
                         + section("Time", set("Step", 0.001) + set("End", 0.03))
                         + section("Initial", set("Velocity", "5; 0; -2"))
                         + floor("plane 0 0 -0.06 0 0 1", friction));
      const Vector3<double> end
          = total(mass_times(*scene.problem.actions.mass, scene.solve().velocities));
      return {
        { "normal impulse / N s", 2. * cube_mass, end[2] + 2. * cube_mass, Comparison::at_least },
        { "tangential impulse / normal impulse", friction,
          (5. * cube_mass - end[0]) / (end[2] + 2. * cube_mass), Comparison::relative, 0.01 }
      };
    }
    /// A quarter of a block, 10 a wide and deep, with layers of cells that grow with the distance from the contact.
    Inputs
    graded_block(const double a)
    {
      constexpr unsigned int n = 11, n_inner = 6;
      constexpr double       inner = 1.3; // of a, where cells are of one size
      return moved_box({ { 1., 1., 1. } }, { { n, n, n } },
                       [&](const dealii::Point<3> &x)
                       {
                         dealii::Point<3> p(n * x[0], n * (x[1] + 0.5), n * (x[2] - 0.5));
                         const double     layer = std::max({ p[0], p[1], -p[2], 1e-9 });
                         const double     grown
                             = std::pow(10. / inner, (layer - n_inner) / (n - n_inner));
                         return p * (a * inner * (layer > n_inner ? grown / layer : 1. / n_inner));
                       });
    }

    /// Hertz: a rigid ball pressed by a^2 / R into a half space. The outer faces go where those of a half space do under a
    /// force at a point (Boussinesq). The body begins below the ball.
    std::vector<Measurement>
    hertz()
    {
      const double      R = 1., a = 0.1, E = 1e6, nu = 0.3, depth = a * a / R, width = 5e-5 * R;
      const double      force = 4. / 3. * E / (1. - nu * nu) * std::sqrt(R) * std::pow(depth, 1.5);
      const double      c     = force * (1. + nu) / (2. * dealii::numbers::PI * E);
      const std::string r     = "sqrt(x*x+y*y+z*z+1e-12)";
      const std::string across
          = fmt::format("{}*(-z/{}^3-{}/({}*({}-z)))", c, r, 1. - 2. * nu, r, r);
      const std::string down  = fmt::format("-{0}*(z*z/{1}^3+{2}/{1})", c, r, 2. * (1. - nu));
      const std::string far   = fmt::format("x*{0}; y*{0}; {1}", across, down);
      const std::string start = fmt::format(
          "x+x*{0}*{2}; y+y*{0}*{2}; z+{1}*{2}+exp(5*z)*(1+z)*min(0,{3}-sqrt(max(1-x*x-y*y,0)))",
          across, down, "min(1,(" + r + "/0.8)^4)", R - depth - 2. * width);
      const auto held = [](const std::string &box, const std::string &key, const std::string &value)
      { return set("Select", "box " + box) + set(key, value); };
      Scene       scene(set("Scene", "static") + box({ { 1., 1., 1. } }, { { 11, 11, 11 } })
                            + section("Material", set("Young's modulus", E) + set("Poisson's ratio", nu))
                            + section("Model", set("Strain", "linear") + set("Element", "P2"))
                            + named_sections("Handles",
                                             { { "x", held("0 -1 -9 0 9 1", "Components", "x") },
                                               { "y", held("-1 0 -9 9 0 1", "Components", "y") },
                                               { "below", held("-1 -1 -9 9 9 -0.9999", "Motion", far) },
                                               { "right", held("0.9999 -1 -9 9 9 1", "Motion", far) },
                                               { "behind", held("-1 0.9999 -9 9 9 1", "Motion", far) } })
                            + section("Initial", set("Pose function", start))
                            + section("Obstacles",
                                      set("Names", "ball") + set("Distance", width)
                                          + section("ball", set("Shape", fmt::format("sphere 0 0 {} {}",
                                                                                     R - depth, R))))
                            + section("Time", set("Increments", 1.))
                            + section("Solver", set("Maximum iterations", 400.)),
                        {}, graded_block(a));
      const State end = scene.solve();
      std::vector<NodalField> fields;
      find_obstacle_term(scene.problem)->append_fields(end.positions, fields);
      double sum = 0., squares = 0.;
      for (unsigned int node = 0; node < end.positions.size() / 3; ++node)
      {
        const Vector3<double> x = node_vector(end.positions, node);
        const double          f = node_vector(fields[0].values, node)[2];
        sum += f;
        squares += f * (x[0] * x[0] + x[1] * x[1]);
      }
      return { { "force / that of Hertz", 1., -4. * sum / force, Comparison::relative, 0.03 },
               { "5/2 of the mean square radius / a^2", 1., 2.5 * squares / sum / (a * a),
                 Comparison::relative, 0.03 } };
    }
  } // namespace

  std::vector<Case>
  contact_cases()
  {
    return {
      { "contact-weight", "a cube at rest: the floor bears its weight", weight_on_floor },
      { "contact-slope",
        "a cube on slopes beside the angle of friction: creep below the slip speed, or g "
        "(sin - mu cos)",
        slope },
      { "contact-sliding", "a cube that slides until friction stops it: v^2 / 2 mu g, less h v / 2",
        sliding_cube },
      { "contact-impact", "an oblique impact: the impulses have the ratio of friction",
        oblique_impact },
      { "contact-hertz", "a rigid ball pressed into a block: Hertz' force and radius", hertz }
    };
  }
} // namespace Exemplar::Verification
