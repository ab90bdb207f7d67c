// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_patch_potential_h
#define exemplar_patch_potential_h

#include <exemplar/kernels/patch_cell.h>

#include <array>

// The potential of a patch, Eqs. (25), (26) and (37), as one function of sums over its points.

namespace Exemplar
{
  /// Integrands whose integrals over a patch, by its points and their volumes, its potential
  /// depends on.
  enum class PatchSum
  {
    volume,        ///< 1
    lambda,        ///< the part of the elasticity that patches take [Pa]
    trace,         ///< tr e, continued smoothly in thin cells
    wish,          ///< tr D
    square,        ///< |F|^2
    trace_square,  ///< the square of the trace
    guard,         ///< Gamma of Eq. (24) [Pa]
    volume_change, ///< det F - 1
    importance,    ///< eta
    excess,        ///< lambda of C_y, Eq. (38) [Pa]
    bound          ///< |F|^2 of the example that sets the bound of the guard (26)
  };

  /// The sums of a patch, one for each PatchSum.
  template <typename Number>
  struct PatchSums
  {
    static constexpr std::size_t size = 11;

    std::array<Number, size> numbers = {};

    Number &
    operator[](const PatchSum sum)
    {
      return numbers[static_cast<std::size_t>(sum)];
    }

    const Number &
    operator[](const PatchSum sum) const
    {
      return numbers[static_cast<std::size_t>(sum)];
    }
  };

  /// Settings that all patches of a law share.
  struct PatchScene
  {
    double blended_part;          ///< share of the blended energy
    bool   has_guard;             ///< whether Eq. (26) acts
    bool   has_volumetric_energy; ///< whether Eq. (37) acts
    bool   has_own_examples;
  };

  /// beta(m) of Eq. (26).
  template <typename Number>
  Number
  transition_of_guard(const Number &m, const Number &bound)
  {
    const Number z = (m - bound) / (Number(0.3) * bound);
    if (!(z < Number(1.)))
      return Number(1.);
    return z * z * z * (Number(10.) - Number(15.) * z + Number(6.) * z * z);
  }

  /// Potential of a patch [J]; `importance` is eta of all cells.
  template <typename Number>
  Number
  patch_potential(const PatchScene &scene, const PatchSums<Number> &of, const Number &importance)
  {
    const Number V = of[PatchSum::volume], lambda = of[PatchSum::lambda] / V;
    const Number theta = of[PatchSum::trace] / V, D = of[PatchSum::wish] / V;
    const Number half = Number(0.5) * lambda * V, of_trace = half * theta * theta;
    const Number eta   = of[PatchSum::importance] / V;
    const Number share = scene.has_volumetric_energy ? importance : Number(1.);
    Number       sum   = half * (theta - D) * (theta - D);
    if (scene.has_volumetric_energy)
    {
      const Number change = of[PatchSum::volume_change] / V;
      sum += (Number(1.) - share) * (half * change * change - of_trace);
    }
    if (scene.has_own_examples)
      sum += Number(0.5 * scene.blended_part) * of[PatchSum::excess] * D * D;
    else if (eta > Number(0.))
      sum += Number(scene.blended_part) * (Number(1.) - eta) / eta * half * D * D;
    const Number m     = of[PatchSum::square] / V;
    const Number bound = max(Number(min_stretched_square), Number(1.2) * of[PatchSum::bound] / V);
    if (scene.has_guard && m > bound && share * lambda > Number(0.))
      sum += transition_of_guard(m, bound)
             * (share * (Number(0.5) * lambda * of[PatchSum::trace_square] - of_trace)
                + of[PatchSum::guard]);
    return sum;
  }
} // namespace Exemplar

#endif
