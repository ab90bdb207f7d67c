// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/python/arrays_from_python.h>
#include <exemplar/python/problem_gradients.h>
#include <exemplar/run/adjoint/certificate.h>
#include <exemplar/run/adjoint/gradients.h>

#include <fmt/core.h>

#include <algorithm>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    /// The direction (dJ/dx, dJ/dw); None stands for zero.
    Direction
    functional_of(const std::string &method,
                  const py::object  &by_positions,
                  const py::object  &by_weights,
                  const Problem     &problem)
    {
      Direction functional{ Vector(problem.body.fe_space.n_dofs()),
                            std::vector<double>(problem.state.weights.size(), 0.) };
      if (!by_positions.is_none())
      {
        // rows for the vertices alone, as problem.positions has them, or for all nodes
        const auto n_all = py::ssize_t(problem.body.fe_space.n_nodes());
        const auto n     = py::ssize_t(problem.body.mesh.n_nodes());
        const auto rows  = points_of(by_positions, method + ": dJ_dx",
                                    has_rows(by_positions, n_all) ? n_all : n);
        for (unsigned int dof = 0; dof < 3 * rows.size(); ++dof)
          functional.positions[dof] = rows[dof / 3][dof % 3];
      }
      if (by_weights.is_none())
        return functional;
      const std::size_t n = functional.weights.size();
      check_weight_derivatives(by_weights, method + ": dJ_dw", n);
      functional.weights = numbers_of(by_weights, method + ": dJ_dw", py::ssize_t(n));
      return functional;
    }

    py::array
    numbers(const std::vector<double> &values)
    {
      return py::array_t<double>(py::ssize_t(values.size()), values.data());
    }

    py::array
    rows(const Vector &values, const std::size_t n)
    {
      return py::array_t<double>({ py::ssize_t(n), py::ssize_t(3) }, values.begin());
    }

    py::array
    rows(const Vector &values)
    {
      return rows(values, values.size() / 3);
    }

    py::dict
    of_obstacles(const std::vector<ObstacleGradients> &found)
    {
      py::dict result;
      for (const ObstacleGradients &obstacle : found)
      {
        py::dict one;
        if (obstacle.displacement)
        {
          const SpaceVector3         &d = *obstacle.displacement;
          const std::array<double, 3> entries{ { d[0], d[1], d[2] } };
          one["displacement"] = py::array_t<double>(3, entries.data());
        }
        if (obstacle.radius)
          one["radius"] = *obstacle.radius;
        if (obstacle.friction)
          one["friction"] = *obstacle.friction;
        result[py::str(obstacle.name)] = one;
      }
      return result;
    }
  } // namespace

  py::dict
  gradients_to_python(const Gradients &found, const std::size_t n_vertices)
  {
    py::dict result;
    if (found.young)
    {
      result["young"]   = numbers(*found.young);
      result["poisson"] = numbers(*found.poisson);
    }
    result["density"] = numbers(found.density);
    if (found.thickness)
      result["thickness"] = numbers(*found.thickness);
    if (found.tension)
      result["fibre_tension"] = numbers(*found.tension);
    if (found.importance)
      result["importance"] = *found.importance;
    py::list poses;
    for (const Vector &pose : found.poses)
      poses.append(rows(pose));
    result["poses"] = poses;
    if (found.rest_positions)
      result["rest_positions"] = rows(*found.rest_positions, n_vertices);
    result["handles"]      = rows(found.handles);
    result["nodal_forces"] = rows(found.nodal_forces);
    result["gravity"]      = py::array_t<double>(3, found.gravity.data());
    if (!found.obstacles.empty())
      result["obstacles"] = of_obstacles(found.obstacles);
    py::list weak;
    for (const unsigned int weight : found.weakly_active)
      weak.append(weight);
    result["weakly_active"] = weak;
    return result;
  }

  py::array
  array_of_nodes(Vector field)
  {
    auto *kept = new Vector(std::move(field));
    return py::array_t<double>(
        { py::ssize_t(kept->size() / 3), py::ssize_t(3) }, kept->begin(),
        py::capsule(kept, [](void *memory) { delete static_cast<Vector *>(memory); }));
  }

  bool
  has_rows(const py::object &array, const py::ssize_t n)
  {
    const auto given = py::array::ensure(array);
    return given && given.ndim() == 2 && given.shape(0) == n;
  }

  void
  check_weight_derivatives(const py::object &array, const std::string &what, const std::size_t n)
  {
    const auto any = py::array::ensure(array);
    if (!any || any.ndim() != 1 || any.shape(0) != py::ssize_t(n))
      throw UserError(fmt::format("{} must be an array of shape ({},), one number for each of "
                                  "problem.weights, but is {}.",
                                  what, n, description(array)));
    numbers_of(array, what, py::ssize_t(n)); // throws if it does not fit
  }

  namespace
  {
    py::dict
    vjp(HeldProblem &held, const py::object &by_positions, const py::object &by_weights)
    {
      const Direction functional = functional_of("vjp", by_positions, by_weights, held.get());
      Gradients       found;
      held.use("vjp()", [&](Problem &problem) { found = gradients(problem, functional); });
      return gradients_to_python(found, held.get().body.mesh.n_nodes());
    }

    double
    find_correction(HeldProblem &held, const py::object &by_positions, const py::object &by_weights)
    {
      const Direction functional
          = functional_of("correction", by_positions, by_weights, held.get());
      double found = 0.;
      held.use("correction()", [&](Problem &problem) { found = correction(problem, functional); });
      return found;
    }
  } // namespace

  void
  add_gradients(ProblemClass &problem)
  {
    problem.def(
        "vjp", &vjp, py::arg("dJ_dx"), py::arg("dJ_dw") = py::none(),
        "vjp(dJ_dx, dJ_dw=None) -> dict[str, Any]\n\n"
        "Gradients of a function J(positions, weights) of the static equilibrium that was just "
        "found,\n"
        "from its derivatives dJ_dx (n, 3) and dJ_dw (k,) there; None: zero. For any number of\n"
        "parameters it takes one linear system. The dictionary has, as arrays of their own,\n"
        "  young, poisson, density (m,), by cell\n"
        "  thickness (m,)          by cell, of shells\n"
        "  fibre_tension (m,)      by cell, 0 where no fibres are active; with active fibres\n"
        "  importance              a float; with examples\n"
        "  poses                   a list of (n, 3), of all examples but the rest pose\n"
        "  rest_positions (n, 3)   with handles, poses and nodal forces where they are; it is not\n"
        "                          there with Region blend length\n"
        "  handles (n, 3)          by the positions of held nodes; zero on free ones\n"
        "  nodal_forces (n, 3), gravity (3,)\n"
        "  obstacles               a dictionary by names, of dictionaries with displacement (3,), "
        "radius\n"
        "                          and friction; beside obstacles\n"
        "  weakly_active           a list of weights that are about to reach or to leave their\n"
        "                          bound: there gradients are one-sided\n"
        "With quadratic elements rows of poses, handles and nodal_forces are those of gradient(), "
        "with\n"
        "the middles of edges; rest_positions has a row for each vertex, and dJ_dx one for each "
        "vertex\n"
        "or for each node. young and poisson are not there where some cell is orthotropic.\n"
        "Raises UserError for scenes whose gradients are not known (doc/gradients.md), and where "
        "the\n"
        "problem is not in equilibrium or a cell has no unique rotation;\n"
        "SolverFailure if the tangent there is not positive definite.");
    refuse_other_arguments(problem, "vjp", "vjp is called as vjp(dJ_dx, dJ_dw=None).");
    problem.def(
        "correction", &find_correction, py::arg("dJ_dx"), py::arg("dJ_dw") = py::none(),
        "correction(dJ_dx, dJ_dw=None) -> float\n\n"
        "What a function J(positions, weights) of the exact equilibrium is more than at the\n"
        "present state, to first order, from its derivatives dJ_dx (n, 3) and dJ_dw (k,) here;\n"
        "None: zero. The state may be a loosely solved one, or any other with the held nodes at\n"
        "their places: J + correction is mostly much nearer to the truth than J, and the\n"
        "correction says how far that was. It takes one linear system, as vjp().\n"
        "Raises UserError for scenes whose gradients are not known (doc/gradients.md) and where\n"
        "a cell has no unique rotation; SolverFailure if the tangent is not positive\n"
        "definite.");
    refuse_other_arguments(problem, "correction",
                           "correction is called as correction(dJ_dx, dJ_dw=None).");
  }
} // namespace Exemplar::Python
