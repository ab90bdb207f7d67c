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
        const Matrix3<double> F       = fe_space.deformation_gradient(cell, *past.positions);
        const Matrix3<double> R       = model_rotation(measure, F);
        const Matrix3<double> e       = model_strain(measure, R, F);
        const double          part[6] = { e[0][0], e[1][1], e[2][2], e[1][2], e[0][2], e[0][1] };
        for (unsigned int k = 0; k < 6; ++k)
          strains[batch_index(cell, 6, k)] += past.weight * part[k];
        if (measure == StrainMeasure::corotational
            && CorotationalCell<double>(material.lame(cell), R, F, cells.get_guard_bound())
                   .is_guarded())
          factors[cell] = 0.;
      }
  }

  Lame<double>
  StrainDamping::damped(const unsigned int cell, const Lame<double> &lame) const
  {
    return { (1. + factor(cell)) * lame.lambda, (1. + factor(cell)) * lame.mu };
  }

  Matrix3<double>
  StrainDamping::damped(const unsigned int cell, const Matrix3<double> &D) const
  {
    const double s_cell = factor(cell);
    if (s_cell == 0.)
      return D;
    double E[6];
    for (unsigned int k = 0; k < 6; ++k)
      E[k] = strains[batch_index(cell, 6, k)];
    const Matrix3<double> past
        = { { { E[0], E[5], E[4] }, { E[5], E[1], E[3] }, { E[4], E[3], E[2] } } };
    return combine(1. / (1. + s_cell), D, s_cell / (1. + s_cell), past);
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
