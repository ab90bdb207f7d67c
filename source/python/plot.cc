// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/python/module_parts.h>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    py::object
    plot(const py::object &self,
         const py::object &values,
         const py::object &axes,
         const py::object &label)
    {
      return py::module_::import("exemplar._plot").attr("plot")(self, values, axes, label);
    }

    /// Positions of the nodes now and after each step that is left.
    py::list
    positions_of_steps(const py::object &self)
    {
      py::list positions;
      positions.append(self.attr("positions"));
      self.cast<HeldProblem &>().run([&] { positions.append(self.attr("positions")); });
      return positions;
    }

    py::object
    animate(const py::object &self,
            const py::object &positions,
            const py::object &interval,
            const py::object &axes)
    {
      const py::object function = py::module_::import("exemplar._plot").attr("animate");
      return function(self, positions.is_none() ? positions_of_steps(self) : positions, interval,
                      axes);
    }
  } // namespace

  void
  add_plot(ProblemClass &problem)
  {
    problem.def(
        "plot", &plot, py::arg("values") = py::none(), py::arg("axes") = py::none(),
        py::arg("label") = py::none(),
        "plot(values=None, axes=None, label=None) -> mpl_toolkits.mplot3d.axes3d.Axes3D\n\n"
        "Draw the body's surface where it stands, by matplotlib, and return the axes.\n\n"
        "values: one number a node (n,) or a cell (m,) that colours it, from the least to the\n"
        "greatest; None: the displacements' lengths [m]. axes: of matplotlib, with "
        "projection='3d';\n"
        "None: those of a new figure. label: of the colour bar, with the unit, such as\n"
        "\"stress [Pa]\"; None: that of the displacements, or none. Raises UserError for values of "
        "another shape, numbers that\n"
        "are not finite, or axes that are flat, ImportError without matplotlib, and RuntimeError\n"
        "while another thread makes a step.");
    problem.def(
        "animate", &animate, py::arg("positions") = py::none(), py::arg("interval") = 50,
        py::arg("axes") = py::none(),
        "animate(positions=None, interval=50, axes=None) -> matplotlib.animation.FuncAnimation\n\n"
        "The moving surface, by matplotlib: a notebook shows it as a player, if it is the last\n"
        "line of a cell; save(\"body.gif\") writes it.\n\n"
        "positions: a list of arrays (n, 3) [m] of the mesh's nodes, one a frame, such as\n"
        "trajectory.positions; None: the steps that are left are made, as by run(), and shown.\n"
        "interval: between frames [ms]. axes: as of plot(). The colours are the displacements'\n"
        "lengths [m]. Keep what it returns as long as it is shown. Raises what plot() and run()\n"
        "raise, and UserError for other shapes and for less than two frames.");
    refuse_other_arguments(problem, "plot",
                           "plot is called as plot(values=None, axes=None, label=None).");
    refuse_other_arguments(problem, "animate",
                           "animate is called as animate(positions=None, interval=50, axes=None).");
  }
} // namespace Exemplar::Python
