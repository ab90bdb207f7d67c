// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/body/handles.h>

#include "body.h"
#include "matrices.h"
#include "scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace Exemplar::Testing
{
  namespace
  {
    TimeAxis
    increments(const unsigned int n)
    {
      TimeParameters parameters;
      parameters.increments = n;
      return TimeAxis::of_increments(parameters);
    }

    HandleParameters
    tip(const std::string &motion = "0; 0; 0", const std::string &select = "boundary 2")
    {
      HandleParameters parameters;
      parameters.name        = "tip";
      parameters.select.text = select;
      parameters.motion      = motion;
      return parameters;
    }

    /// A handle at the end x = 4 of a bar that follows a pose.
    class FollowPose : public testing::Test
    {
    protected:
      /// The bar turned about the axis through (4, 0, 0) by 157 degrees, and moved.
      dealii::Point<3>
      turned(const dealii::Point<3> &x) const
      {
        const Vector3<double> y = Q * Vector3<double>{ { x[0] - 4., x[1], x[2] } };
        return { y[0] + 3., y[1] + 1., y[2] - 2. };
      }

      HandleParameters
      follow(const Mesh &pose_mesh)
      {
        poses["pose"].clear();
        for (const auto &x : pose_mesh.get_nodes())
          poses["pose"].push_back(turned(x));
        HandleParameters parameters = tip();
        parameters.follow_pose      = "pose";
        return parameters;
      }

      std::vector<unsigned int>
      end_nodes() const
      {
        return tip().select.nodes(mesh, "Handles/tip/Select");
      }

      dealii::Vector<double>
      positions(const HandleParameters &parameters, const double time) const
      {
        dealii::Vector<double> result(3 * mesh.n_nodes());
        Handles({ parameters }, mesh, FESpace(mesh), increments(4), poses).move(time, result);
        return result;
      }

      dealii::Point<3>
      node(const dealii::Vector<double> &all, const unsigned int index) const
      {
        return { all[3 * index], all[3 * index + 1], all[3 * index + 2] };
      }

      std::string
      error_of(const HandleParameters &parameters) const
      {
        try
        {
          Handles({ parameters }, mesh, FESpace(mesh), increments(4), poses);
        }
        catch (const UserError &error)
        {
          return error.what();
        }
        return "";
      }

      NamedPoses            poses;
      const Mesh            mesh = Mesh(box_mesh(4., 4, 2));
      const Matrix3<double> Q    = rotation_about({ { 0.2, 1., -0.4 } }, 157. * M_PI / 180.);
    };

    TEST_F(FollowPose, GoesFromRestToThePoseAsARigidBody)
    {
      const HandleParameters       parameters = follow(mesh);
      const dealii::Vector<double> rest       = positions(parameters, 0.),
                                   end        = positions(parameters, 1.);
      for (const unsigned int i : end_nodes())
      {
        EXPECT_EQ(node(rest, i).distance(mesh.get_nodes()[i]), 0.);
        EXPECT_LT(node(end, i).distance(turned(mesh.get_nodes()[i])), 1e-14 * 10);
      }
      for (const double t : { 0.2, 0.5, 0.8 })
      {
        const dealii::Vector<double> now = positions(parameters, t);
        for (const unsigned int i : end_nodes())
          for (const unsigned int j : end_nodes())
            EXPECT_NEAR(node(now, i).distance(node(now, j)),
                        mesh.get_nodes()[i].distance(mesh.get_nodes()[j]), 1e-12);
      }
    }

    TEST_F(FollowPose, ProgressIsAFunctionOfTime)
    {
      HandleParameters parameters = follow(mesh);
      const auto       half       = positions(parameters, 0.5);
      parameters.progress         = "t^2";
      EXPECT_LT(max_difference(positions(parameters, std::sqrt(0.5)), half), 1e-14 * 10);
      std::vector<dealii::Point<3>> start, now;
      for (const unsigned int i : end_nodes())
      {
        start.push_back(mesh.get_nodes()[i]);
        now.push_back(node(half, i));
      }
      EXPECT_NEAR(axis_and_angle(best_rigid_motion(start, now).rotation).angle * 180. / M_PI, 78.5,
                  1e-11);
    }

    TEST_F(FollowPose, WarnsOfProgressFarBeyondThePose)
    {
      HandleParameters parameters = follow(mesh);
      const auto       warnings   = [&](const std::string &progress)
      {
        parameters.progress = progress;
        return Handles({ parameters }, mesh, FESpace(mesh), increments(4), poses).get_warnings();
      };
      ASSERT_EQ(warnings("100*t").size(), 1u);
      EXPECT_NE(warnings("100*t")[0].find("tip/Progress goes to 100, but"), std::string::npos);
      EXPECT_NE(warnings("-3*t")[0].find("goes to -3"), std::string::npos);
      EXPECT_TRUE(warnings("1.5*t").empty());
      EXPECT_TRUE(warnings("sin(2*pi*t)").empty());
    }

    TEST_F(FollowPose, MovesTheHeldComponentsOnly)
    {
      const HandleParameters all = follow(mesh);
      HandleParameters       two = all;
      two.components             = "x, z";
      const auto of_all = positions(all, 0.7), of_two = positions(two, 0.7);
      for (const unsigned int i : end_nodes())
      {
        EXPECT_EQ(of_two[3 * i], of_all[3 * i]);
        EXPECT_EQ(of_two[3 * i + 1], 0.);
        EXPECT_EQ(of_two[3 * i + 2], of_all[3 * i + 2]);
      }
      EXPECT_EQ(Handles({ two }, mesh, FESpace(mesh), increments(1), poses).held_dofs().size(),
                2 * end_nodes().size());
    }

    TEST_F(FollowPose, HasTheScaleOfTheMesh)
    {
      MeshParameters scaled = box_mesh(4., 4, 2);
      const auto     pose   = follow(mesh);
      scaled.scale          = 0.5;
      const Mesh             small(scaled);
      dealii::Vector<double> end(3 * small.n_nodes());
      Handles({ pose }, small, FESpace(small), increments(1), poses).move(1., end);
      for (const unsigned int i : end_nodes())
      {
        const auto expected = turned(mesh.get_nodes()[i]);
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(end[3 * i + c], 0.5 * expected[c], 1e-14 * 10);
      }
    }

    TEST_F(FollowPose, RefusesWhatCannotBeMeant)
    {
      const HandleParameters good = follow(mesh);
      EXPECT_EQ(error_of(good), "");
      HandleParameters bad = good;
      bad.motion           = "0;0;0"; // says nothing else than the default
      EXPECT_EQ(error_of(bad), "");
      bad.motion = "0; 0; t";
      EXPECT_NE(error_of(bad).find("Handles/tip/Follow pose and Handles/tip/Motion = '0; 0; t'"),
                std::string::npos);
      bad          = tip();
      bad.progress = "t^2";
      EXPECT_NE(error_of(bad).find("Handles/tip/Progress = 't^2'"), std::string::npos);
      bad          = good;
      bad.progress = "x";
      EXPECT_NE(error_of(bad).find("Handles/tip/Progress"), std::string::npos);
      bad             = good;
      bad.follow_pose = "absent";
      EXPECT_NE(error_of(bad).find("Handles/tip/Follow pose: there is no pose 'absent'"),
                std::string::npos);
      follow(Mesh(box_mesh(4., 3, 2)));
      EXPECT_NE(error_of(good).find("Handles/tip/Follow pose: the pose 'pose' has 36 nodes"),
                std::string::npos);
    }

    TEST_F(FollowPose, AHandleThatDisagreesWithAnotherIsRefused)
    {
      HandleParameters other = tip("0; 0; 0", "box 3.9 -1 -1 5 1 1");
      other.name             = "other";
      EXPECT_THROW(Handles({ follow(mesh), other }, mesh, FESpace(mesh), increments(2), poses),
                   UserError);
      HandleParameters same = follow(mesh);
      same.name             = "other";
      EXPECT_NO_THROW(Handles({ follow(mesh), same }, mesh, FESpace(mesh), increments(2), poses));
    }

    TEST_F(FollowPose, SolvesAScene)
    {
      const HandleParameters parameters = follow(Mesh(box_mesh(4., 4, 1)));
      Scene scene("set Scene = static\n" + bar + "subsection Handles\n set Names = left, right\n"
                      + held_left
                      + "subsection right\n set Select = boundary 2\n set Follow pose = "
                      + parameters.follow_pose + "\n set Progress = 0.2*t\nend\nend\n",
                  {}, { {}, poses, {} });
      EXPECT_TRUE(scene.problem.warnings().empty());
      EXPECT_NO_THROW(scene.solve());
    }

    // ---- the warning

    std::vector<std::string>
    warnings_of_handles(const std::string &motion,
                        const unsigned int n          = 10,
                        const std::string &components = "x, y, z",
                        const std::string &select     = "boundary 2")
    {
      static const Mesh mesh(box_mesh(4., 4, 2));
      HandleParameters  parameters = tip(motion, select);
      parameters.components        = components;
      return Handles({ parameters }, mesh, FESpace(mesh), increments(n)).get_warnings();
    }

    /// A rotation of the tip about y by an angle, times a function.
    std::string
    rotation(const std::string &angle, const std::string &factor = "1")
    {
      const auto times
          = [&](const std::string &formula) { return "(" + factor + ")*(" + formula + ")"; };
      return times("(x-4)*(cos(" + angle + ")-1)+z*sin(" + angle + ")") + "; 0; "
             + times("z*(cos(" + angle + ")-1)-(x-4)*sin(" + angle + ")");
    }

    const std::string angle_157 = "157*pi/180", angle_25 = "25*pi/180", angle_15 = "15*pi/180";

    TEST(StraightTurn, IsWarnedOfWithItsAngle)
    {
      const auto all = warnings_of_handles(rotation(angle_157, "t"));
      ASSERT_EQ(all.size(), 1u);
      for (const char *part :
           { "Handles/tip/Motion", "157 degrees", "20 %", "Handles/tip/Follow pose", "cos" })
        EXPECT_NE(all[0].find(part), std::string::npos) << all[0];
    }

    TEST(StraightTurn, IsFoundInManyGuises)
    {
      EXPECT_EQ(warnings_of_handles(rotation(angle_25, "t")).size(), 1u);
      EXPECT_EQ(warnings_of_handles(rotation("pi", "t")).size(), 1u);
      EXPECT_EQ(warnings_of_handles(rotation(angle_157, "t"), 2).size(), 1u);
      EXPECT_EQ(warnings_of_handles(rotation(angle_157, "t"), 1000).size(), 1u);
      EXPECT_EQ(warnings_of_handles(rotation(angle_157, "min(2*t,1)")).size(), 1u); // then it rests
      EXPECT_EQ(warnings_of_handles(rotation(angle_157, "sin(pi*t)")).size(), 1u); // there and back
      EXPECT_EQ(warnings_of_handles(rotation(angle_157, "t") + "+sin(9*t)").size(),
                1u); // on a curve
      EXPECT_EQ(warnings_of_handles(rotation(angle_157, "(1-cos(pi*t))/2")).size(), 1u); // softly
      EXPECT_EQ(warnings_of_handles("0; -2*t*y; -2*t*z").size(), 1u); // half turn
      EXPECT_EQ(warnings_of_handles("0; t*(-1.8*y-0.3*z); t*(0.3*y-1.8*z)").size(),
                1u); // not rigid
    }

    TEST(StraightTurn, IsNotFoundWhereThereIsNone)
    {
      for (const std::string &motion :
           { std::string("0; 0; 0"), std::string("t; 2*t; -t"),              // translations
             std::string("sin(t); cos(t)-1; 0"), std::string("0; t*y; t*z"), // stretch
             std::string("0; -0.9*t*y; -0.9*t*z"),                           // crushed, no turn
             std::string("0; 2*t*z; 0"),                                     // shear
             rotation(angle_15, "t"), rotation(angle_157 + "*t"), rotation(angle_25 + "*t"),
             rotation("4*pi*t"), rotation("pi*t"), rotation("pi*sin(pi*t)"),
             rotation(angle_157 + "*(1-cos(pi*t))/2"), rotation(angle_157),
             rotation(angle_157, "t<0.5 ? 0 : 1") })
        for (const unsigned int n : { 1u, 2u, 3u, 10u, 50u })
          for (const std::string &warning : warnings_of_handles(motion, n))
            EXPECT_EQ(warning.find("straight"), std::string::npos)
                << motion << ", increments: " << n;
      EXPECT_TRUE(warnings_of_handles(rotation(angle_157, "t"), 10, "x, z").empty()); // y is free
      for (const char *line : { "box 3.9 -1 -1 5 -0.4 1", "sphere 4 0 0 0.1" })
        EXPECT_TRUE(warnings_of_handles(rotation(angle_157, "t"), 10, "x, y, z", line).empty())
            << line;
    }

    TEST(LargeTurn, IsWarnedOfFromHalfATurnInAStepOn)
    {
      for (const auto &[motion, n] : { std::pair(rotation("2*pi*t"), 1u),
                                       { rotation("4*pi*t"), 2u },
                                       { rotation("12*pi*t"), 1u },
                                       { rotation("pi*t"), 1u },
                                       { rotation("2*pi*sin(pi*t)"), 1u } })
      {
        const auto all = warnings_of_handles(motion, n);
        ASSERT_EQ(all.size(), 1u) << motion << ", increments: " << n;
        EXPECT_NE(all[0].find("degrees in a step"), std::string::npos) << all[0];
      }
      EXPECT_NE(warnings_of_handles(rotation("4*pi*t"), 2)[0].find("360 degrees in a step"),
                std::string::npos);
      for (const auto &[motion, n] : { std::pair(rotation("4*pi*t"), 10u),
                                       { rotation(angle_157 + "*t"), 1u },
                                       { std::string("-8*t; 0; 0"), 1u },
                                       { std::string("0; -2*t*y; -2*t*z + x-x"), 1u },
                                       { std::string("0; 0; 0"), 1u } })
        for (const std::string &warning : warnings_of_handles(motion, n))
          EXPECT_EQ(warning.find("in a step"), std::string::npos) << warning;
    }
  } // namespace
} // namespace Exemplar::Testing
