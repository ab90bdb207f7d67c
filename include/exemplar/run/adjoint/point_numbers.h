// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_point_numbers_h
#define exemplar_point_numbers_h

#include <exemplar/kernels/symmetric.h>
#include <exemplar/run/adjoint/point_shape.h>

// Numbers with derivatives for evaluating the potential of a point: which variables they have, and
// where.

namespace Exemplar
{
  /// Variables of a point's potential, with the places of their derivatives: E, nu, eta, the six
  /// entries of the wish (the blended strain), and the shape, six entries of S or nine of F.
  namespace OfPoint
  {
    constexpr std::size_t E = 0, nu = 1, eta = 2, n_constants = 3;
    constexpr std::size_t wish = 3, shape = 9, n_with_S = 15, n_with_F = 18;

    using Constants = std::array<double, n_constants>;

    /// Number with a change along the direction and derivatives by the constants.
    using Regular = Dual<1 + n_constants>;

    inline void
    seed(Regular &number, const std::size_t k)
    {
      if (k < n_constants)
        number.by[1 + k] = 1.;
    }

    template <std::size_t n_by>
    void
    seed(HyperDual<n_by> &number, const std::size_t k)
    {
      if (k < n_by)
        number.by[k] = 1.;
    }

    /// The number whose derivative k is 1.
    template <typename Number>
    Number
    seeded(const double value, const double change, const std::size_t k)
    {
      Number number(value, change);
      seed(number, k);
      return number;
    }

    template <typename Number>
    Matrix3<Number>
    seeded_symmetric(const Matrix3<double> &A, const Matrix3<double> &dA, const std::size_t first)
    {
      const SymmetricEntries<double> value = pack(A), change = pack(dA);
      SymmetricEntries<Number>       entries;
      for (std::size_t k = 0; k < n_symmetric; ++k)
        entries[k] = seeded<Number>(value[k], change[k], first + k);
      return unpack(entries);
    }

    template <typename Number>
    Matrix3<Number>
    seeded_shape(const PointShape &at)
    {
      const Matrix3<double> &A = at.get_value(), &dA = at.get_change();
      if (at.is_turned())
        return seeded_symmetric<Number>(A, dA, shape);
      Matrix3<Number> result;
      for (std::size_t k = 0; k < 9; ++k)
        result[k / 3][k % 3] = seeded<Number>(A[k / 3][k % 3], dA[k / 3][k % 3], shape + k);
      return result;
    }

    /// The matrix of part(number) of each entry.
    template <typename Result, typename Number, typename Part>
    Matrix3<Result>
    parts_of(const Matrix3<Number> &A, const Part &part)
    {
      Matrix3<Result> result;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          result[i][j] = part(A[i][j]);
      return result;
    }

    /// The numbers with their changes along the direction alone.
    inline Matrix3<HyperDual<0>>
    changing(const Matrix3<Regular> &A)
    {
      return parts_of<HyperDual<0>>(A, [](const Regular &number)
                                    { return HyperDual<0>(number.value, number.by[0]); });
    }

    /// The symmetric matrix whose contraction with dA is the change of the number by dA, from
    /// entries `first`.
    template <std::size_t n_by>
    Matrix3<HyperDual<0>>
    by_symmetric(const HyperDual<n_by> &number, const std::size_t first)
    {
      SymmetricEntries<HyperDual<0>> entries;
      for (std::size_t k = 0; k < n_symmetric; ++k)
      {
        const double part = k < 3 ? 1. : 0.5;
        entries[k]        = { part * number.by[first + k], part * number.change_by[first + k] };
      }
      return unpack(entries);
    }

    /// R^T P of a potential, P = dPsi/dF.
    inline Matrix3<HyperDual<0>>
    by_shape(const HyperDual<n_with_S> &potential, const PointShape &at)
    {
      return with_turn(seeded_symmetric<HyperDual<0>>(at.get_value(), at.get_change(), 0),
                       by_symmetric(potential, shape));
    }

    inline Matrix3<HyperDual<0>>
    by_shape(const HyperDual<n_with_F> &potential, const PointShape & /*at*/)
    {
      Matrix3<HyperDual<0>> A;
      for (std::size_t k = 0; k < 9; ++k)
        A[k / 3][k % 3] = { potential.by[shape + k], potential.change_by[shape + k] };
      return A;
    }
  } // namespace OfPoint
} // namespace Exemplar

#endif
