// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/obstacle_term.h>
#include <exemplar/verification/verification.h>
#include <exemplar/verification/verification_scene.h>

#include <fmt/core.h>

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

    const ObstacleTerm &
    obstacles_of(const Problem &problem)
    {
      for (const auto &term : problem.potential.get_terms())
        if (const auto *const found = dynamic_cast<const ObstacleTerm *>(term.get()))
          return *found;
      throw std::logic_error("no obstacles");
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
                 obstacles_of(scene.problem).report()[0].force[2], Comparison::relative, 1e-6 } };
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
  } // namespace

  std::vector<Case>
  contact_cases()
  {
    return { { "contact-weight", "a cube at rest: the floor bears its weight", weight_on_floor },
             { "contact-slope",
               "a cube on slopes beside the angle of friction: creep below the slip speed, or g "
               "(sin - mu cos)",
               slope },
             { "contact-sliding",
               "a cube that slides until friction stops it: v^2 / 2 mu g, less h v / 2",
               sliding_cube },
             { "contact-impact", "an oblique impact: the impulses have the ratio of friction",
               oblique_impact } };
  }
} // namespace Exemplar::Verification
