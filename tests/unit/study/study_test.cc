// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/mesh.h>
#include <exemplar/mesh/mesh_generation.h>
#include <exemplar/study/study_file.h>
#include <exemplar/study/study_measures.h>
#include <exemplar/study/study_report.h>
#include <exemplar/study/study_table.h>

#include "temporary_directory.h"

#include <gtest/gtest.h>

#include <cmath>

namespace Exemplar::Testing
{
  namespace
  {
    using Choices = std::vector<std::vector<unsigned int>>;

    class StudyFile : public InTemporaryDirectory
    {
    protected:
      Study
      study(const std::string &vary, const std::string &others = "") const
      {
        return Study(
            write_file("study.prm", "set Scene = scene.prm\nset Vary = " + vary + "\n" + others));
      }

      StudyAxis
      axis(const std::string &vary) const
      {
        return study(vary).axes.at(0);
      }

      std::string
      refusal(const std::string &vary, const std::string &others = "") const
      {
        try
        {
          study(vary, others);
        }
        catch (const UserError &error)
        {
          return error.what();
        }
        return "not refused";
      }

      void
      expect_refusal(const std::vector<std::string> &words,
                     const std::string              &vary,
                     const std::string              &others = "") const
      {
        const std::string message = refusal(vary, others);
        for (const std::string &word : words)
          EXPECT_NE(message.find(word), std::string::npos) << word << " is not in: " << message;
      }
    };

    using Values = std::vector<std::vector<std::string>>;

    TEST_F(StudyFile, QuotedValuesMayHoldSeparators)
    {
      const Study quoted = study("Examples/Pose functions: \"x; y; -z\" \"2*x; y, z | x; y; z\" | "
                                 "A/B + C: \"1 + 2\" + 3, 4 + \"5, 6\"",
                                 "set Base = D/E=1; D/F=\"0; t; 0\"\n");
      ASSERT_EQ(quoted.axes.size(), 2U);
      EXPECT_EQ(quoted.axes[0].values, (std::vector<std::vector<std::string>>{
                                           { "x; y; -z" }, { "2*x; y, z | x; y; z" } }));
      EXPECT_EQ(quoted.axes[1].values,
                (std::vector<std::vector<std::string>>{ { "1 + 2", "3" }, { "4", "5, 6" } }));
      EXPECT_EQ(quoted.base[1].value, "0; t; 0");
      EXPECT_EQ(quoted.assignments({ 1, 0 }).back().value, "3");
      expect_refusal({ "Vary", "quotation mark is not closed" }, "A/B: \"x; y");
    }

    TEST_F(StudyFile, SeparatorsOfValues)
    {
      EXPECT_EQ(axis("Time/Step: 0.1  0.05").values, (Values{ { "0.1" }, { "0.05" } }));
      EXPECT_EQ(axis("Solver/Method: one pass, newton").values,
                (Values{ { "one pass" }, { "newton" } }));
      EXPECT_EQ(axis("Solver/Method: one pass,").values, (Values{ { "one pass" } }));
      EXPECT_EQ(axis("Mesh/Box cells: 2, 1, 1; 4, 2, 2").values,
                (Values{ { "2, 1, 1" }, { "4, 2, 2" } }));
    }

    TEST_F(StudyFile, Probe)
    {
      EXPECT_FALSE(study("A/B: 1 2").probe);
      EXPECT_EQ(*study("A/B: 1 2", "set Probe = 1, -2.5, 3e-1\n").probe,
                dealii::Point<3>(1., -2.5, .3));
      EXPECT_EQ(*study("A/B: 1 2", "set Probe = 1e-320, 0, 0\n").probe,
                dealii::Point<3>(1e-320, 0., 0.));
      for (const std::string wrong : { "1, 2", "1, 2, x", "1 2 3", "1e999, 0, 0", "nan, 0, 0" })
        expect_refusal({ "Probe", wrong, "three numbers" }, "A/B: 1 2",
                       "set Probe = " + wrong + "\n");
    }

