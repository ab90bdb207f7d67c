// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_elasticity_h
#define exemplar_elasticity_h

#include <exemplar/kernels/matrix3.h>

// The material of a cell as the kernels see it. Cells, loops and batches know it by what is here
// alone, under the name CellMaterial; only the loop that adds R K R^T (loops_stiffness.h) also uses
// that it is isotropic. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// C:E = lambda tr(E) I + 2 mu E, Eq. (3), with Lamé's constants [Pa].
  template <typename Number>
  struct Isotropic
  {
    /// That are stored for each cell.
    static constexpr std::size_t n_numbers = 2;

    Number lambda;
    Number mu;

    /// From what load(k) finds for number k.
    template <typename Load>
    static Isotropic
    from_numbers(const Load &load)
    {
      return { load(0), load(1) };
    }

    const Number &
    number(const std::size_t k) const
    {
      return k == 0 ? lambda : mu;
    }

    /// The material of which C is `factor` times this one's.
    Isotropic
    scaled(const Number &factor) const
    {
      return { factor * lambda, factor * mu };
    }

    /// 2 mu, by which the guard of Eq. (16) multiplies the deviator of the target strain [Pa].
    Number
    guard_modulus() const
    {
      return Number(2.) * mu;
    }

    /// An estimate of the norm of C [Pa]: how much the rounding of a strain can grow in its stress.
    Number
    norm_estimate() const
    {
      return abs(lambda) + Number(2.) * mu;
    }
  };

  template <typename Number>
  using CellMaterial = Isotropic<Number>;

  /// C:E [Pa].
  template <typename Number>
  Matrix3<Number>
  stress(const Isotropic<Number> &material, const Matrix3<Number> &strain)
  {
    const Number    pressure = material.lambda * trace(strain);
    Matrix3<Number> T;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        T[i][j] = Number(2.) * material.mu * strain[i][j] + (i == j ? pressure : Number(0.));
    return T;
  }
} // namespace Exemplar

#endif
