// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/load_parameters.h>
#include <exemplar/prm/key_table.h>

namespace Exemplar
{
  void
  LoadParameters::declare(KeyTable &keys)
  {
    keys.enter_subsection(name);
    select.declare(keys, "Where the force acts");
    keys.add("Force", force,
             "Total dead force [N], three functions of t [s]; shared by area over a "
             "boundary and over the faces between nodes selected by the surface, by mass over "
             "others.");
    keys.leave_subsection();
  }
} // namespace Exemplar
