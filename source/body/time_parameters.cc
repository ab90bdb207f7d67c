// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/time_parameters.h>
#include <exemplar/prm/key_table.h>

namespace Exemplar
{
  namespace
  {
    const EnumTable<TimeScheme> schemes
        = { { TimeScheme::implicit_euler, "implicit euler" }, { TimeScheme::bdf2, "bdf2" } };
  } // namespace

  void
  TimeParameters::declare(KeyTable &keys)
  {
    const Bounds positive = Bounds::positive();
    keys.enter_subsection("Time");
    keys.add("Scheme", scheme, schemes,
             "Time stepping of a dynamic scene. implicit euler: of first order, never gains energy "
             "from its steps; bdf2: of second order, for motion that is to be accurate.");
    keys.add("Step", step, "The time step dt [s] of a dynamic scene, h on the pages.", positive);
    keys.add("End", end,
             "Time [s] at which a dynamic scene ends. If it is no whole number of steps, "
             "the last step is shorter.",
             positive);
    keys.add("Mass damping", mass_damping,
             "Force of -M v times this [1/s] in a dynamic scene; slows rigid motion, too.",
             Bounds{ 0. });
    keys.add("Stiffness damping", stiffness_damping,
             "Stress of C : (rate of the strain) times this [s] in a dynamic scene; leaves "
             "rigid motion alone unless Model/Strain is linear.",
             Bounds{ 0. });
    keys.add("Increments", increments,
             "Number of increments in which a static scene or an interpolation goes from "
             "t = 0 to t = 1.",
             Bounds{ 1 });
    keys.leave_subsection();
  }
} // namespace Exemplar