    TEST_F(StudyFile, ExtraColumns)
    {
      const Study both
          = study("A/B: 1 2", "set Columns = weight_1, reaction_x\nset Probe = 0, 0, 0\n");
      EXPECT_EQ(
          extra_columns_of(both),
          (std::vector<std::string>{ "weight_1", "reaction_x", "probe_x", "probe_y", "probe_z" }));
      check_extra_columns(both);
      expect_refusal({ "Columns", "weight_1 is there twice" }, "A/B: 1 2",
                     "set Columns = weight_1, weight_1\n");
      expect_refusal({ "Columns", "empty" }, "A/B: 1 2", "set Columns = weight_1,, x\n");
      for (const std::string taken : { "status", "iterations", "A/B" })
        EXPECT_THROW(check_extra_columns(study("A/B: 1 2", "set Columns = " + taken + "\n")),
                     UserError);
    }

    TEST_F(StudyFile, LastValues)
    {
      const auto values = read_last_values(
          write_file("statistics.csv", "step,status,a,b\n0,initial,1,2\n1,converged,3,\n"),
          { "a", "b", "status", "c" });
      EXPECT_EQ(values[0], 3.);
      for (const unsigned int i : { 1, 2, 3 })
        EXPECT_TRUE(std::isnan(values[i])) << i;
    }

    TEST_F(StudyFile, KeysThatChangeTogether)
    {
      const StudyAxis both = axis("Solver/Method + Time / Step: one pass + 0.1, newton + 0.2");
      EXPECT_EQ(both.keys, (std::vector<std::string>{ "Solver/Method", "Time/Step" }));
      EXPECT_EQ(both.values, (Values{ { "one pass", "0.1" }, { "newton", "0.2" } }));
      EXPECT_EQ(both.text(1), "newton + 0.2");
    }

    TEST_F(StudyFile, CombinationsAndSettings)
    {
      const Study s = study("Time/Step: 1 2 | Solver/Method: one pass, newton",
                            "set Base = Time/End=3; Output/Every=1\nset Reference = Time/Step=0.5");
      EXPECT_EQ(s.choices(), (Choices{ { 0, 0 }, { 0, 1 }, { 1, 0 }, { 1, 1 } }));
      const auto settings = s.assignments({ 1, 0 });
      EXPECT_EQ(find_assignment(settings, "Time/End")->value, "3");
      EXPECT_EQ(find_assignment(settings, "Output/Every")->value, "1");
      EXPECT_EQ(find_assignment(settings, "Time/Step")->value, "2");
      EXPECT_EQ(find_assignment(settings, "Solver/Method")->value, "one pass");
      const auto reference = s.reference_assignments();
      EXPECT_EQ(find_assignment(reference, "Time/Step")->value, "0.5");
      EXPECT_EQ(find_assignment(reference, "Solver/Method"), nullptr);
      EXPECT_EQ(s.scene, directory / "scene.prm");
      EXPECT_EQ(find_assignment(study("Time/Step: 1").assignments({ 0 }), "Output/Every")->value,
                "0");
    }

