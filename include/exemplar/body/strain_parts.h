// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_strain_parts_h
#define exemplar_strain_parts_h

#include <exemplar/body/material.h>

// Parts of a strain, to which examples may be restricted.

namespace Exemplar
{
  /// The part of a strain that a pressure causes; the rest is isochoric, and the two are orthogonal
  /// in energy.
  Matrix3<double>
  part_of_pressure(const Material &material, unsigned int cell, const Matrix3<double> &strain);

  /// The part of a strain that a tension along the fibres causes; the rest has no stretch along
  /// them. 0 without fibres.
  Matrix3<double>
  part_of_tension(const Material &material, unsigned int cell, const Matrix3<double> &strain);
} // namespace Exemplar

#endif
