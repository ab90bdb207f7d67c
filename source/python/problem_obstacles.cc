// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/python/arrays_from_python.h>
#include <exemplar/python/held_problem.h>
#include <exemplar/python/module_parts.h>
#include <exemplar/run/problem/obstacle_start.h>
#include <exemplar/run/problem/state_review.h>

#include <fmt/core.h>

#include <cmath>

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
      py::dict                  result;
      const ObstacleTerm *const of_obstacles = find_obstacle_term(held.get());
      if (of_obstacles == nullptr)
        return result;
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
      const py::ssize_t   n       = problem.body.fe_space.numbering().n_places(); // without slopes
      py::array_t<double> forces({ n, py::ssize_t(3) });
      const Vector        values = Exemplar::contact_forces(problem);
      std::copy_n(values.begin(), forces.size(), forces.mutable_data());
      return read_only(std::move(forces));
    }
    /// Vertices and triangles of a tuple of arrays.
    ObstacleSurface
    surface_of(const py::tuple &arrays)
    {
      if (arrays.size() != 2)
        throw UserError("shape: a surface is a tuple (vertices (n, 3), triangles (m, 3)).");
      ObstacleSurface surface;
      for (const dealii::Point<3> &x : points_of(arrays[0], "shape: vertices"))
        surface.vertices.push_back({ { x[0], x[1], x[2] } });
      for (const dealii::Point<3> &corners : points_of(arrays[1], "shape: triangles"))
      {
        surface.triangles.emplace_back();
        for (unsigned int k = 0; k < 3; ++k)
        {
          if (!(corners[k] >= 0. && corners[k] < static_cast<double>(surface.vertices.size())
                && corners[k] == std::floor(corners[k])))
            throw UserError(
                fmt::format("shape: triangle {} has the vertex {}, but vertices go from 0 to {}.",
                            surface.triangles.size() - 1, shortest_text(corners[k]),
                            surface.vertices.size() - 1));
          surface.triangles.back()[k] = static_cast<unsigned int>(corners[k]);
        }
      }
      return surface;
    }

    void
    add_obstacle(HeldProblem       &held,
                 const std::string &name,
                 const py::object  &shape,
                 const std::string &motion,
                 const std::string &turn,
                 const py::object  &friction)
    {
      ObstacleParameters added;
      ObstacleSurface    surface;
      added.name     = name;
      added.motion   = motion;
      added.turn     = turn;
      added.friction = real_number_of(friction, "add_obstacle: friction");
      if (py::isinstance<py::str>(shape))
        added.shape = shape.cast<std::string>();
      else if (py::isinstance<py::tuple>(shape))
      {
        surface     = surface_of(shape.cast<py::tuple>());
        added.shape = "surface " + name;
      }
      if (added.shape.empty() || (surface.vertices.empty() && !added.surface_file().empty()))
        throw UserError(
            "shape: found " + description(shape)
            + ". Allowed: a text as of Obstacles/NAME/Shape, but of no file, or a tuple "
              "(vertices (n, 3), triangles (m, 3)) [m].");
      held.change("add_obstacle()",
                  [&](Problem &changed) { changed.add_obstacle(added, surface); });
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
    const ObstacleParameters usual;
    problem.def(
        "add_obstacle", &add_obstacle, py::arg("name"), py::arg("shape"),
        py::arg("motion") = usual.motion, py::arg("turn") = usual.turn,
        py::arg("friction") = usual.friction,
        "add_obstacle(name, shape, motion='0; 0; 0', turn='0; 0; 0', friction=0.0)\n\n"
        "From the next step on there is a further obstacle: shape is a text as of "
        "Obstacles/NAME/Shape,\n"
        "'plane 0 0 0 0 0 1', or a tuple (vertices (n, 3) [m], triangles (m, 3)), motion [m] "
        "and turn\n"
        "[rad] are formulas of t. What touches it now stands, as at the beginning of a "
        "scene. It stays\n"
        "after reset(). Raises UserError, with nothing changed, where the body is inside of "
        "it, for a\n"
        "name that is there already, and for what a scene with obstacles is refused for.");
    refuse_other_arguments(problem, "add_obstacle",
                           "add_obstacle is called as add_obstacle(name, shape, motion=..., "
                           "turn=..., friction=...).");
    problem.def_property_readonly(
        "friction_settled",
        [](const HeldProblem &held) { return friction_has_settled(held.get()); },
        "False if the normal forces of friction in the last step are not those of its end, to\n"
        "Obstacles/Lag tolerance. True without friction.");
    problem.def_property_readonly("contact_forces", &contact_forces,
                                  "Forces (n, 3) [N] on the nodes by all obstacles and, with "
                                  "Contact/Self or Bodies, by the body itself,\n"
                                  "a read-only copy; with Element = P2 n counts the nodes in the "
                                  "middles of edges, too.");
  }
} // namespace Exemplar::Python
