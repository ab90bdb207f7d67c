// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/load_parameters.h>

#include <deal.II/base/parameter_handler.h>

namespace Exemplar
{
  void
  LoadParameters::declare(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection(name);
    select.declare(prm, "Where the force acts");
    prm.add_parameter("Force", force,
                      "Total dead force [N], three functions of t [s]; shared by area over a "
                      "boundary, by mass over other selections.");
    prm.leave_subsection();
  }
} // namespace Exemplar
