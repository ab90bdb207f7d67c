// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_load_parameters_h
#define exemplar_load_parameters_h

#include <exemplar/mesh/selection.h>

#include <array>
#include <string>
#include <vector>

namespace Exemplar
{
  class KeyTable;

  /// Parameters of a subsection of Loads.
  struct LoadParameters
  {
    std::string name;
    Selection   select;
    std::string force = "0; 0; 0";

    void
    declare(KeyTable &keys);
  };

  /// Values of Loads/Ramp: how loads are applied over time.
  enum class LoadRamp
  {
    none,
    increments
  };

  /// Section Loads.
  struct LoadsParameters
  {
    LoadRamp                    ramp = LoadRamp::none;
    std::array<double, 3>       gravity{}; ///< acceleration [m/s^2]
    bool                        balanced = false;
    std::vector<LoadParameters> named;

    void
    declare(KeyTable &keys);

    bool
    has_gravity() const
    {
      return gravity != std::array<double, 3>{};
    }

    bool
    empty() const
    {
      return named.empty() && !has_gravity();
    }
  };
} // namespace Exemplar

#endif
