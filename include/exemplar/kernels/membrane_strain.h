// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_membrane_strain_h
#define exemplar_membrane_strain_h

#include <exemplar/kernels/vector_product.h>

#include <array>

// The strain of a triangle in its plane, corotated, and its derivatives in closed form. No deal.II
// header here: see matrix3.h.

namespace Exemplar
{
  /// A symmetric matrix of 2 x 2 numbers: xx, yy, xy.
  template <typename Number>
  using Symmetric2 = std::array<Number, 3>;

  /// A : B of symmetric matrices.
  template <typename Number>
  Number
  contract(const Symmetric2<Number> &A, const Symmetric2<Number> &B)
  {
    return A[0] * B[0] + A[1] * B[1] + Number(2.) * A[2] * B[2];
  }

  /// A without its negative eigenvalue, if it has one.
  template <typename Number>
  Symmetric2<Number>
  positive_part(const Symmetric2<Number> &A)
  {
    const Number mean = Number(0.5) * (A[0] + A[1]), half = Number(0.5) * (A[0] - A[1]);
    const Number radius = sqrt(half * half + A[2] * A[2]);
    const Number least = mean - radius, greatest = mean + radius;
    if (!(least < Number(0.)))
      return A;
    if (!(greatest > Number(0.)))
      return {};
    const Number factor = greatest / (Number(2.) * radius); // greatest v v^T = factor (A - least I)
    return { { factor * (A[0] - least), factor * (A[1] - least), factor * A[2] } };
  }

  /// What a change dF of F changes: A = R^T dF by rows, and the spin (A21 - A12)/tr U of R.
  template <typename Number>
  struct MembraneChange
  {
    Number             A[2][2];
    Number             spin;
    Symmetric2<Number> dU;
  };

  /// N : d2U for a change of F, with N fixed: of_spin spin^2 + 2 of_product spin L + of_square L^2 + a.S.a with
  /// L = trace_like : A, where a = n.dF is the change out of the plane.
  template <typename Number>
  struct MembraneGeometry
  {
    Number             of_spin, of_product, of_square;
    Symmetric2<Number> trace_like;
    Symmetric2<Number> S;

    /// L.
    Number
    of(const MembraneChange<Number> &change) const
    {
      return trace_like[0] * change.A[0][0] + trace_like[1] * change.A[1][1]
             + trace_like[2] * (change.A[0][1] + change.A[1][0]);
    }
  };

  /// F = R U of a triangle: F has 3 x 2 numbers, R orthonormal columns, and U = (F^T F)^(1/2) is
  /// symmetric.
  template <typename Number>
  class MembraneStrain
  {
  public:
    /// F by its columns.
    MembraneStrain(const Vector3<Number> &F1, const Vector3<Number> &F2)
    {
      const Number          xx = dot(F1, F1), yy = dot(F2, F2), xy = dot(F1, F2);
      const Vector3<Number> area = cross(F1, F2);
      // a triangle without area has no plane, but a strain, and numbers
      det       = max(Exemplar::norm(area), Number(1e-12) * (xx + yy));
      trace_U   = sqrt(xx + yy + Number(2.) * det);
      U         = { { (xx + det) / trace_U, (yy + det) / trace_U, xy / trace_U } };
      n         = times(Number(1.) / det, area);
      inverse_U = { { U[1] / det, U[0] / det, -U[2] / det } };
      R[0]      = combine(inverse_U[0], F1, inverse_U[2], F2);
      R[1]      = combine(inverse_U[2], F1, inverse_U[1], F2);
    }

    /// U - I.
    Symmetric2<Number>
    strain() const
    {
      return { { U[0] - Number(1.), U[1] - Number(1.), U[2] } };
    }

    /// det U, the area over that at rest.
    Number
    area_ratio() const
    {
      return det;
    }

    /// Column j of R.
    const Vector3<Number> &
    axis(const int j) const
    {
      return R[j];
    }

