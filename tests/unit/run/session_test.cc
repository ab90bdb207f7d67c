// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/problem/session_player.h>

#include "expect_contains.h"
#include "scene.h"
#include "temporary_directory.h"

#include <gtest/gtest.h>

#include <cmath>

namespace Exemplar::Testing
{
  namespace
  {
    const std::string dragged_bar
        = bar + "subsection Handles\n set Names = left\n" + held_left + "end\n";

    const std::string held_static
        = "set Scene = static\n" + dragged_bar + "subsection Time\n set Increments = 1\nend\n";

    /// The nodes of a face of the boundary that no handle holds.
    std::vector<unsigned int>
    free_face(const Problem &problem)
    {
      for (const auto &face : problem.body.mesh.get_boundary_faces())
      {
        bool is_free = true;
        for (const unsigned int node : face.nodes)
          is_free &= problem.constraints.free_dofs.free_index(3 * node) != FreeDofs::held;
        if (is_free)
          return { face.nodes.begin(), face.nodes.end() };
      }
      return {};
    }

    /// Pulls at a face with unequal shares, and offsets that open it.
    SessionEvent
    grab(const Problem &problem)
    {
      return { 1,
               "grab",
               "a",
               free_face(problem),
               { 0.2, 0.1, 0., 0., 0.3, 0., 0.2, 0., 0.5, 0., 0., -0.1, 0.7, 0.4, 1.9, 1e3 } };
    }

    TEST(SessionPlayer, ASpringPullsAsMuchAsTheHandleHolds)
    {
      Scene         scene(held_static);
      Problem      &problem = scene.problem;
      SessionPlayer player(problem);
      const auto    event = grab(problem);
      player.apply(event);
      ASSERT_TRUE(is_success(problem.advance().status));
      dealii::Tensor<1, 3> force;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int c = 0; c < 3; ++c)
          force[c] += 1e3 * event.numbers[4 * i]
                      * (event.numbers[12 + c] + event.numbers[4 * i + 1 + c]
                         - problem.state.positions[3 * event.nodes[i] + c]);
      const auto reaction = problem.constraints.handles.sum_over(0, problem.evaluation.gradient);
      EXPECT_GT(force.norm(), 1.);
      EXPECT_LT((reaction + force).norm(), 1e-5 * force.norm());
    }

    TEST(SessionPlayer, SpringsHaveTheTangentOfTheirForces)
    {
      Scene         scene(held_static);
      Problem      &problem = scene.problem;
      SessionPlayer player(problem);
      player.apply(grab(problem));
      Laboratory           &lab   = problem.laboratory();
      const Exemplar::Place here  = lab.here();
      const double          h     = 1e-6;
      const unsigned int    dof   = 3 * free_face(problem)[1] + 2;
      const auto            along = [&](const double way)
      {
        Exemplar::Place there = here;
        there.positions[dof] += way;
        const Evaluation &evaluation = lab.evaluate(there);
        return std::make_pair(evaluation.potential, Vector(evaluation.gradient));
      };
      const auto before = along(-h), after = along(h), at = along(0.);
      EXPECT_NEAR((after.first - before.first) / (2. * h), at.second[dof],
                  1e-5 * std::abs(at.second[dof]));
      EXPECT_GT(std::abs(at.second[dof]), 1.);
      const RowMatrix hessian = lab.hessian(here, Tangent::exact);
      for (std::size_t entry = hessian.row_start[dof];
           entry < std::size_t(hessian.row_start[dof + 1]); ++entry)
      {
        const unsigned int column = hessian.column[entry];
        const double       slope  = (after.second[column] - before.second[column]) / (2. * h);
        EXPECT_NEAR(hessian.value[entry], slope, 1e-5 * 1e6);
      }
    }

    TEST(SessionPlayer, RefusesWhatIsNoEvent)
    {
      Scene         scene(held_static);
      SessionPlayer player(scene.problem);
      const auto    message = [&](const SessionEvent &event)
      {
        try
        {
          player.apply(event);
        }
        catch (const UserError &error)
        {
          return std::string(error.what());
        }
        return std::string();
      };
      const double nan = std::nan("");
      expect_contains(message({ 1, "fly", "", {}, {} }), "cannot be done");
      expect_contains(message({ 1, "move", "a", {}, { 0., 0., 0. } }), "no such spring");
      expect_contains(message({ 1, "release", "a", {}, {} }), "no such spring");
      expect_contains(message({ 1, "move", "a", {}, { 0., 0. } }), "2 numbers");
      expect_contains(message({ 1, "grab", "a", { 100000 }, { 1., 0., 0., 0., 0., 0., 0., 1. } }),
                      "another mesh");
      SessionEvent soft = grab(scene.problem);
      soft.numbers[15]  = nan;
      expect_contains(message(soft), "above 0");
      SessionEvent pushing = grab(scene.problem);
      pushing.numbers[4]   = -1.;
      expect_contains(message(pushing), "no share");
      expect_contains(message({ 1, "grab", "a", { 0, 1 }, { 1., 0., 0., 0., 1. } }),
                      "four numbers");
      expect_contains(message({ 1, "hold", "a", { 2, 1 }, std::vector<double>(6) }), "ascending");
      expect_contains(message({ 1, "shift", "left", {}, { 0., 0., 0. } }), "held by hand");
      expect_contains(message({ 1, "let go", "right", {}, {} }), "right");
      EXPECT_TRUE(player.get_springs().empty());
    }

    class SessionFile : public InTemporaryDirectory
    {
    };

    TEST_F(SessionFile, IsReadAsItWasWritten)
    {
      const Session session = { { 3, "grab", "a", { 1, 2, 3 }, { 0.1, 1. / 3., 1e-300, -0. } },
                                { 3, "let go", "right hind paw", {}, {} } };
      std::string   text    = head_of_session();
      for (const SessionEvent &event : session)
        text += line_of(event);
      const Session read = read_session(write_file("session.txt", text)).events;
      ASSERT_EQ(read.size(), session.size());
      for (std::size_t i = 0; i < read.size(); ++i)
      {
        EXPECT_EQ(read[i].step, session[i].step);
        EXPECT_EQ(read[i].what, session[i].what);
        EXPECT_EQ(read[i].name, session[i].name);
        EXPECT_EQ(read[i].nodes, session[i].nodes);
        EXPECT_EQ(read[i].numbers, session[i].numbers);
      }
    }
  } // namespace
} // namespace Exemplar::Testing
