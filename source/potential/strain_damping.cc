// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/strain_damping.h>

namespace Exemplar
{
  void
  StrainDamping::set(const double                          new_s,
                     const std::vector<WeightedPositions> &history,
                     const CellField                      &cells,
                     const FESpace                        &fe_space,
                     const Material                       &material)
  {
    s = new_s;
    factors.resize_fast(0);
    strains.resize_fast(0);
    if (s == 0.)
      return;
    const StrainMeasure measure = cells.strain_measure();
    factors.resize(batched_size(fe_space.n_cells(), 1), s);
    strains.resize(batched_size(fe_space.n_cells(), 6), 0.);
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      for (const WeightedPositions &past : history)
      {
        const Matrix3<double> F = fe_space.deformation_gradient(cell, *past.positions);
        const Matrix3<double> R = model_rotation(measure, F);
        add_to_stored(strains.data(), cell, 1, 0, past.weight, model_strain(measure, R, F));
        if (model_is_guarded(measure, material.elasticity(cell), R, F, cells.get_guard_bound()))
          factors[cell] = 0.;
      }
  }

  Matrix3<double>
  StrainDamping::damped(const unsigned int cell, const Matrix3<double> &D) const
  {
    const double s_cell = factor(cell);
    if (s_cell == 0.)
      return D;
    return combine(1. / (1. + s_cell), D, s_cell / (1. + s_cell), past_strain(cell));
  }

  DampingArrays
  StrainDamping::arrays() const
  {
    if (!(s > 0.))
      return {};
    return { factors.data(), strains.data() };
  }

  DampingArrays
  StrainDamping::arrays_of_all_cells()
  {
    DampingArrays all = arrays();
    if (s > 0.)
    {
      whole_factors.resize_fast(factors.size());
      whole_factors.fill(s);
      all.factors = whole_factors.data();
    }
    return all;
  }
} // namespace Exemplar
