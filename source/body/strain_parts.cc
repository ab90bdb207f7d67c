// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/strain_parts.h>

namespace Exemplar
{
  namespace
  {
    /// factor times the strain with these normal components in the given axes and no shear; 0
    /// without axes.
    Matrix3<double>
    strain_in(const GrainAxes &axes, const std::array<double, 3> &entries, const double factor)
    {
      const auto           &a = axes.along, &b = axes.across;
      const Vector3<double> c
          = { { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] } };
      Matrix3<double> strain = {};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          strain[i][j]
              = factor
                * (entries[0] * a[i] * a[j] + entries[1] * b[i] * b[j] + entries[2] * c[i] * c[j]);
      return strain;
    }
  } // namespace

  Matrix3<double>
  part_of_pressure(const Material &material, const unsigned int cell, const Matrix3<double> &strain)
  {
    const GrainAxes axes = material.grain_axes(cell);
    if (material.has_elasticity_of_examples() || axes.along == GrainAxes().along)
      return combine(trace(strain) / 3., identity_matrix<double>(), 0., strain);
    return strain_in(axes, material.grain(cell).strain_of_pressure(), trace(strain));
  }

  Matrix3<double>
  part_of_tension(const Material &material, const unsigned int cell, const Matrix3<double> &strain)
  {
    const GrainAxes axes = material.grain_axes(cell);
    if (axes.along == GrainAxes().along)
      return {};
    const auto &a       = axes.along;
    double      stretch = 0.;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        stretch += a[i] * strain[i][j] * a[j];
    const Orthotropy grain = material.has_elasticity_of_examples()
                                 ? material.blend(cell).of_examples()
                                 : material.grain(cell);
    return strain_in(axes, grain.strain_of_tension(), stretch);
  }
} // namespace Exemplar
