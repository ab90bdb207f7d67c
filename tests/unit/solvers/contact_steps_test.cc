// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>

#include "body.h"
#include "scene.h"
#include "wall.h"

#include <gtest/gtest.h>

#include <fmt/core.h>

#include <algorithm>
#include <sstream>

// Steps in which a body meets a wall.
namespace Exemplar::Testing
{
  namespace
  {
    /// A bar of length 4 that is thrown, from a height of 0.05 m above a floor at z = -0.55 m.
    std::string
    thrown_bar(const std::string &velocity, const double young, const double step)
    {
      return "set Scene = dynamic\nsubsection Mesh\n set Generator = box\n set Box size = 4, 1, "
             "1\n set "
             "Box cells = 12, 3, 3\nend\nsubsection Material\n set Young's modulus = "
             + fmt::format("{}", young) + "\nend\nsubsection Initial\n set Velocity = " + velocity
             + "\nend\nsubsection Loads\n set Gravity = 0, 0, -9.81\nend\nsubsection Time\n set "
               "Step = "
             + fmt::format("{}", step) + "\n set End = " + fmt::format("{}", 40. * step)
             + "\nend\n";
    }

    dealii::Tensor<1, 3>
    up()
    {
      dealii::Tensor<1, 3> direction;
      direction[2] = 1.;
      return direction;
    }

    /// k = 0.1 E A of a node of a bar with cells of 1/3 m, and the usual width.
    WallRules
    floor_at(const double height, const double young, const double friction = 0.)
    {
      return { up(), [height](double) { return height; }, 5e-3 * std::sqrt(18.), 0.1 * young / 9.,
               friction };
    }

    /// A scene with a wall.
    struct WalledScene
    {
      WalledScene(const std::string              &text,
                  const WallRules                &rules,
                  const std::vector<std::string> &overrides = {})
          : scene(text, overrides), problem(scene.problem)
      {
        problem.add_term(
            [&]
            {
              auto made = std::make_unique<Wall>(rules);
              made->move_to(0.);
              wall = made.get();
              return made;
            });
      }

      /// What steps have cost, and what has come of them.
      struct Course
      {
        unsigned int steps = 0, contact_steps = 0, iterations = 0, contact_iterations = 0;
        unsigned int most           = 0; ///< iterations of a step
        unsigned int factors        = 0;
        double       least_distance = std::numeric_limits<double>::infinity();
        double greatest_rise = 0.; ///< of the energy in a step, of the greatest kinetic energy
      };

      double
      kinetic_energy() const
      {
        const Vector momentum
            = Verification::mass_times(*problem.actions.mass, problem.state.velocities);
        return 0.5 * (momentum * problem.state.velocities);
      }

      Course
      run(const unsigned int n_steps = 0)
      {
        Course             course;
        const unsigned int before = problem.system.n_factorizations();
        const unsigned int n      = n_steps == 0 ? problem.time_axis.n_steps() : n_steps;
        while (problem.state.step < n)
        {
          const SolveReport report = problem.advance();
          EXPECT_EQ(report.status, SolveStatus::converged) << problem.state.step;
          if (report.status != SolveStatus::converged)
            break;
          ++course.steps;
          course.iterations += report.iterations;
          course.most           = std::max(course.most, report.iterations);
          const double d        = wall->least_distance(problem.state.positions);
          course.least_distance = std::min(course.least_distance, d);
          if (d < wall->gap_width())
          {
            ++course.contact_steps;
            course.contact_iterations += report.iterations;
          }
        }
        course.factors = problem.system.n_factorizations() - before;
        return course;
      }

      Scene    scene;
      Problem &problem;
      Wall    *wall = nullptr;
    };

    void
    print(const std::string &name, const WalledScene::Course &course)
    {
      if (std::getenv("CONTACT_TABLE") != nullptr)
        fmt::print(
            "{:30} {:3} steps, {:3} contact; {:.1f} iterations, {:.1f} in contact, at most {}; "
            "{} factors; least gap {:.2e}\n",
            name, course.steps, course.contact_steps, double(course.iterations) / course.steps,
            course.contact_steps == 0 ? 0.
                                      : double(course.contact_iterations) / course.contact_steps,
            course.most, course.factors, course.least_distance);
    }

    TEST(ContactSteps, ATumblingBarBouncesWithFewIterationsAndFactors)
    {
      struct Throw
      {
        std::string velocity;
        double      young, step;
      };
      for (const Throw &thrown : { Throw{ "0; 0; -3", 1e6, 0.01 },
                                   { "0; 0; -3+2*(x-2)", 1e6, 0.005 },
                                   { "1; 0; -3+2*(x-2)", 1e5, 0.01 },
                                   { "0; 0; -10", 1e7, 0.002 },
                                   { "0; 0; -20", 1e5, 0.02 } })
      {
        WalledScene scene(thrown_bar(thrown.velocity, thrown.young, thrown.step),
                          floor_at(-0.55, thrown.young));
        const auto  course = scene.run();
        print(thrown.velocity + fmt::format(" E {} h {}", thrown.young, thrown.step), course);
        EXPECT_EQ(course.steps, 40u);
        EXPECT_GT(course.contact_steps, 5u);
        EXPECT_GT(course.least_distance, 0.);
      }
    }

