// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/load_parameters.h>
#include <exemplar/prm/key_table.h>

namespace Exemplar
{
  namespace
  {
    const EnumTable<LoadRamp> ramps
        = { { LoadRamp::none, "none" }, { LoadRamp::increments, "increments" } };
  } // namespace

  void
  LoadsParameters::declare(KeyTable &keys)
  {
    keys.add("Gravity", gravity, "Acceleration of gravity [m/s^2].");
    keys.add("Balanced", balanced,
             "Whether the body stands under its loads in its rest pose, as a character that is "
             "drawn as it stands: "
             "its cells carry from the beginning the stresses that bear the loads of t = 0. "
             "Handles must hold it.");
    keys.add("Ramp", ramp, ramps,
             "none: gravity acts in full from the start, and forces are what their formulas say. "
             "increments, in static scenes: both are multiplied by t, which goes from 0 to 1 in "
             "Time/Increments.");
  }

  void
  LoadParameters::declare(KeyTable &keys)
  {
    keys.enter_subsection(name);
    select.declare(keys, "Where the force acts");
    keys.add("Force", force,
             "Total dead force [N], three functions of t [s]; shared by area over a "
             "boundary and over the faces between nodes selected by the surface, by mass over "
             "others.",
             "; ");
    keys.leave_subsection();
  }
} // namespace Exemplar
