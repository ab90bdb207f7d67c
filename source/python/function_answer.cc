// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/python/arrays_from_python.h>
#include <exemplar/python/from_python.h>
#include <exemplar/python/function_answer.h>

#include <fmt/core.h>

#include <cmath>
#include <utility>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    const char *const usage
        = "add_term calls function(positions, time), which returns energy, gradient, hessian.";

    double
    energy_of(const py::object &object, const std::string &what)
    {
      try
      {
        if (const double energy = real_number_of(object, what); std::isfinite(energy))
          return energy;
      }
      catch (const py::type_error &) // reported below
      {
      }
      throw UserError(what + ": the energy must be a finite number [J], but is "
                      + std::string(py::repr(object)) + ".");
    }
  } // namespace

  FunctionAnswer
  answer_of(const py::object  &function,
            const std::string &term_name,
            const Vector      &positions,
            const double       time)
  {
    const py::gil_scoped_acquire lock;
    const auto                   n = static_cast<py::ssize_t>(positions.size() / 3);
    const std::string            what
        = term_name + ": what the function returns at t = " + shortest_text(time);
    const py::array_t<double> points({ n, py::ssize_t(3) }, positions.begin());
    const py::object          parts = call(function, py::make_tuple(points, time), usage);
    if (!py::isinstance<py::tuple>(parts) || py::len(parts) != 3)
      throw UserError(what + " must be energy, gradient, hessian, but is " + description(parts)
                      + ".");
    const py::tuple three(parts);
    FunctionAnswer  answer{
      positions, time, energy_of(three[0], what), Vector(positions.size()), {}
    };
    const auto gradient = points_of(three[1], what + ": the gradient", n);
    for (unsigned int dof = 0; dof < positions.size(); ++dof)
      answer.gradient[dof] = gradient[dof / 3][dof % 3];
    answer.hessian = lower_entries_of(three[2], positions.size(), what + ": the Hessian");
    return answer;
  }
} // namespace Exemplar::Python
