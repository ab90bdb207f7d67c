// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_strain_damping_h
#define exemplar_strain_damping_h

#include <exemplar/body/cell_batches.h>
#include <exemplar/body/fe_space.h>
#include <exemplar/body/time_integrator.h>
#include <exemplar/kernels/cell_kernels.h>
#include <exemplar/kernels/symmetric.h>

#include <deal.II/base/aligned_vector.h>

namespace Exemplar
{
  /// Stiffness damping, Eq. (22): the stress s C:(e - sum_m c_m e(x_m)), with s = b_K gamma [-] the damping
  /// time over the time step. It and the elastic energy are two quadratics around a strain in each
  /// cell, hence one: with C times 1 + s around (D + s e*) / (1 + s).
  class StrainDamping
  {
  public:
    /// From now on with this s, 0 for none, in these cells. Points that the guard of Eq. (16) had to hold at one of the positions x_m are left out: their rotation is
    /// ambiguous.
    void
    set(double                                s,
        const std::vector<WeightedPositions> &history,
        const CellBatches                    &cells,
        const FESpace                        &fe_space);

    /// s.
    double
    factor() const
    {
      return s;
    }

    /// s at a point: 0 where it is left out.
    double
    factor(const unsigned int point) const
    {
      return factors.empty() ? 0. : factors[point];
    }

    /// sum_m c_m e(x_m) at a point; with damping alone.
    Matrix3<double>
    past_strain(const unsigned int point) const
    {
      return load_stored(strains.data(), point, 1, 0);
    }

    /// Factors and past strains for the loops; null without damping.
    DampingArrays
    arrays() const;

    /// arrays() with no cell left out of the damping, as convex tangents have it: they stay convex, and a resumed run
    /// does not know which cells were left out when a factor was made. Lives until the next call.
    DampingArrays
    arrays_of_all_cells();

    /// In bytes.
    std::size_t
    memory_consumption() const
    {
      return factors.memory_consumption() + strains.memory_consumption();
    }

  private:
    double                        s = 0.;
    dealii::AlignedVector<double> factors; ///< in batches; empty without damping
    dealii::AlignedVector<double> strains; ///< sum_m c_m e(x_m), in batches
    dealii::AlignedVector<double> whole_factors;
  };
} // namespace Exemplar

#endif
