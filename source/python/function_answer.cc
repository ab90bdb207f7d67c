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

    /// Throws UserError unless H x = H^T x for some x.
    void
    require_symmetry(const std::vector<MatrixEntry> &entries,
                     const std::size_t               n,
                     const std::string              &what)
    {
      std::vector<double> x(n), Hx(n, 0.), HTx(n, 0.), scale(n, 0.);
      for (std::size_t i = 0; i < n; ++i)
        x[i] = 1.5 + std::sin(static_cast<double>(i)); // of no particular direction
      for (const MatrixEntry &entry : entries)
      {
        Hx[entry.row] += entry.value * x[entry.column];
        HTx[entry.column] += entry.value * x[entry.row];
        scale[entry.row] += std::abs(entry.value * x[entry.column]);
      }
      const double size = n == 0 ? 0. : *std::max_element(scale.begin(), scale.end());
      for (std::size_t i = 0; i < n; ++i)
        if (!(std::abs(Hx[i] - HTx[i]) <= 1e-8 * size))
          throw UserError(fmt::format("{}: the Hessian is not symmetric, or not finite, in row {} "
                                      "(of node {}). Return all of it, both triangles.",
                                      what, i, i / 3));
    }

    /// What Python's arrays of numbers are; throws UserError for anything else.
    template <typename Number>
    py::array_t<Number>
    numbers_in(const py::object &array, const std::string &what)
    {
      auto numbers = py::array_t<Number, py::array::c_style | py::array::forcecast>::ensure(array);
      if (!numbers)
      {
        PyErr_Clear();
        throw UserError(what + ": the Hessian's entries are no numbers.");
      }
      return std::move(numbers);
    }

    std::vector<MatrixEntry>
    entries_of(const py::object &hessian, const std::size_t n, const std::string &what)
    {
      if (hessian.is_none())
        return {};
      if (!py::hasattr(hessian, "tocoo"))
        throw UserError(fmt::format("{}: the Hessian must be a sparse array of scipy of shape "
                                    "({}, {}), or None, but is {}. Of a dense one take "
                                    "scipy.sparse.csr_array(H).",
                                    what, n, n, description(hessian)));
      const py::object coo   = hessian.attr("tocoo")();
      const py::tuple  shape = coo.attr("shape");
      if (py::cast<std::size_t>(shape[0]) != n || py::cast<std::size_t>(shape[1]) != n)
        throw UserError(fmt::format("{}: the Hessian has the shape {}, but must have ({}, {}): "
                                    "three rows a node.",
                                    what, std::string(py::str(py::object(shape))), n, n));
      const auto               rows    = numbers_in<long long>(coo.attr("row"), what);
      const auto               columns = numbers_in<long long>(coo.attr("col"), what);
      const auto               values  = numbers_in<double>(coo.attr("data"), what);
      std::vector<MatrixEntry> all, lower;
      for (py::ssize_t i = 0; i < values.size(); ++i)
        all.push_back({ static_cast<unsigned int>(rows.at(i)),
                        static_cast<unsigned int>(columns.at(i)), values.at(i) });
      require_symmetry(all, n, what);
      std::copy_if(all.begin(), all.end(), std::back_inserter(lower),
                   [](const MatrixEntry &entry) { return entry.row >= entry.column; });
      return lower;
    }

    double
    energy_of(const py::object &object, const std::string &what)
    {
      const double energy = PyFloat_AsDouble(object.ptr());
      const bool   is_one = PyErr_Occurred() == nullptr && std::isfinite(energy);
      PyErr_Clear();
      if (!is_one)
        throw UserError(what + ": the energy must be a finite number [J], but is "
                        + std::string(py::repr(object)) + ".");
      return energy;
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
    answer.hessian = entries_of(three[2], positions.size(), what);
    return answer;
  }
} // namespace Exemplar::Python
