// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/body/time_axis.h>
#include <exemplar/mesh/selection.h>
#include <exemplar/prm/expression.h>
#include <exemplar/prm/prm_tools.h>

#include "body.h"

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
      dealii::ParameterHandler prm;
      double                   number = 1.;
      std::string              input;
      std::vector<std::string> inputs;
      prm.enter_subsection("S");
      prm.add_parameter("Number", number, "A number.", dealii::Patterns::Double(0., 2.));
      declare_input_file(prm, "File", input, "A file.");
      declare_input_files(prm, "Files", inputs, "Files.");
      prm.leave_subsection();

      apply_assignments(prm,
                        read("subsection S\nset Number = 1.5\nset File = ../a.msh\n"
                             "set Files = b.msh, /c/d.msh\nend\n"),
                        "/scenes/here");
      EXPECT_EQ(number, 1.5);
      EXPECT_EQ(input, "/scenes/a.msh");
      EXPECT_EQ(inputs, (std::vector<std::string>{ "/scenes/here/b.msh", "/c/d.msh" }));

      std::ostringstream printed;
      print_keys(printed, declared_keys(prm), true);
      number = 0.;
      apply_assignments(prm, read(printed.str()), "/elsewhere");
      EXPECT_EQ(number, 1.5);
      EXPECT_EQ(input, "/scenes/a.msh");

      EXPECT_NE(
          message_of([&]
                     { apply_assignments(prm, read("subsection S\nset Nunber = 1\nend\n"), "/"); })
              .find("Did you mean 'S/Number'"),
          std::string::npos);
      EXPECT_NE(message_of([&] { apply_assignments(prm, { parse_override("S/Number=3") }, "/"); })
                    .find("Allowed: a number in 0 ... 2"),
                std::string::npos);
    }

    TEST(Selection, SelectsByPlaceAndId)
    {
      const Mesh mesh(box_mesh(4., 4, 1));
      const auto n = [&](const std::string &text)
      { return Selection{ text }.nodes(mesh, "Handles/a").size(); };
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
