// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/obstacle_term.h>
#include <exemplar/python/held_problem.h>
#include <exemplar/python/module_parts.h>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    py::array
    read_only(py::array_t<double> array)
    {
      array.attr("flags").attr("writeable") = false;
      return std::move(array);
    }

    py::array
    array_of(const SpaceVector3 &vector)
    {
      const std::array<double, 3> numbers{ { vector[0], vector[1], vector[2] } };
      return read_only(py::array_t<double>(3, numbers.data()));
    }

    py::dict
    obstacles(const HeldProblem &held)
    {
      py::dict result;
      for (const auto &term : held.get().potential.get_terms())
        if (const auto *const of_obstacles = dynamic_cast<const ObstacleTerm *>(term.get()))
          for (const ObstacleReport &report : of_obstacles->report())
          {
            py::dict one;
            one["force"]                 = array_of(report.force);
            one["torque"]                = array_of(report.torque);
            one["work"]                  = report.work;
            one["heat"]                  = report.heat;
            result[py::str(report.name)] = one;
          }
      return result;
    }

    py::array
    contact_forces(const HeldProblem &held)
    {
      const Problem      &problem = held.get();
      py::array_t<double> forces({ py::ssize_t(problem.body.fe_space.n_nodes()), py::ssize_t(3) });
      std::fill_n(forces.mutable_data(), forces.size(), 0.);
      for (const auto &term : problem.potential.get_terms())
        if (term->name() == "obstacles")
        {
          std::vector<NodalField> fields;
          term->append_fields(problem.state.positions, fields);
          std::copy(fields.front().values.begin(), fields.front().values.end(),
                    forces.mutable_data());
        }
      return read_only(std::move(forces));
    }
  } // namespace

  void
  add_obstacles(ProblemClass &problem)
  {
    problem.def_property_readonly(
        "obstacles", &obstacles,
        "What each obstacle did to the body: a dictionary by names, of dictionaries with 'force' "
        "(3,)\n"
        "[N] and 'torque' (3,) [N m] at the end of the last step, and 'work' and the 'heat' of "
        "friction\n"
        "[J] since the beginning, as in doc/contact.md. Empty without obstacles.");
    problem.def_property_readonly("contact_forces", &contact_forces,
                                  "Forces (n, 3) [N] of all obstacles on the nodes, a read-only "
                                  "copy; with Element = P2 n counts the\n"
                                  "nodes in the middles of edges, too.");
  }
} // namespace Exemplar::Python
