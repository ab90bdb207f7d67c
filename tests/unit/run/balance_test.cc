// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>

#include "expect_contains.h"
#include "scene.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>

namespace Exemplar::Testing
{
  namespace
  {
    /// A bar that is held on the left and stands out against its weight.
    std::string
    balanced_bar(const std::string &kind, const std::string &more = "")
    {
      return "set Scene = " + kind + "\n" + bar + "subsection Handles\n set Names = left\n"
             + held_left + "end\n"
             + "subsection Loads\n set Gravity = 3, 0, -9.81\n set Balanced = true\nend\n"
             + "subsection Time\n set Step = 0.02\n set End = 0.4\n set Increments = 3\nend\n"
             + more;
    }

    const std::string kinds_of_cells[][2]
        = { { "P1", "cells" }, { "P1", "patches" }, { "P2", "cells" }, { "P2", "patches" } };

    std::vector<std::string>
    keys_of(const std::string (&kind)[2])
    {
      return { "Model/Element=" + kind[0], "Model/Dilatation=" + kind[1],
               "Material/Poisson's ratio=0.4" };
    }

    /// Greatest force on a free degree of freedom over the greatest that acts on a node.
    double
    unbalanced(const Problem &problem)
    {
      return problem.constraints.free_dofs.max_magnitude(problem.evaluation.gradient)
             / problem.evaluation.force_scale.linfty_norm();
    }

    void
    expect_unbalanceable(const std::string &scene, const std::string &words)
    {
      try
      {
        Scene refused(scene);
        FAIL() << words;
      }
      catch (const UserError &error)
      {
        expect_contains(error.what(), words);
      }
    }

    TEST(Balance, StressesBearTheLoadsAtRest)
    {
      const std::string pull
          = "subsection Loads\n set Names = pull\n subsection pull\n set Select = boundary 2\n"
            "set Force = 0; 700; 100*t\nend\nend\n";
      for (const auto &kind : kinds_of_cells)
      {
        Scene scene(balanced_bar("static", pull), keys_of(kind));
        EXPECT_LT(unbalanced(scene.problem), 1e-14) << kind[0] << kind[1];
        EXPECT_LT(scene.problem.evaluation.elastic.energy, 1e-20);
      }
      for (const std::string material :
           { "Fibre stiffness = 1e6\n set Fibre direction = 1; 0.2; 0.1",
             "Orthotropy = 1e6, 2e6, 3e6, .3, .2, .1, 4e5, 5e5, 6e5\n set Fibre direction = 1; 0; "
             "0\n set Cross direction = 0; 1; 0",
             "Yield stress = 1e5" })
      {
        Scene scene(balanced_bar("static", "subsection Material\n set " + material + "\nend\n"));
        EXPECT_LT(unbalanced(scene.problem), 1e-14) << material;
      }
      Scene neo_hookean(balanced_bar("static"), { "Model/Background=neo-hookean" });
      EXPECT_LT(unbalanced(neo_hookean.problem), 1e-14);
      Scene linear(balanced_bar("static"), { "Model/Strain=linear" });
      EXPECT_LT(unbalanced(linear.problem), 1e-14);
    }

    TEST(Balance, TheRestPoseStays)
    {
      const std::string stiff = "subsection Material\n set Young's modulus = 1e7\nend\n";
      const std::string with_examples
          = examples(two_poses + "set Importance = 0.8\nset Weight penalty = 0\n") + stiff;
      for (const std::string &more : { std::string(), with_examples })
        for (const auto &kind : kinds_of_cells)
          for (const std::string scene : { "static", "dynamic" })
          {
            Scene stands(balanced_bar(scene, more), keys_of(kind));
            EXPECT_LT(max_difference(stands.solve().positions,
                                     stands.problem.body.fe_space.rest_positions()),
                      1e-9)
                << scene << kind[0] << kind[1];
            EXPECT_TRUE(stands.problem.actions.warnings.empty());
            Scene falls(balanced_bar(scene, more), { "Loads/Balanced=false" });
            EXPECT_GT(max_difference(falls.solve().positions,
                                     falls.problem.body.fe_space.rest_positions()),
                      1e-2);
          }
    }

