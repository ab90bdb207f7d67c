// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/output/diagnostics.h>

#include "expect_contains.h"
#include "scene.h"

#include <gtest/gtest.h>

#include <cmath>

// A cube of a Maxwell branch beside a spring, of E = 1e6 Pa, nu = 0, tau = 1 s and r = 1/2, pulled along x and free sideways: its
// modulus falls as E(t)/E = .6 + .4 exp(-t/1.2 s).
namespace Exemplar::Testing
{
  namespace
  {
    constexpr double young = 1e6, end_modulus = 0.6e6, relaxing = 0.4e6, relaxation_time = 1.2;

    std::string
    cube(const double       step,
         const double       end,
         const std::string &right,
         const std::string &loads = "")
    {
      return "set Scene = dynamic\nsubsection Time\n set Step = " + std::to_string(step)
             + "\n set End = " + std::to_string(end)
             + "\nend\nsubsection Mesh\n set Generator = box\n set Box size = 1, 1, 1\n set Box "
               "cells = 1, 1, 1\nend\n"
               "subsection Material\n set Poisson's ratio = 0\n set Density = 1e-6\n set "
               "Relaxation time = 1\nend\n"
               "subsection Solver\n set Method = newton\n set Tolerance = 1e-11\nend\n"
               "subsection Handles\n set Names = left, front, bottom"
             + (right.empty() ? "" : ", right")
             + "\n subsection left\n set Select = boundary 1\n set Components = x\n end\n"
               " subsection front\n set Select = boundary 3\n set Components = y\n end\n"
               " subsection bottom\n set Select = boundary 5\n set Components = z\n end\n"
             + (right.empty() ? ""
                              : " subsection right\n set Select = boundary 2\n set Components = "
                                "x\n set Motion = "
                                    + right + "; 0; 0\n end\n")
             + "end\n" + loads;
    }

    double
    column(const Problem &problem, const std::string &name)
    {
      for (const StatisticsCell &cell : Diagnostics(problem).row(problem.state, SolveReport()))
        if (cell.column == name)
          return std::get<double>(cell.value);
      return std::nan("");
    }

    /// What `value` gives at the end of a scene, extrapolated to steps of no length: implicit Euler is of the first order.
    template <typename Text, typename Value>
    double
    extrapolated(const Text &text, const Value &value)
    {
      double by_step[2];
      for (unsigned int half = 0; half < 2; ++half)
      {
        Scene scene(text(half == 0 ? 0.02 : 0.01));
        scene.solve();
        by_step[half] = value(scene.problem);
      }
      return 2. * by_step[1] - by_step[0];
    }

    TEST(Viscoelastic, StressRelaxes)
    {
      for (const double end : { 0.2, 1., 4. })
      {
        const double modulus = extrapolated(
            [&](const double step) { return cube(step, end, "t > 0 ? 1e-3 : 0"); },
            [](const Problem &problem) { return column(problem, "reaction_right_x") / 1e-3; });
        EXPECT_NEAR(modulus, end_modulus + relaxing * std::exp(-end / relaxation_time),
                    1e-4 * young)
            << end;
      }
    }

    TEST(Viscoelastic, StrainCreeps)
    {
      const std::string pull
          = "subsection Loads\n set Names = tip\n subsection tip\n set Select = boundary 2\n"
            " set Force = 1e3; 0; 0\n end\nend\n";
      const double retardation = relaxation_time * young / end_modulus;
      for (const double end : { 0.2, 2. })
      {
        const double strain = extrapolated(
            [&](const double step) { return cube(step, end, "", pull); }, [](const Problem &problem)
            { return Verification::mean_displacement(problem, problem.state, "boundary 2")[0]; });
        const double expected
            = 1e3
              * (1. / end_modulus - (1. / end_modulus - 1. / young) * std::exp(-end / retardation));
        EXPECT_NEAR(strain, expected, 3e-3 * expected) << end; // of strains that are not small, too
      }
    }

    TEST(Viscoelastic, ACycleLosesWhatItsLossModulusSays)
    {
      const double omega = 2., period = 2. * M_PI / omega;
      const double loss = extrapolated(
          [&](const double step)
          { return cube(period / std::round(period / step), 4. * period, "1e-3*sin(2*t)"); },
          [&](Problem &problem)
          {
            const double before = column(problem, "energy_dissipated");
            for (unsigned int step = 0; step < problem.time_axis.n_steps() / 4; ++step)
              EXPECT_TRUE(is_success(problem.advance().status));
            return column(problem, "energy_dissipated") - before;
          });
      const double x = omega * relaxation_time;
      EXPECT_NEAR(loss, M_PI * 1e-6 * relaxing * x / (1. + x * x), 2e-3 * loss);
    }

    TEST(Viscoelastic, StaticsAreRelaxed)
    {
      Scene scene("set Scene = static\n" + cube(0.02, 1., "1e-3*t").substr(20));
      scene.solve();
      EXPECT_NEAR(column(scene.problem, "reaction_right_x"), end_modulus * 1e-3,
                  1e-6 * young * 1e-3);
    }

    TEST(Viscoelastic, WhatItHasNoPlaceBesideIsRefusedByItsKey)
    {
      const auto refusal = [](const std::vector<std::string> &overrides)
      {
        try
        {
          Scene(cube(0.02, 0.1, "0"), overrides);
        }
        catch (const UserError &error)
        {
          return std::string(error.what());
        }
        return std::string();
      };
      EXPECT_EQ(refusal({}), "");
      for (const std::string beside : { "Material/Yield stress=1e4", "Material/Fibre stiffness=1e6",
                                        "Model/Strain=green", "Model/Gradient=frozen" })
        expect_contains(
            refusal({ beside, "Material/Fibre direction=1; 0; 0", "Examples/Energy=blended" }),
            "Material/Relaxation time is for ");
      expect_contains(refusal({ "Model/Background=neo-hookean" }), "Relaxation time = 0");
    }
  } // namespace
} // namespace Exemplar::Testing
