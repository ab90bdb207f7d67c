// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/body/time_axis.h>
#include <exemplar/mesh/selection.h>
#include <exemplar/prm/expression.h>
#include <exemplar/prm/key_table.h>

#include "body.h"
#include "expect_contains.h"

#include <gtest/gtest.h>

#include <sstream>

namespace Exemplar::Testing
{
  namespace
  {
    /// The message of the UserError that `function` throws.
    template <typename Function>
    std::string
    message_of(const Function &function)
    {
      try
      {
        function();
      }
      catch (const UserError &error)
      {
        return error.what();
      }
      return "no UserError";
    }

    TEST(Expression, EvaluatesComponents)
    {
      const Expression e("key", "x + 2*t; min(y, 1) ; t < 1 ? z : pi", "xyzt", 3);
      const auto       v = e.vector({ 1., 5., 7. }, 3.);
      EXPECT_DOUBLE_EQ(v[0], 7.);
      EXPECT_DOUBLE_EQ(v[1], 1.);
      EXPECT_DOUBLE_EQ(v[2], M_PI);
      EXPECT_DOUBLE_EQ(Expression("key", "log(t)", "t", 1).values({}, M_E)[0], 1.);
    }

    TEST(Expression, RefusesWhatItDoesNotUnderstand)
    {
      EXPECT_NE(message_of([] { Expression("Handles/a/Motion", "x; wobble(t); 0", "xyzt", 3); })
                    .find("wobble"),
                std::string::npos);
      EXPECT_NE(
          message_of([] { Expression("Loads/a/Force", "x; 0; 0", "t", 3); }).find("Loads/a/Force"),
          std::string::npos);
      EXPECT_NE(message_of([] { Expression("key", "0; 0", "t", 3); }).find("has 2"),
                std::string::npos);
      EXPECT_THROW(Expression("key", "log(t-1)", "t", 1).values({}, 0.5), SolverFailure);
    }

    TEST(Expression, CommasStandInFunctionsOnly)
    {
      // muParser would take 0,5*t for 5*t
      const std::string message = message_of([] { Expression("key", "0,5*t", "t", 1); });
      EXPECT_NE(message.find("'0,5*t' holds a comma"), std::string::npos) << message;
      EXPECT_DOUBLE_EQ(Expression("key", "max(2, min(t, 3))", "t", 1).values({}, 2.5)[0], 2.5);
    }

    TEST(TimeAxis, WholeAndShorterSteps)
    {
      TimeParameters parameters;
      parameters.step      = 0.1;
      parameters.end       = 0.3;
      const TimeAxis whole = TimeAxis::of_dynamics(parameters);
      EXPECT_EQ(whole.n_steps(), 3u);
      EXPECT_EQ(whole.step_size(3), 0.1);
      parameters.end         = 0.35;
      const TimeAxis shorter = TimeAxis::of_dynamics(parameters);
      EXPECT_EQ(shorter.n_steps(), 4u);
      EXPECT_EQ(shorter.time(4), 0.35);
      EXPECT_NEAR(shorter.step_size(4), 0.05, 1e-15);
      EXPECT_EQ(shorter.time(2), whole.time(2)); // a later end changes no earlier time
      parameters.end = 0.01;
      EXPECT_EQ(TimeAxis::of_dynamics(parameters).n_steps(), 1u);
      parameters.increments = 10;
      EXPECT_EQ(TimeAxis::of_increments(parameters).time(3), 0.3);
    }

    std::vector<Assignment>
    read(const std::string &text)
    {
      return read_assignments(text, "scene.prm");
    }

    std::string
    error_of(const std::string &text)
    {
      return message_of([&] { read(text); });
    }

    TEST(PrmText, ReadsAssignmentsWithTheirPlaces)
    {
      const auto assignments
          = read("# comment\nset A key  =  1 # more\nsubsection S\n subsection T\n"
                 "  set B = a; \\\n b\n end\nend\n");
      ASSERT_EQ(assignments.size(), 2u);
      EXPECT_EQ(assignments[0].path(), "A key");
      EXPECT_EQ(assignments[0].value, "1");
      EXPECT_EQ(assignments[1].path(), "S/T/B");
      EXPECT_EQ(assignments[1].value, "a;  b");
      EXPECT_EQ(assignments[0].place, "scene.prm:2");
    }

    TEST(PrmText, NamesFileAndLineOfAMistake)
    {
      EXPECT_NE(error_of("set A = 1\nset A = 2\n").find(".prm:2: A is set twice"),
                std::string::npos);
      EXPECT_NE(error_of("subsection S\n").find("'end'"), std::string::npos);
      EXPECT_NE(error_of("end\n").find(".prm:1"), std::string::npos);
      EXPECT_NE(error_of("\nset A 1\n").find(".prm:2"), std::string::npos);
      EXPECT_NE(error_of("sett A = 1\n").find("not understood"), std::string::npos);
    }

