// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/problem/idle_review.h>
#include <exemplar/run/problem/inventory.h>
#include <exemplar/run/scene/scene_file.h>

#include "expect_contains.h"
#include "scene.h"

#include <gtest/gtest.h>

#include <set>

// What a scene says in vain, and what a problem is made of.

namespace Exemplar::Testing
{
  namespace
  {
    const std::string held_bar = "set Scene = static\n" + bar
                                 + "subsection Handles\n set Names = left\n" + held_left + "end\n";

    std::string
    pull(const std::string &select, const std::string &force)
    {
      return "subsection Loads\n set Names = pull\n subsection pull\n set Select = " + select
             + "\n set Force = " + force + "\n end\nend\n";
    }

    TEST(IdleReview, ALoadOnHeldNodesMovesNothing)
    {
      const auto warnings = [](const std::string &text)
      { return idle_load_warnings(Scene(held_bar + text).problem); };
      ASSERT_EQ(warnings(pull("boundary 1", "1; 0; 0")).size(), 1u);
      expect_contains(warnings(pull("boundary 1", "1; 0; 0")).front(), "Loads/pull moves nothing");
      EXPECT_TRUE(warnings(pull("boundary 2", "1; 0; 0")).empty());
      EXPECT_TRUE(warnings(pull("boundary 3", "1; 0; 0")).empty()); // holds some of its nodes
      EXPECT_TRUE(warnings("").empty());
    }

    TEST(IdleReview, NotesThatNothingHappens)
    {
      const auto n_notes = [](const std::string &text, const std::vector<std::string> &more = {})
      { return idle_notes(Scene(text, more).problem).size(); };
      EXPECT_EQ(n_notes(held_bar), 1u);
      EXPECT_EQ(n_notes("set Scene = static\n" + bar + drag), 0u);
      EXPECT_EQ(n_notes(held_bar + pull("boundary 2", "1; 0; 0")), 0u);
      EXPECT_EQ(n_notes(held_bar, { "Initial/Pose function=1.1*x; y; z" }), 0u);
      EXPECT_EQ(n_notes(held_bar + examples(two_poses)), 1u); // the rest pose is an example
      EXPECT_EQ(n_notes(held_bar + examples(two_poses + "set Include rest pose = false\n")), 0u);
    }

    /// With `false` those that are not there.
    std::set<std::string>
    parts(const std::string &text, const bool are_there)
    {
      std::set<std::string> names;
      const Scene           scene(text);
      for (const PartOfProblem &part : inventory(scene.problem))
      {
        if (part.is_there == are_there)
          names.insert(part.name);
        if (part.bytes && part.is_there)
        {
          EXPECT_EQ(*part.bytes > 0, *part.is_there) << part.name;
        }
      }
      return names;
    }

    TEST(Inventory, HasWhatASceneNeedsAndNothingElse)
    {
      const std::set<std::string> statics  = parts(held_bar, true),
                                  left_out = parts(held_bar, false);
      EXPECT_EQ(statics, (std::set<std::string>{ "Cholesky factor", "frame writer", "handles",
                                                 "mean dilatation by patches" }));
      for (const std::string name :
           { "mass matrix", "gravity", "loads", "example poses", "weight block", "Schur complement",
             "UMFPACK", "own support of interpolation" })
        EXPECT_EQ(left_out.count(name), 1u) << name;
      const auto loaded = parts(held_bar + pull("boundary 2", "1; 0; 0"), true);
      EXPECT_EQ(loaded.count("loads"), 1u);
      EXPECT_EQ(loaded.count("mass matrix"), 0u);
      const auto free_weights = parts(held_bar + examples(two_poses), true);
      for (const std::string name : { "example poses", "weight block", "Schur complement" })
        EXPECT_EQ(free_weights.count(name), 1u) << name;
      const auto dynamic = parts("set Scene = dynamic\n" + bar, true);
      EXPECT_EQ(dynamic.count("mass matrix"), 1u);
      EXPECT_EQ(dynamic.count("handles"), 0u);
    }

    TEST(IgnoredKeys, AreNamedWithTheirPlaceAndARemedy)
    {
      const auto warnings = [](const std::string &text)
      { return SceneFile("my.prm", text, std::vector<std::string>{}).get_parameters().warnings; };
      EXPECT_TRUE(warnings(held_bar).empty());
      const auto of_step = warnings(held_bar + "subsection Time\n set Step = 0.1\nend\n");
      ASSERT_EQ(of_step.size(), 1u);
      expect_contains(of_step.front(),
                      "Time/Step = 0.1 does nothing in a scene that is not dynamic");
      expect_contains(of_step.front(), "my.prm");
      const auto of_importance = warnings(held_bar + examples("set Importance = 0.5\n"));
      ASSERT_EQ(of_importance.size(), 1u);
      expect_contains(of_importance.front(), "without examples");
      const auto of_increments
          = warnings("set Scene = dynamic\n" + bar + "subsection Time\n set Increments = 7\nend\n");
      ASSERT_EQ(of_increments.size(), 1u);
      expect_contains(of_increments.front(), "Time/Increments = 7 does nothing in a dynamic scene");
    }
  } // namespace
} // namespace Exemplar::Testing
