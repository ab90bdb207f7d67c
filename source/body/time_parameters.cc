// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/time_parameters.h>
#include <exemplar/prm/prm_tools.h>

namespace Exemplar
{
  namespace
  {
    const EnumTable<TimeScheme> schemes
        = { { TimeScheme::implicit_euler, "implicit euler" }, { TimeScheme::bdf2, "bdf2" } };
  } // namespace

  void
  TimeParameters::declare(dealii::ParameterHandler &prm)
  {
    const dealii::Patterns::Double positive(1e-300);
    prm.enter_subsection("Time");
    declare_enum(
        prm, "Scheme", scheme, schemes,
        "Time stepping of a dynamic scene. implicit euler: of first order, never gains energy "
        "from its steps; bdf2: of second order, for motion that is to be accurate.");
    prm.add_parameter("Step", step, "Time step h [s] of a dynamic scene.", positive);
    prm.add_parameter("End", end,
                      "Time [s] at which a dynamic scene ends. If it is no whole number of steps, "
                      "the last step is shorter.",
                      positive);
    prm.add_parameter("Mass damping", mass_damping,
                      "Force of -M v times this [1/s] in a dynamic scene; slows rigid motion, too.",
                      dealii::Patterns::Double(0.));
    prm.add_parameter(
        "Stiffness damping", stiffness_damping,
        "Stress of C : (rate of the strain) times this [s] in a dynamic scene; leaves "
        "rigid motion alone unless Model/Strain is linear.",
        dealii::Patterns::Double(0.));
    prm.add_parameter("Increments", increments,
                      "Number of increments in which a static scene or an interpolation goes from "
                      "t = 0 to t = 1.",
                      dealii::Patterns::Integer(1));
    prm.leave_subsection();
  }
} // namespace Exemplar
