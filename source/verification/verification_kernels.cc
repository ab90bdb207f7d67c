// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/verification/verification.h>
#include <exemplar/verification/verification_scene.h>

#include <cmath>
#include <random>

// Closed forms of the material, and invariants of every motion.

namespace Exemplar::Verification
{
  namespace
  {
    const std::string material
        = section("Material", set("Young's modulus", 1000.) + set("Poisson's ratio", 0.3));

    constexpr double youngs_modulus = 1000., poissons_ratio = 0.3;
    constexpr double lambda
        = youngs_modulus * poissons_ratio / ((1. + poissons_ratio) * (1. - 2. * poissons_ratio)),
        mu = youngs_modulus / (2. * (1. + poissons_ratio));

    const std::string held_end
        = named_sections("Handles", { { "left", set("Select", "boundary 1") } });

    /// A bar of volume 4, held at one end for static scenes.
    const std::string held_bar
        = set("Scene", "static") + box({ { 4., 1., 1. } }, { { 4, 1, 1 } }) + material + held_end;

    const std::string twisted_and_stretched
        = section("Examples",
                  set("Pose functions", twist(60., 4.) + " | 1.2*x; 0.9*y; z")
                      + set("Importance", 0.7) + set("Weights", "free"));

    const std::string fixed_point = section("Model", set("Gradient", "frozen"))
                                    + section("Solver", set("Method", "fixed point"));

    dealii::Vector<double>
    affine(const Problem &problem, const Matrix3<double> &F)
    {
      return moved_rigidly(problem.body.fe_space.rest_positions(), F, {});
    }

    dealii::Vector<double>
    random_positions(const Problem &problem)
    {
      std::mt19937                     generator(1);
      std::normal_distribution<double> normal;
      dealii::Vector<double>           positions = problem.body.fe_space.rest_positions();
      for (double &x : positions)
        x += 0.1 * normal(generator);
      return positions;
    }

    std::vector<Measurement>
    uniform_scale()
    {
      Scene        scene(held_bar);
      const double s = 1.3, volume = 4.;
      const double expected = volume * (s - 1.) * (s - 1.) * (3. * mu + 4.5 * lambda);
      const auto   x = affine(scene.problem, { { { s, 0., 0. }, { 0., s, 0. }, { 0., 0., s } } });
      return { { "energy", expected, evaluate(scene.problem, x).energy, Comparison::relative,
                 1e-12 } };
    }

    std::vector<Measurement>
    simple_shear()
    {
      Scene        scene(held_bar);
      const double gamma = 0.8, r = std::sqrt(4. + gamma * gamma), volume = 4.;
      const double expected
          = volume * (mu * (4. + gamma * gamma - 2. * r) + 0.5 * lambda * (r - 2.) * (r - 2.));
      const auto x
          = affine(scene.problem, { { { 1., gamma, 0. }, { 0., 1., 0. }, { 0., 0., 1. } } });
      return { { "energy", expected, evaluate(scene.problem, x).energy, Comparison::relative,
                 1e-12 } };
    }

    std::vector<Measurement>
    uniaxial()
    {
      const double s      = 1.5;
      const auto   roller = [](const std::string &boundary, const std::string &component)
      { return set("Select", "boundary " + boundary) + set("Components", component); };
      Scene scene(
          set("Scene", "static") + box({ { 4., 1., 1. } }, { { 4, 1, 1 } }) + material
          + named_sections("Handles", { { "left", roller("1", "x") },
                                        { "right", roller("2", "x") + set("Motion", "2*t; 0; 0") },
                                        { "front", roller("3", "y") },
                                        { "bottom", roller("5", "z") } })
          + section("Solver", set("Tolerance", 1e-12)));
      const State  state = scene.solve();
      const auto  &p     = scene.problem;
      const auto  &nodes = p.body.mesh.get_nodes();
      const auto   far   = p.body.mesh.n_nodes() - 1; // the corner with greatest x, y, z
      const double width = state.positions[3 * far + 2] - (nodes[far][2] - 1.);
      return { { "force", youngs_modulus * (s - 1.),
                 p.constraints.handles.sum_over(1, p.evaluation.gradient)[0], Comparison::relative,
                 1e-10 },
               { "lateral stretch", 1. - poissons_ratio * (s - 1.), width, Comparison::relative,
                 1e-10 } };
    }