    TEST_F(StudyFile, RefusesWhatItDoesNotUnderstand)
    {
      expect_refusal({ "Vary is not set", "set Vary =" }, "");
      expect_refusal({ "study.prm:2", "'Time/Step 1 2' has no ':'" }, "Time/Step 1 2");
      expect_refusal({ "Time/Step has no values" }, "Time/Step:");
      expect_refusal({ "the axis '' has no ':'" }, "Time/Step: 1 2 |");
      expect_refusal({ "names no key" }, ": 1 2");
      expect_refusal({ "empty" }, "Time/Step: 1,, 2");
      expect_refusal({ "'1' twice" }, "Time/Step: 1 2 1");
      expect_refusal({ "three numbers", "by ';': 8, 2, 2; 4, 1, 1." },
                     "Mesh/Box cells: 8, 2, 2, 4, 1, 1");
      expect_refusal({ "three numbers", "by ';': 0, 0, -1;." }, "Loads/Gravity: 0, 0, -1");
      expect_refusal({ "where 2 are needed", "joined by '+', too" }, "Time/Step + Time/End: 1 2");
      expect_refusal({ "Time/Step is varied twice" }, "Time/Step: 1 2 | Time/Step: 3");
      expect_refusal({ "study.prm:3", "Base 'Time/End' has no '='" }, "Time/Step: 1",
                     "set Base = Time/End");
      expect_refusal({ "Time/End is set twice" }, "Time/Step: 1",
                     "set Base = Time/End=1; Time/End=2");
      expect_refusal({ "Base", "Time/Step is set for all runs, but Vary varies it" },
                     "Time/Step: 1", "set Base = Time/Step=2");
      expect_refusal({ "Output/Directory", "--output" }, "Output/Directory: a b");
      expect_refusal({ "Repeats = '0'", "an integer >= 1" }, "Time/Step: 1", "set Repeats = 0");
      expect_refusal({ "no key 'Repeat'", "'Repeats'", "exemplar study --print-parameters" },
                     "Time/Step: 1", "set Repeat = 2");
      expect_refusal({ "study.prm:4", "no subsections", "set Base = Time/End=3" }, "Time/Step: 1",
                     "subsection Time\nset End = 3\nend\n");
      expect_refusal({ "'1..4' is no value", "written out" }, "Time/Step: 1..4");
      expect_refusal({ "'0.1:0.1:1' is no value" }, "Time/Step: 0.1:0.1:1");
      expect_refusal({ "'0' twice", "in double quotes" }, "Handles/a/Motion: 0;0;t 0;0;2*t");
      expect_refusal({ "joined by '+', too: 1 + newton." },
                     "Time/Increments + Solver/Method: 1 newton, 2 newton");
    }

    TEST_F(StudyFile, NumbersOfValues)
    {
      EXPECT_EQ(number_of(axis("Time/Step: 1e-3 2"), 0), 1e-3);
      EXPECT_NEAR(number_of(axis("Mesh/Box cells: 8, 1, 1; 16, 2, 2"), 1), 4., 1e-14);
      EXPECT_TRUE(std::isnan(number_of(axis("Solver/Method: 2nd, newton"), 0)));
      EXPECT_EQ(numeric_axis(study("Solver/Method: a b | Time/Step: 1 2").axes), 1u);
      EXPECT_EQ(numeric_axis(study("Solver/Method: a b | Time/Step: 1").axes), std::nullopt);
    }

    TEST_F(StudyFile, LinesAlongTheNumericAxis)
    {
      const Study s = study("Solver/Method: a b | Time/Step: 1 2 4");
      StudyTable  table{ s.axes, {}, true };
      for (const auto &choice : s.choices())
      {
        table.rows.emplace_back();
        table.rows.back().choice = choice;
      }
      const auto lines = lines_of(table);
      ASSERT_EQ(lines.size(), 2u);
      EXPECT_EQ(lines[1].title, "b");
      EXPECT_EQ(lines[1].rows.size(), 3u);
      EXPECT_EQ(lines[1].rows[2], &table.rows[5]);
    }

    TEST_F(StudyFile, StatisticsOfARun)
    {
      const RunStatistics run = read_run_statistics(write_file(
          "statistics.csv", "step,status,iterations,residual,energy_elastic,energy_kinetic,"
                            "min_det_F,work_handles\n"
                            "0,converged,0,0,1,1,1,0\n"
                            "1,converged,2,1e-9,2,3,0.5,4\n"
                            "2,converged,3,1e-10,4,8,0.75,4\n"
                            "3,stalled,50,1e-3,,,,\n"
                            "4,conv"));
      EXPECT_EQ(run.steps, 2.);
      EXPECT_EQ(run.iterations, 55.);
      EXPECT_EQ(run.residual, 1e-3);
      EXPECT_EQ(run.min_det_F, 0.5);
      EXPECT_EQ(run.energy, 12.);
      EXPECT_EQ(run.energy_growth, (12. - 2. - 4.) / 4.);
      EXPECT_TRUE(std::isnan(read_run_statistics(directory / "absent.csv").steps));
    }