    TEST(PrmText, AppliesAndPrintsWhatItRead)
    {
      KeyTable                 keys;
      double                   number = 1.;
      std::string              input;
      std::vector<std::string> inputs;
      keys.enter_subsection("S");
      keys.add("Number", number, "A number.", { 0., 2. });
      keys.add_file("File", input, "A file.");
      keys.add_files("Files", inputs, "Files.");
      keys.leave_subsection();

      keys.apply(read("subsection S\nset Number = 1.5\nset File = ../a.msh\n"
                      "set Files = b.msh, /c/d.msh\nend\n"),
                 "/scenes/here");
      EXPECT_EQ(number, 1.5);
      EXPECT_EQ(input, "/scenes/a.msh");
      EXPECT_EQ(inputs, (std::vector<std::string>{ "/scenes/here/b.msh", "/c/d.msh" }));

      std::ostringstream printed;
      print_keys(printed, keys.keys(), true);
      number = 0.;
      keys.apply(read(printed.str()), "/elsewhere");
      EXPECT_EQ(number, 1.5);
      EXPECT_EQ(input, "/scenes/a.msh");

      EXPECT_NE(message_of([&] { keys.apply(read("subsection S\nset Nunber = 1\nend\n"), "/"); })
                    .find("Did you mean 'S/Number'"),
                std::string::npos);
      EXPECT_NE(message_of([&] { keys.apply({ parse_override("S/Number=3") }, "/"); })
                    .find("Allowed: a number in 0 ... 2"),
                std::string::npos);
    }

    TEST(KeyTable, KeysOfASubsectionFollowOneAnother)
    {
      KeyTable    keys;
      std::string text = "default";
      for (const char *subsection : { "A", "B", "A" })
      {
        keys.enter_subsection(subsection);
        keys.add("Key " + std::to_string(keys.keys().size()), text, "A text.");
        keys.leave_subsection();
      }
      std::vector<std::string> paths;
      for (const DeclaredKey &key : keys.keys())
        paths.push_back(key.path());
      EXPECT_EQ(paths, (std::vector<std::string>{ "A/Key 0", "A/Key 2", "B/Key 1" }));
    }

    TEST(KeyTable, SaysWhatIsAllowed)
    {
      KeyTable                    keys;
      double                      positive = 1.;
      unsigned int                count    = 1;
      bool                        is_so    = false;
      std::array<unsigned int, 3> three{};
      keys.add("Positive", positive, "", Bounds::positive());
      keys.add("Count", count, "", { 1 });
      keys.add("Is so", is_so, "");
      keys.add("Three", three, "", { 0 });
      const auto refusal = [&](const std::string &assignment)
      { return message_of([&] { keys.apply({ parse_override(assignment) }, ""); }); };
      expect_contains(refusal("Positive=0"), "Allowed: a number > 0. Default: '1'");
      expect_contains(refusal("Positive=1 m"), "Allowed: a number > 0");
      expect_contains(refusal("Count=1.5"), "Allowed: an integer >= 1");
      expect_contains(refusal("Count=99999999999"), "Allowed: an integer >= 1");
      expect_contains(refusal("Is so=1"), "Allowed: true or false");
      expect_contains(refusal("Three=1, 2"), "Allowed: three integers >= 0 separated by commas");
      EXPECT_EQ(refusal("Three=1,2 , 3"), "no UserError");
      EXPECT_EQ(three[2], 3u);
    }

    TEST(Selection, SelectsByPlaceAndId)
    {
      const Mesh mesh(box_mesh(4., 4, 1));
      const auto n = [&](const std::string &text)
      { return Selection{ text }.nodes(mesh, "Handles/a/Select").size(); };
      EXPECT_EQ(n("box -1 -1 -1  0 1 1"), 4u);
      EXPECT_EQ(n("box 1 1 1  0 -1 -1"), 8u); // corners in any order
      EXPECT_EQ(n("sphere 0 0.5 0.5  0.1"), 1u);
      EXPECT_EQ(n("boundary 2"), 4u);
      EXPECT_EQ(n("region 1"), mesh.n_nodes());
      const auto message = message_of([&] { n("box 9 9 9 10 10 10"); });
      EXPECT_NE(message.find("Handles/a/Select"), std::string::npos);
      EXPECT_NE(message.find("selects no node"), std::string::npos);
      EXPECT_NE(message_of([&] { n("boundary 7"); }).find("present: 1, 2, 3, 4, 5, 6"),
                std::string::npos);
    }
  } // namespace
} // namespace Exemplar::Testing
