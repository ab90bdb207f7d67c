// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/python/arrays_from_python.h>
#include <exemplar/python/from_python.h>
#include <exemplar/python/held_problem.h>
#include <exemplar/run/problem/motion_review.h>

#include <algorithm>
#include <utility>

// The functions of Python that move handles and look at iterations.

namespace Exemplar::Python
{
  namespace py = pybind11;

  void
  HeldProblem::set_motion(const py::object &name, const py::object &function)
  {
    if (!py::isinstance<py::str>(name))
      throw py::type_error("set_motion(name, function): the name of a handle must be a str, but is "
                           + description(name) + ".");
    if (PyCallable_Check(function.ptr()) == 0)
      throw py::type_error("set_motion(name, function): function is called as function(rest, t), "
                           "but is "
                           + description(function)
                           + ". Displacements that do not change: lambda rest, t: displacements.");
    const std::string handle = text_of(name, "set_motion: the name of the handle");
    require_no_step("set_motion()");
    py::object &kept
        = functions.motions[handle]; // null if there is no such handle, which the next line says
    problem->set_motion(handle, motion_of(handle, kept));
    kept                 = function;
    is_warned_of_motions = false;
  }

  void
  HeldProblem::on_iteration(const py::object &function)
  {
    if (!function.is_none() && !PyCallable_Check(function.ptr()))
      throw py::type_error("on_iteration needs a function or None.");
    functions.callback = function;
  }

  void
  HeldProblem::warn_of_motions()
  {
    if (functions.motions.empty() || is_warned_of_motions)
      return;
    std::vector<std::string> found = next_step_warnings(*problem);
    is_warned_of_motions           = !found.empty();
    found.erase(std::remove_if(found.begin(), found.end(), // known ones, of formulas
                               [this](const std::string &warning) {
                                 return std::count(warnings.begin(), warnings.end(), warning) > 0;
                               }),
                found.end());
    warn(found);
  }
} // namespace Exemplar::Python