    std::vector<Measurement>
    own_example_strain()
    {
      // the remaining factor of the energy is (1 - eta)^2 if scaled, 1 - eta if blended, Eq. (5)
      const std::pair<std::string, double> cases[]
          = { { "scaled", 0.09 }, { "blended", 0.3 }, { "mixed", 0.8 * 0.09 + 0.2 * 0.3 } };
      std::vector<Measurement> all;
      for (const auto &[energy, left] : cases)
      {
        Scene       scene(held_bar
                          + section("Examples", set("Pose functions", "1.2*x; 0.9*y; z+0.1*x")
                                                    + set("Importance", 0.7) + set("Energy", energy)
                                                    + set("Weight penalty", "0")));
        const auto &pose = scene.problem.examples.poses.pose(1);
        const auto  with = evaluate(scene.problem, pose, { 0., 1. });
        all.push_back({ "energy left, " + energy, left, with.energy / with.energy_elastic,
                        Comparison::relative, 1e-12 });
      }
      return all;
    }

    double
    length(const Vector3<double> &a)
    {
      return std::sqrt(dot(a, a));
    }

    /// |sum x cross f|, relative to sum |x cross f|.
    double
    relative_torque(Problem &problem, const dealii::Vector<double> &x)
    {
      const auto f     = evaluate(problem, x, { 0.2, 0.5, 0.3 }).gradient;
      double     scale = 0.;
      for (unsigned int node = 0; node < problem.body.mesh.n_nodes(); ++node)
        scale += length(skew_matrix(node_vector(x, node)) * node_vector(f, node));
      return length(torque(x, f)) / scale;
    }

    std::vector<Measurement>
    rigid_motion()
    {
      Scene                   scene(held_bar + twisted_and_stretched);
      Problem                &p       = scene.problem;
      const auto              weights = std::vector<double>{ 0.2, 0.5, 0.3 };
      const auto              x       = random_positions(p);
      const Matrix3<double>   Q       = rotation_about({ { 1., 2., -1. } }, 2.5);
      const ElasticEvaluation before  = evaluate(p, x, weights);
      const ElasticEvaluation after
          = evaluate(p, moved_rigidly(x, Q, { { 3., -1., 2. } }), weights);
      const auto   turned = moved_rigidly(before.gradient, Q, {});
      const double scale  = before.gradient.l1_norm();
      return { { "energy, ratio", 1., after.energy / before.energy, Comparison::relative, 1e-11 },
               { "forces less rotated forces", 0.,
                 max_difference(after.gradient, turned)
                     / max_entry(before.gradient.begin(), before.gradient.end()),
                 Comparison::absolute, 1e-11 },
               { "sum f", 0., length(total(before.gradient)) / scale, Comparison::absolute, 1e-12 },
               { "sum x cross f", 0., relative_torque(p, x), Comparison::absolute, 1e-12 } };
    }

    std::vector<Measurement>
    ghost_torque()
    {
      Scene      scene(held_bar + twisted_and_stretched + fixed_point);
      const auto sheared
          = affine(scene.problem, { { { 1., 0.5, 0. }, { 0., 1., 0. }, { 0., 0., 1. } } });
      return { { "sum x cross f, frozen", 1e-3, relative_torque(scene.problem, sheared),
                 Comparison::at_least } };
    }
  } // namespace

  std::vector<Case>
  kernel_cases()
  {
    return {
      { "uniaxial", "pulled bar: E (s-1) and 1 - nu (s-1); doc/model.md, closed forms", uniaxial },
      { "uniform-scale", "3 mu (s-1)^2 + 9/2 lambda (s-1)^2; doc/model.md, closed forms",
        uniform_scale },
      { "simple-shear", "mu (4+g^2-2r) + lambda/2 (r-2)^2; doc/model.md, closed forms",
        simple_shear },
      { "own-example-strain", "the part of the energy that is left; doc/model.md, closed forms",
        own_example_strain },
      { "rigid-motion", "same energy, turned forces, no resultant; doc/model.md, closed forms",
        rigid_motion },
      { "ghost-torque", "that frozen rotations leave out W; doc/model.md, Eq. (17)", ghost_torque }
    };
  }
} // namespace Exemplar::Verification
