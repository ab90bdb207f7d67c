// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/strain_damping.h>

namespace Exemplar
{
  void
  StrainDamping::set(const double                          new_s,
                     const std::vector<WeightedPositions> &history,
                     const CellBatches                    &cells,
                     const FESpace                        &fe_space)
  {
    s = new_s;
    factors.resize_fast(0);
    strains.resize_fast(0);
    if (s == 0.)
      return;
    factors.resize(batched_size(fe_space.n_points(), 1), s);
    strains.resize(batched_size(fe_space.n_points(), 6), 0.);
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
      for (const WeightedPositions &past : history)
      {
        const CellLaw         law = cells.law(point);
        const Matrix3<double> F   = fe_space.deformation_gradient(point, *past.positions);
        const Matrix3<double> R   = model_rotation(law, F);
        add_to_stored(strains.data(), point, 1, 0, past.weight, model_strain(law, R, F));
        LawValue<double> value;
        law_functions<double>(law).evaluate(cells.law_input(point, R, F), false, value);
        if (value.is_guarded)
          factors[point] = 0.;
      }
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
