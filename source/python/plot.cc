// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/python/plot.h>

namespace Exemplar::Python
{
  namespace py = pybind11;

  void
  add_plot(const py::object &problem)
  {
    const auto plot = [](const py::object &self, const py::object &values, const py::object &axes)
    { return py::module_::import("exemplar._plot").attr("plot")(self, values, axes); };
    py::options options;
    options.disable_function_signatures();
    problem.attr("plot") = py::cpp_function(
        plot, py::name("plot"), py::is_method(problem), py::arg("values") = py::none(),
        py::arg("axes") = py::none(),
        "plot(values=None, axes=None) -> Any\n\n"
        "Draw the body's surface where it stands, by matplotlib, and return the axes.\n\n"
        "values: one number a node (n,) or a cell (m,) that colours it, from the least to the\n"
        "greatest; None: the displacements' lengths [m]. axes: of matplotlib, with "
        "projection='3d';\n"
        "None: those of a new figure. Raises UserError for values of another shape, numbers that\n"
        "are not finite, or axes that are flat, ImportError without matplotlib, and RuntimeError\n"
        "while another thread makes a step.");
  }
} // namespace Exemplar::Python
