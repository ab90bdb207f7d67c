// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_patch_factors_h
#define exemplar_patch_factors_h

#include <exemplar/kernels/patch_cell.h>
#include <exemplar/potential/patch_energy.h>

#include <array>

// The potential of a patch, Eqs. (25), (26) and (37), and its derivatives by all that it depends on.

namespace Exemplar
{
  /// Integrands over a patch, by its points and their volumes, on whose integrals its potential
  /// depends.
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

  /// A number for each PatchSum.
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

  /// The integrands of the mean dilatation, where `wish` is the trace of the target.
  template <typename Number>
  PatchSums<Number>
  dilatation_sums(const Number &lambda, const Number &trace, const Number &wish)
  {
    PatchSums<Number> sums;
    sums[PatchSum::volume] = Number(1.);
    sums[PatchSum::lambda] = lambda;
    sums[PatchSum::trace]  = trace;
    sums[PatchSum::wish]   = wish;
    return sums;
  }

  /// Settings that all patches of a law share.
  struct PatchScene
  {
    double blended_part;          ///< share of the blended energy
    bool   has_guard;             ///< whether Eq. (26) acts
    bool   has_volumetric_energy; ///< whether Eq. (37) acts
    bool   has_own_examples;
  };

  /// The potential of a patch.
  template <typename Number>
  struct PatchPotential
  {
    Number            energy;        ///< [J]
    PatchSums<Number> by_sums;       ///< derivatives by the sums
    Number            by_importance; ///< derivative by eta of all cells, at fixed sums [J]
  };

  /// The potential of a patch per volume, with its derivatives by the means, which are those of the
  /// potential by the sums.
  template <typename Number>
  class PatchDensity
  {
  public:
    /// `importance` is eta of all cells.
    PatchDensity(const PatchScene &scene, const PatchSums<Number> &means, const Number &importance)
        : scene(scene), of(means), lambda(of[PatchSum::lambda]), theta(of[PatchSum::trace]),
          D(of[PatchSum::wish]), share(scene.has_volumetric_energy ? importance : Number(1.))
    {
      add_means();
      add_weights();
      if (scene.has_guard)
        add_guard();
      // the potential is homogeneous in the sums
      Number rest = density;
      for (std::size_t k = 0; k < PatchSums<Number>::size; ++k)
        rest -= by.numbers[k] * of.numbers[k];
      by[PatchSum::volume] = rest;
    }

    PatchPotential<Number>
    times_volume(const Number &V) const
    {
      return { V * density, by, scene.has_volumetric_energy ? V * by_share : Number(0.) };
    }

  private:
    void
    add_means()
    {
      const Number one(1.), zero(0.);
      density += energy_of_mean(lambda, theta, D);
      by[PatchSum::lambda] += energy_of_mean(one, theta, D);
      by[PatchSum::trace] += pressure_of_mean(lambda, share, theta, D);
      by[PatchSum::wish] -= pressure_of_mean(lambda, one, theta, D);
      if (!scene.has_volumetric_energy)
        return;
      const Number &change = of[PatchSum::volume_change];
      const Number  excess = energy_of_mean(one, change, zero) - energy_of_mean(one, theta, zero);
      density += (one - share) * lambda * excess;
      by_share -= lambda * excess;
      by[PatchSum::lambda] += (one - share) * excess;
      by[PatchSum::volume_change] += (one - share) * pressure_of_mean(lambda, one, change, zero);
    }

    /// The weights' quadratic form beyond that of the targets.
    void
    add_weights()
    {
      const Number &eta = of[PatchSum::importance];
      const Number  blended(scene.blended_part), square = Number(0.5) * blended * D * D;
      Number        form(0.);
      if (scene.has_own_examples)
      {
        form = of[PatchSum::excess];
        by[PatchSum::excess] += square;
      }
      else if (eta > Number(0.))
      {
        const Number ratio = (Number(1.) - eta) / eta;
        form               = ratio * lambda;
        by[PatchSum::lambda] += ratio * square;
        by[PatchSum::importance] -= lambda * square / (eta * eta);
      }
      density += form * square;
      by[PatchSum::wish] += blended * form * D;
    }

    void
    add_guard()
    {
      const Number &m = of[PatchSum::square], &of_examples = of[PatchSum::bound], zero(0.);
      const Number  bound = bound_of_guard(of_examples), stiffness = share * lambda;
      if (!(m > bound && stiffness > zero))
        return;
      const GuardTransition<Number> transition(m, bound);
      const Number                  beta = transition.value(), first = transition.first();
      const Number                  square = of[PatchSum::trace_square] - theta * theta;
      const Number                  Xi = energy_of_guard(stiffness, square, of[PatchSum::guard]);
      density += beta * Xi;
      by_share += beta * energy_of_guard(lambda, square, zero);
      by[PatchSum::lambda] += beta * energy_of_guard(share, square, zero);
      by[PatchSum::trace] -= beta * stiffness * theta;
      by[PatchSum::trace_square] += Number(0.5) * beta * stiffness;
      by[PatchSum::guard] += beta;
      by[PatchSum::square] += first * Xi;
      if (bound > bound_of_guard(zero)) // beta is a function of m / bound
        by[PatchSum::bound] -= first * m / of_examples * Xi;
    }

    const PatchScene         scene;
    const PatchSums<Number> &of; ///< means
    const Number            &lambda, &theta, &D;
    const Number             share;
    Number                   density = Number(0.), by_share = Number(0.);
    PatchSums<Number>        by;
  };

  /// The potential of a patch with these sums.
  template <typename Number>
  PatchPotential<Number>
  patch_potential(const PatchScene &scene, const PatchSums<Number> &sums, const Number &importance)
  {
    const Number     &V     = sums[PatchSum::volume];
    PatchSums<Number> means = sums;
    for (Number &number : means.numbers)
      number /= V;
    return PatchDensity<Number>(scene, means, importance).times_volume(V);
  }
} // namespace Exemplar

#endif