    TEST_F(StudyFile, BoundOfImplicitEuler)
    {
      const std::string   head = "step,status,energy_elastic,energy_kinetic,energy_inertia,"
                                 "work_handles,work_gravity\n";
      const RunStatistics run
          = read_run_statistics(write_file("statistics.csv", head
                                                                 + "0,initial,1,3,0,0,0\n"
                                                                   "1,converged,2,9,0.25,0,1\n"
                                                                   "2,converged,90,0,9,5,1\n"
                                                                   "3,converged,89,0,1.5,5,1\n"));
      // 2 + 0.25 - 1 - 4 in the first step, a handle moves in the second, 89 + 1.5 - 90
      EXPECT_DOUBLE_EQ(run.bound_excess, 0.5 / 6.);
      EXPECT_TRUE(std::isnan(
          read_run_statistics(
              write_file("statistics.csv", head + "0,initial,1,3,0,0,0\n1,one pass,2,9,9,0,1\n"))
              .bound_excess));
    }

    class StudyPoses : public InTemporaryDirectory
    {
    protected:
      /// A unit cube of n^3 bricks, displaced.
      template <typename Displacement>
      FinalPose
      pose(const unsigned int n, const Displacement &displacement) const
      {
        const Mesh mesh(generate_box({ { 1., 1., 1. } }, { { n, n, n } }), "box");
        auto       positions = mesh.get_nodes();
        for (auto &position : positions)
          position += displacement(position);
        mesh.write_pose(positions, directory / "final.msh");
        return { mesh, directory / "final.msh" };
      }
    };

    using Vector = dealii::Tensor<1, 3>;

    Vector
    along_x(const dealii::Point<3> &)
    {
      return Vector({ 2., 0., 0. });
    }

    TEST_F(StudyPoses, ErrorsOverTheVolume)
    {
      // the lowest corner belongs to all six tetrahedra and so has a quarter of the volume
      const auto corner = [](const dealii::Point<3> &x) {
        return along_x(x) + Vector({ 0., 0., x.distance({ 0., -0.5, -0.5 }) == 0. ? 1. : 0. });
      };
      const PoseErrors errors = pose_errors(pose(1, corner), pose(1, along_x));
      EXPECT_NEAR(errors.l2, 0.5 / 2., 1e-14);
      EXPECT_NEAR(errors.max, 1. / 2., 1e-14);
      EXPECT_NEAR(pose(1, corner).max_displacement(), std::sqrt(5.), 1e-14);
    }

    TEST_F(StudyPoses, RefinedReference)
    {
      const auto longer = [](const dealii::Point<3> &x) {
        return along_x(x) + Vector({ 1., 0., 0. });
      };
      for (const unsigned int n : { 2u, 3u, 6u, 12u })
        EXPECT_NEAR(pose_errors(pose(n, longer), pose(12, along_x)).l2, 0.5, 1e-12) << n;
      EXPECT_TRUE(std::isnan(pose_errors(pose(5, longer), pose(12, along_x)).l2));
      EXPECT_TRUE(std::isnan(pose_errors(pose(12, longer), pose(6, along_x)).l2));
    }

    TEST(Study, ObservedOrders)
    {
      EXPECT_NEAR(observed_order(4e-3, 1e-3, 0.2, 0.1), 2., 1e-12);
      EXPECT_TRUE(std::isnan(observed_order(0., 1e-3, 0.2, 0.1)));
      EXPECT_TRUE(std::isnan(observed_order(1e-3, 1e-3, 0.1, 0.1)));
    }

    TEST(Study, ParetoFront)
    {
      using Points = std::vector<std::pair<double, double>>;
      EXPECT_EQ(pareto_front({ { 3., 1. }, { 1., 3. }, { 2., 4. }, { 2., 2. }, { 4., 1. } }),
                (Points{ { 1., 3. }, { 2., 2. }, { 3., 1. } }));
    }
  } // namespace
} // namespace Exemplar::Testing