    const Vector3<Number> &
    normal() const
    {
      return n;
    }

    /// P = R (N - mu J), the derivative of N:U by F, by its columns; J turns by 90 degrees.
    std::array<Vector3<Number>, 2>
    force(const Symmetric2<Number> &N) const
    {
      const Number mu = skew_part(N);
      return { { combine(N[0], R[0], N[2] - mu, R[1]), combine(N[2] + mu, R[0], N[1], R[1]) } };
    }

    /// The change by dF = d g^T, for a vector d in space and one in the plane.
    MembraneChange<Number>
    change(const Vector3<Number> &d, const Number &g1, const Number &g2) const
    {
      const Number d1 = dot(R[0], d), d2 = dot(R[1], d);
      return change_by(d1 * g1, d1 * g2, d2 * g1, d2 * g2);
    }

    /// The change by dF by its columns.
    MembraneChange<Number>
    change(const Vector3<Number> &dF1, const Vector3<Number> &dF2) const
    {
      return change_by(dot(R[0], dF1), dot(R[0], dF2), dot(R[1], dF1), dot(R[1], dF2));
    }

    /// The second derivative of N:U; with `convex` its part in the plane and that out of it without
    /// negative eigenvalues.
    MembraneGeometry<Number>
    geometry(const Symmetric2<Number> &N, const bool convex) const
    {
      const Number             mu = skew_part(N), trace_N = N[0] + N[1];
      MembraneGeometry<Number> result{ trace_U * trace_N - contract(N, U),
                                       Number(1.),
                                       Number(0.),
                                       { { mu - N[2], mu + N[2], Number(0.5) * (N[0] - N[1]) } },
                                       {} };
      // U^-1 (N - mu J), which is symmetric
      result.S = { { inverse_U[0] * N[0] + inverse_U[2] * (N[2] - mu),
                     inverse_U[1] * N[1] + inverse_U[2] * (N[2] + mu),
                     inverse_U[0] * (N[2] + mu) + inverse_U[2] * N[1] } };
      if (!convex)
        return result;
      result.S = positive_part(result.S);
      project(result);
      return result;
    }

  private:
    /// The change by A by rows.
    MembraneChange<Number>
    change_by(const Number &A11, const Number &A12, const Number &A21, const Number &A22) const
    {
      const Number w = (A21 - A12) / trace_U;
      return { { { A11, A12 }, { A21, A22 } },
               w,
               { { A11 + w * U[2], A22 - w * U[2],
                   Number(0.5) * (A12 + A21 + w * (U[1] - U[0])) } } };
    }

    /// mu = N:(J U)/tr U.
    Number
    skew_part(const Symmetric2<Number> &N) const
    {
      return (U[2] * (N[1] - N[0]) + N[2] * (U[0] - U[1])) / trace_U;
    }

    /// With unit coordinates spin tr U/2^(1/2) and L/|L| the part in the plane is [p q; q 0], of
    /// which one eigenvalue is not negative.
    void
    project(MembraneGeometry<Number> &of) const
    {
      const Number root = sqrt(Number(2.));
      const Number size = sqrt(contract(of.trace_like, of.trace_like));
      const Number p = Number(2.) * of.of_spin / (trace_U * trace_U), q = root * size / trace_U;
      const Number value = Number(0.5) * (p + sqrt(p * p + Number(4.) * q * q));
      if (!(value > Number(0.)))
      {
        of.of_spin = of.of_product = of.of_square = Number(0.);
        return;
      }
      const Number factor = value / (value * value + q * q);
      const Number u = value * trace_U / root, v = root / trace_U; // eigenvector, by spin and L
      of.of_spin    = factor * u * u;
      of.of_product = factor * u * v;
      of.of_square  = factor * v * v;
    }

    Number             det, trace_U;
    Symmetric2<Number> U, inverse_U;
    Vector3<Number>    R[2], n;
  };
} // namespace Exemplar

#endif