    TEST(ContactSteps, BothMethodsFindTheSameSteps)
    {
      for (const double friction : { 0., 0.3 })
      {
        const std::string text = thrown_bar("1; 0; -3+0.5*(x-2)", 1e6, 0.01);
        WalledScene       quasi(text, floor_at(-0.55, 1e6, friction),
                                { "Solver/Tolerance=1e-9", "Solver/Step tolerance=0" });
        WalledScene       newton(text, floor_at(-0.55, 1e6, friction),
                                 { "Solver/Tolerance=1e-9", "Solver/Method=newton" });
        print(fmt::format("quasi, friction {}", friction), quasi.run(25));
        print(fmt::format("newton, friction {}", friction), newton.run(25));
        EXPECT_LT(max_difference(quasi.problem.state.positions, newton.problem.state.positions),
                  friction == 0. ? 1e-6 : 1e-3);
      }
    }

    TEST(ContactSteps, FrictionTakesFewMore)
    {
      const std::string text = thrown_bar("1; 0; -3+0.5*(x-2)", 1e6, 0.01);
      for (const double friction : { 0., 0.1, 0.5 })
        for (const std::string method : { "quasi newton", "newton" })
        {
          WalledScene scene(text, floor_at(-0.55, 1e6, friction), { "Solver/Method=" + method });
          const auto  course = scene.run();
          print(fmt::format("{}, friction {}", method, friction), course);
          EXPECT_EQ(course.steps, 40u);
        }
    }

    TEST(ContactSteps, ExamplesFollowForcesOfContact)
    {
      const std::string text
          = thrown_bar("1; 0; -3+0.5*(x-2)", 1e6, 0.01)
            + examples("set Pose functions = " + twist(60.) + " | 1.2*x; 0.9*y; z\n");
      WalledScene quasi(text, floor_at(-0.55, 1e6),
                        { "Solver/Tolerance=1e-9", "Solver/Step tolerance=0" });
      WalledScene newton(text, floor_at(-0.55, 1e6),
                         { "Solver/Tolerance=1e-9", "Solver/Method=newton" });
      print("quasi, examples", quasi.run(25));
      print("newton, examples", newton.run(25));
      EXPECT_LT(max_difference(quasi.problem.state.positions, newton.problem.state.positions),
                1e-6);
    }

    TEST(ContactSteps, ManyGapsAndOperatorsWithoutEntriesAreSolvedByGradients)
    {
      const std::string text = thrown_bar("1; 0; -3+0.5*(x-2)", 1e6, 0.01);
      WalledScene       entries(text, floor_at(-0.55, 1e6)),
          gradients(text, floor_at(-0.55, 1e6), { "Solver/Linear solver=iterative" });
      print("entries", entries.run());
      print("gradients", gradients.run());
      EXPECT_LT(max_difference(entries.problem.state.positions, gradients.problem.state.positions),
                0.05);
    }

    TEST(ContactSteps, TheMetricHoldsNoContact)
    {
      // a bar that lies on the floor and one far above it have the same factor
      const std::string text = thrown_bar("0; 0; 0", 1e6, 0.01);
      WalledScene       lies(text, floor_at(-0.505, 1e6)), flies(text, floor_at(-100., 1e6));
      const auto        metric_of = [](Problem &problem)
      {
        problem.potential.begin_step(problem.state, 0.01);
        problem.system.factorize_metric(problem.state.positions, problem.state.weights);
        return problem.system.bordered().matrix_values();
      };
      EXPECT_EQ(metric_of(lies.problem), metric_of(flies.problem));
      lies.problem.system.factorize(lies.problem.state.positions, {}, 1.);
      EXPECT_NE(lies.problem.system.bordered().matrix_values(), metric_of(flies.problem));
    }

    TEST(ContactSteps, AResumedRunGoesOnInTheSameBytes)
    {
      const std::string text  = thrown_bar("1; 0; -3+2*(x-2)", 1e6, 0.005);
      const WallRules   rules = floor_at(-0.55, 1e6, 0.2);
      WalledScene       whole(text, rules), first(text, rules), second(text, rules);
      whole.run(30);
      first.run(14);
      ASSERT_LT(first.wall->least_distance(first.problem.state.positions), rules.width);
      second.problem.resume_from(first.problem.state, first.problem.solver_memory());
      second.run(30);
      EXPECT_TRUE(second.problem.state == whole.problem.state);
      EXPECT_EQ(second.problem.solver_memory(), whole.problem.solver_memory());
    }
  } // namespace
} // namespace Exemplar::Testing
