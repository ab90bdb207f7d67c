// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/python/step_log.h>

#include <fmt/core.h>
#include <pybind11/pybind11.h>

namespace Exemplar::Python
{
  namespace py = pybind11;

  void
  log_step(const Problem &problem, const SolveReport &report)
  {
    const py::dict modules = py::module_::import("sys").attr("modules");
    if (!modules.contains("logging")) // nobody listens
      return;
    const py::object logging = modules["logging"];
    const py::object logger  = logging.attr("getLogger")("exemplar");
    if (logger.attr("isEnabledFor")(logging.attr("INFO")).cast<bool>())
      logger.attr("info")(fmt::format("step {} of {}, t = {:g}: {}, {} iterations, residual {:.2g}",
                                      problem.state.step, problem.time_axis.n_steps(),
                                      problem.state.time, status_name(report.status),
                                      report.iterations, report.residual));
  }
} // namespace Exemplar::Python