    TEST(Balance, MatrixIsTheDerivativeOfForces)
    {
      for (const auto &kind : kinds_of_cells)
      {
        Scene       scene(balanced_bar("static"), keys_of(kind));
        Laboratory &lab = scene.problem.laboratory();
        Place       at  = lab.here();
        for (unsigned int dof = 0; dof < at.positions.size(); ++dof)
          at.positions[dof] += 0.1 * std::sin(1. + 7. * dof);
        const RowMatrix exact = lab.hessian(at, Tangent::exact);
        const double    h     = 1e-6;
        for (const unsigned int column : { 4U, 17U })
        {
          Place more = at, less = at;
          more.positions[column] += h;
          less.positions[column] -= h;
          const Vector after = lab.evaluate(more).gradient, before = lab.evaluate(less).gradient;
          std::vector<double> found(after.size(), 0.);
          for (std::size_t row = 0; row < found.size(); ++row)
            for (auto k = exact.row_start[row]; k < exact.row_start[row + 1]; ++k)
              if (exact.column[k] == static_cast<int>(column))
                found[row] = exact.value[k];
          const double scale = std::abs(found[column]);
          for (std::size_t row = 0; row < found.size(); ++row)
            EXPECT_NEAR(found[row], (after[row] - before[row]) / (2. * h), 1e-6 * scale);
        }
      }
    }

    /// It buckles under its weight at rho g A L^3 / (E I) = 7.837.
    constexpr double buckling_modulus = 12. * 1000. * 9.81 * 8. * 8. * 8. / 7.837;

    /// What a column 8 m high that bears its weight is warned of.
    std::vector<std::string>
    warnings_of_column(const double youngs_modulus, const std::string &more = "")
    {
      Scene scene(
          "set Scene = static\nsubsection Mesh\n set Generator = box\n set Box size = 8, 1, 1\n"
          "set Box cells = 8, 1, 1\nend\nsubsection Model\n set Element = P2\nend\n"
          "subsection Handles\n set Names = left\n"
          + held_left
          + "end\nsubsection Loads\n set Gravity = -9.81, 0, 0\n set Balanced = true\nend\n"
            "subsection Material\n set Density = 1000\n set Poisson's ratio = 0\n"
          + fmt::format("set Young's modulus = {}\nend\n", youngs_modulus) + more);
      return scene.problem.actions.warnings;
    }

    double
    modulus_in(const std::string &warning)
    {
      const std::size_t place = warning.find("modulus = ");
      return place == std::string::npos ? 0. : std::stod(warning.substr(place + 10));
    }

    TEST(Balance, AColumnStandsFromTheStiffnessOfItsBuckling)
    {
      const double E = buckling_modulus;
      EXPECT_TRUE(warnings_of_column(1.1 * E).empty());
      const auto warnings = warnings_of_column(0.25 * E);
      ASSERT_EQ(warnings.size(), 1U);
      EXPECT_NEAR(modulus_in(warnings[0]), E, 0.05 * E);
    }

    // Along an example like its buckling it loses the more of its stiffness the more the example counts. How much is
    // compared in tests/python/test_evaluation.py.
    TEST(Balance, AnExampleOfItsBucklingLetsAColumnGo)
    {
      const double      E = buckling_modulus;
      const std::string buckled
          = "set Pose functions = x-(z-0.5)*0.02*pi/16*sin(pi*x/16); y; z+0.02*(1-cos(pi*x/16))\n"
            "set Include rest pose = true\nset Energy = blended\nset Importance = ";
      EXPECT_TRUE(warnings_of_column(2.2 * E, examples(buckled + "0.5\n")).empty());
      double before = 1.1 * E;
      for (const double eta : { 0.5, 0.8 })
      {
        const auto warnings
            = warnings_of_column(1.1 * E, examples(buckled + fmt::format("{}\n", eta)));
        ASSERT_EQ(warnings.size(), 1U);
        expect_contains(warnings[0], "the body, with its examples, is too soft");
        EXPECT_GT(modulus_in(warnings[0]), 1.1 * before);
        before = modulus_in(warnings[0]);
      }
    }

    TEST(Balance, WhatCannotStandIsRefused)
    {
      expect_unbalanceable("set Scene = dynamic\n" + bar
                               + "subsection Loads\n set Gravity = 0, 0, -9.81\n set Balanced = "
                                 "true\nend\n",
                           "leave 6 of 6 rigid motions free in the beginning");
      const auto with = [](const std::string &keys) { return balanced_bar("static", keys); };
      expect_unbalanceable(with("subsection Model\n set Strain = green\nend\n"),
                           "Model/Strain = green");
      expect_unbalanceable(with("subsection Model\n set Gradient = frozen\nend\n"),
                           "Model/Gradient = consistent");
      expect_unbalanceable(with("subsection Loads\n set Ramp = increments\nend\n"),
                           "Loads/Ramp = increments");
    }
  } // namespace
} // namespace Exemplar::Testing
