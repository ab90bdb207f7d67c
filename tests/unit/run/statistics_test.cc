// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/output/diagnostics.h>
#include <exemplar/run/output/statistics_file.h>

#include "scene.h"
#include "temporary_directory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace Exemplar::Testing
{
  namespace
  {
    class StatisticsFileTest : public InTemporaryDirectory
    {
    protected:
      StatisticsRow
      row(const unsigned int step) const
      {
        return { { "step", step },
                 { "energy", 0.5 * step },
                 { "status", std::string("converged") } };
      }

      void
      write_three_rows() const
      {
        StatisticsFile statistics(file);
        for (unsigned int step = 0; step < 3; ++step)
          statistics.write(row(step));
      }

      std::string
      text() const
      {
        std::ifstream      in(file, std::ios::binary);
        std::ostringstream bytes;
        bytes << in.rdbuf();
        return bytes.str();
      }

      const std::filesystem::path file = directory / "statistics.csv";
    };

    TEST_F(StatisticsFileTest, HasAHeaderAndALineAStep)
    {
      write_three_rows();
      EXPECT_EQ(text(), "step,energy,status\n0,0,converged\n1,0.5,converged\n2,1,converged\n");
    }

    TEST_F(StatisticsFileTest, WhatIsNotKnownOrNoNumberIsEmpty)
    {
      EXPECT_EQ((StatisticsCell{ "a" }.text()), "");
      EXPECT_EQ((StatisticsCell{ "a", std::nan("") }.text()), "");
      EXPECT_EQ((StatisticsCell{ "a", 0.1 }.text()), "0.1");
      EXPECT_EQ((StatisticsCell{ "a", 7u }.text()), "7");
    }

    TEST_F(StatisticsFileTest, GoesOnBehindWhatIsKept)
    {
      write_three_rows();
      const std::string    whole = text();
      const std::uintmax_t kept  = StatisticsFile::keep_rows(file, 1, row(0));
      EXPECT_EQ(whole.substr(0, kept), "step,energy,status\n0,0,converged\n1,0.5,converged\n");
      {
        StatisticsFile statistics(file, kept);
        EXPECT_EQ(statistics.n_bytes(), kept);
        statistics.write(row(2));
      }
      EXPECT_EQ(text(), whole);
      EXPECT_THROW(StatisticsFile(file, whole.size() + 1), UserError);
      EXPECT_THROW(StatisticsFile::keep_rows(file, 9, row(0)), UserError);
    }

    TEST_F(StatisticsFileTest, EarlierRowsGetTheColumnsOfLaterOnes)
    {
      write_three_rows();
      const StatisticsRow  other = { { "step", 0u }, { "weight", 1. }, { "energy", 0. } };
      const std::uintmax_t kept  = StatisticsFile::keep_rows(file, 1, other);
      EXPECT_EQ(text(), "step,weight,energy\n0,,0\n1,,0.5\n");
      EXPECT_EQ(kept, text().size());
    }

    /// Its value; NaN if there is no such column.
    double
    value_of(const StatisticsRow &row, const std::string &column)
    {
      for (const StatisticsCell &cell : row)
        if (cell.column == column)
          return std::get<double>(cell.value);
      return std::nan("");
    }

    TEST(Diagnostics, TheWorkOfAStaticPullIsTheEnergy)
    {
      // the block is stretched by 0.2: E/2 0.2^2 4 m^3; in 2 implicit steps the work is 3/2 of it
      Scene scene(
          "set Scene = static\n" + bar + "subsection Handles\n set Names = left, right\n"
              + held_left
              + "subsection right\n set Select = boundary 2\n set Motion = 0.8*t; 0; 0\nend\nend\n",
          { "Material/Poisson's ratio=0", "Time/Increments=2" });
      Diagnostics diagnostics(scene.problem);
      SolveReport report;
      for (unsigned int step = 0; step < 2; ++step)
      {
        report = scene.problem.advance();
        diagnostics.add_step();
      }
      const StatisticsRow row    = diagnostics.row(scene.problem.state, report);
      const double        energy = 0.5 * 1e6 * 0.2 * 0.2 * 4.;
      EXPECT_NEAR(value_of(row, "energy_elastic"), energy, 1e-6 * energy);
      EXPECT_NEAR(value_of(row, "reaction_right_x"), 1e6 * 0.2, 1e-6 * energy);
      EXPECT_NEAR(value_of(row, "reaction_left_x"), -1e6 * 0.2, 1e-6 * energy);
      EXPECT_NEAR(value_of(row, "work_handles"), 1.5 * energy, 1e-6 * energy);
      EXPECT_TRUE(std::isnan(value_of(row, "energy_kinetic"))); // no such column
      EXPECT_TRUE(std::isnan(value_of(row, "work_gravity")));
    }

    TEST(Diagnostics, OfAFallAreThoseOfAPoint)
    {
      const double h = 0.1, g = 10., m = 4000.;
      Scene        scene("set Scene = dynamic\n" + bar
                         + "subsection Loads\n set Gravity = 0, 0, -10\nend\n"
                         + "subsection Time\n set Step = 0.1\n set End = 0.3\nend\n");
      Diagnostics  diagnostics(scene.problem);
      diagnostics.resume({ 0., 5., 0. });
      SolveReport report;
      double      fallen = 0.;
      for (unsigned int step = 1; step <= 3; ++step)
      {
        report = scene.problem.advance();
        diagnostics.add_step();
        fallen += h * (g * h * step);
      }
      const StatisticsRow row = diagnostics.row(scene.problem.state, report);
      const double        v   = 3. * g * h;
      EXPECT_NEAR(value_of(row, "momentum_z"), -m * v, 1e-6 * m * v);
      EXPECT_NEAR(value_of(row, "energy_kinetic"), 0.5 * m * v * v, 1e-6 * m * v * v);
      EXPECT_NEAR(value_of(row, "work_gravity"), 5. + m * g * fallen, 1e-6 * m * g * fallen);
    }
  } // namespace
} // namespace Exemplar::Testing
