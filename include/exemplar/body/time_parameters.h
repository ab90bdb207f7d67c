// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_time_parameters_h
#define exemplar_time_parameters_h

namespace Exemplar
{
  class KeyTable;

  /// The time stepping: Eq. (12) or Eq. (21).
  enum class TimeScheme
  {
    implicit_euler,
    bdf2
  };

  /// Subsection Time.
  struct TimeParameters
  {
    TimeScheme   scheme            = TimeScheme::implicit_euler;
    double       step              = 0.01; ///< h [s]
    double       end               = 1.;   ///< [s]
    double       mass_damping      = 0.;   ///< [1/s]
    double       stiffness_damping = 0.;   ///< [s]
    unsigned int increments        = 10;   ///< number of increments of statics and interpolation

    void
    declare(KeyTable &keys);
  };
} // namespace Exemplar

#endif
