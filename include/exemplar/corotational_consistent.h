// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_corotational_consistent_h
#define exemplar_corotational_consistent_h

#include <exemplar/corotational.h>

#include <cmath>

// The force that is the gradient of the energy with examples, and its tangent. A cell's
// energy density is a function of S, the symmetric factor of F = R S, and of the target
// stretch A = I + eta E(w):
//
//   psi = mu |S - A|^2 + lambda/2 tr^2(S - A) + 2 mu (1 - phi) S : dev A,      Eq. (16)
//
// where the guard phi is 1 but in badly inverted cells. No deal.II header here: see
// matrix3.h.

namespace Exemplar
{
  constexpr double default_guard_bound = 0.8; ///< p_0 of guard()

  /// Vector a of the skew matrix W, W b = a x b.
  template <typename Number>
  Vector3<Number>
  axial_vector(const Matrix3<Number> &W)
  {
    return { { W[2][1], W[0][2], W[1][0] } };
  }

  template <typename Number>
  Matrix3<Number>
  skew_matrix(const Vector3<Number> &a)
  {
    const Number zero = Number(0.);
    return { { { zero, -a[2], a[1] }, { a[2], zero, -a[0] }, { -a[1], a[0], zero } } };
  }

  template <typename Number>
  Matrix3<Number>
  commutator(const Matrix3<Number> &A, const Matrix3<Number> &B)
  {
    const Matrix3<Number> AB = A * B, BA = B * A;
    Matrix3<Number>       C;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        C[i][j] = AB[i][j] - BA[i][j];
    return C;
  }

  /// a A + b B.
  template <typename Number>
  Matrix3<Number>
  combine(const Number &a, const Matrix3<Number> &A, const Number &b, const Matrix3<Number> &B)
  {
    Matrix3<Number> C;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        C[i][j] = a * A[i][j] + b * B[i][j];
    return C;
  }

  /// The part of a symmetric matrix that the guard keeps: its sphere, and phi of the rest.
  template <typename Number>
  Matrix3<Number>
  guarded(const Matrix3<Number> &A, const Number &phi)
  {
    const Number    third  = trace(A) / Number(3.);
    Matrix3<Number> result = combine(phi, A, Number(0.), A);
    for (int i = 0; i < 3; ++i)
      result[i][i] += (Number(1.) - phi) * third;
    return result;
  }

  /// phi = z^2 (3 - 2 z), z = clamp(p/p_0, 0, 1), and its derivative by p. The product
  /// p = (s_1+s_2)(s_2+s_3)(s_3+s_1) of the singular values, s_3 < 0 in a mirrored cell, is
  /// 8 at rest and 0 where the rotation is ambiguous and the energy with an example would jump.
  template <typename Number>
  struct Guard
  {
    Number phi;
    Number derivative;
  };

  template <typename Number>
  Guard<Number>
  guard(const Number &p, const Number &p_0)
  {
    Number z = p / p_0;
    if (z >= Number(1.))
      return { Number(1.), Number(0.) };
    if (!(z > Number(0.)))
      z = Number(0.);
    return { z * z * (Number(3.) - Number(2.) * z), Number(6.) * z * (Number(1.) - z) / p_0 };
  }

  /// Inverse of the symmetric positive semidefinite matrix B = tr(S) I - S with its
  /// eigenvalues s_i + s_j held above `least`, by cyclic Jacobi rotations.
  template <typename Number>
  Matrix3<Number>
  bounded_inverse(Matrix3<Number> B, const Number &least)
  {
    Matrix3<Number> V = identity_matrix<Number>();
    for (int sweep = 0; sweep < 8; ++sweep)
      for (int p = 0; p < 2; ++p)
        for (int q = p + 1; q < 3; ++q)
        {
          if (B[p][q] == Number(0.))
            continue;
          const Number theta = (B[q][q] - B[p][p]) / (Number(2.) * B[p][q]);
          const Number sign  = theta >= Number(0.) ? Number(1.) : Number(-1.);
          const Number t     = sign / (std::abs(theta) + std::sqrt(theta * theta + Number(1.)));
          const Number c     = Number(1.) / std::sqrt(t * t + Number(1.));
          const Number s     = t * c;
          for (int k = 0; k < 3; ++k)
          {
            const Number b = B[k][p];
            B[k][p]        = c * b - s * B[k][q];
            B[k][q]        = s * b + c * B[k][q];
          }
          for (int k = 0; k < 3; ++k)
          {
            const Number b = B[p][k];
            B[p][k]        = c * b - s * B[q][k];
            B[q][k]        = s * b + c * B[q][k];
            const Number v = V[k][p];
            V[k][p]        = c * v - s * V[k][q];
            V[k][q]        = s * v + c * V[k][q];
          }
        }
    Matrix3<Number> inverse{};
    for (int e = 0; e < 3; ++e)
    {
      const Number eigenvalue = B[e][e] > least ? B[e][e] : least;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          inverse[i][j] += V[i][e] * V[j][e] / eigenvalue;
    }
    return inverse;
  }

  /// What the energy of Eq. (16) needs of a deformed cell, in the frame of the rotation.
  template <typename Number>
  class ConsistentCell
  {
  public:
    /// `p_0` is the bound below which the guard acts; `has_example` tells whether the
    /// target may differ from the identity.
    ConsistentCell(const Lame<Number>    &lame,
                   const Matrix3<Number> &rotation,
                   const Matrix3<Number> &deformation_gradient,
                   const Number          &p_0)
        : lame(lame), S(symmetric_part(transpose_times(rotation, deformation_gradient)))
    {
      B = combine(Number(-1.), S, Number(0.), S);
      for (int i = 0; i < 3; ++i)
        B[i][i] += trace(S);
      p                     = determinant(B);
      const Guard<Number> g = guard(p, p_0);
      phi                   = g.phi;
      phi_derivative        = g.derivative;
    }

    bool
    is_guarded() const
    {
      return phi < Number(1.);
    }

    const Matrix3<Number> &
    stretch() const
    {
      return S;
    }

    /// psi for the target stretch A, in the residual form: near an example the expanded
    /// one cancels.
    Number
    energy(const Matrix3<Number> &A) const
    {
      const Matrix3<Number> D     = combine(Number(1.), S, Number(-1.), A);
      const Number          t     = trace(D);
      const Number          shift = contract(S, A) - trace(A) / Number(3.) * trace(S); // S : dev A
      return lame.mu * contract(D, D) + Number(0.5) * lame.lambda * t * t
             + Number(2.) * lame.mu * (Number(1.) - phi) * shift;
    }

    /// -d psi / dA: contracted with E_i, the derivative by a weight less the factor -eta.
    Matrix3<Number>
    weight_stress(const Matrix3<Number> &A) const
    {
      Matrix3<Number> result
          = combine(Number(2.) * lame.mu, guarded(S, phi), Number(-2.) * lame.mu, A);
      for (int i = 0; i < 3; ++i)
        result[i][i] += lame.lambda * (trace(S) - trace(A));
      return result;
    }

    /// Prepare force() and response() for the target A.
    void
    set_target(const Matrix3<Number> &A)
    {
      const Number t = trace(S) - trace(A);
      T              = combine(Number(2.) * lame.mu, S, Number(-2.) * lame.mu, guarded(A, phi));
      for (int i = 0; i < 3; ++i)
        T[i][i] += lame.lambda * t;
      // the force divides by s_i + s_j only what the guard makes vanish faster
      B_inverse   = is_guarded() ? bounded_inverse(B, Number(1e-8)) : inverse(B);
      W           = skew_matrix(B_inverse * axial_vector(commutator(S, T)));
      guard_force = Number(-2.) * lame.mu * phi_derivative
                    * (contract(S, A) - trace(A) / Number(3.) * trace(S));
      if (is_guarded())
        B_inverse = bounded_inverse(B, Number(1e-2));
    }

    /// R^T P = T + W + guard, Eq. (17), with P the derivative of psi by F.
    Matrix3<Number>
    force() const
    {
      Matrix3<Number> P = combine(Number(1.), T, Number(1.), W);
      if (phi_derivative != Number(0.))
        P = combine(Number(1.), P, guard_force, p_derivative());
      return P;
    }

    /// R^T dP for R^T dF = M, Eq. (18); symmetric in M. In guarded cells the derivative of
    /// the guard is left out and denominators are bounded.
    Matrix3<Number>
    response(const Matrix3<Number> &M) const
    {
      Matrix3<Number> difference;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          difference[i][j] = M[i][j] - M[j][i];
      const Matrix3<Number> Omega = skew_matrix(B_inverse * axial_vector(difference));
      const Matrix3<Number> dS    = symmetric_part(combine(Number(1.), M, Number(-1.), Omega * S));
      const Matrix3<Number> dT    = stress(lame, dS);
      const Matrix3<Number> right
          = combine(Number(1.), commutator(dS, T), Number(1.), commutator(S, dT));
      const Matrix3<Number> dS_W = dS * W, W_dS = W * dS;
      Matrix3<Number>       skew;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          skew[i][j] = right[i][j] - dS_W[i][j] - W_dS[i][j];
      const Matrix3<Number> dW = skew_matrix(B_inverse * axial_vector(skew));
      return combine(Number(1.), Omega * combine(Number(1.), T, Number(1.), W), Number(1.),
                     combine(Number(1.), dT, Number(1.), dW));
    }

    /// R^T dP for a unit change of the target by -E, a column of the coupling less the
    /// factor eta.
    Matrix3<Number>
    example_response(const Matrix3<Number> &E) const
    {
      const Matrix3<Number> dT = stress(lame, guarded(E, phi));
      return combine(Number(1.), dT, Number(1.),
                     skew_matrix(B_inverse * axial_vector(commutator(S, dT))));
    }

  private:
    static Matrix3<Number>
    inverse(const Matrix3<Number> &A)
    {
      const Matrix3<Number> C      = cofactors(A);
      const Number          factor = Number(1.) / determinant(A);
      return combine(factor, C, Number(0.), C); // symmetric, so cofactors need no transpose
    }

    /// dp/dS = I_2 I + I_1 (I_1 I - S) - cof S.
    Matrix3<Number>
    p_derivative() const
    {
      const Number    I_1 = trace(S);
      const Number    I_2 = Number(0.5) * (I_1 * I_1 - contract(S, S));
      Matrix3<Number> D   = combine(Number(-1.) * I_1, S, Number(-1.), cofactors(S));
      for (int i = 0; i < 3; ++i)
        D[i][i] += I_2 + I_1 * I_1;
      return D;
    }

    Lame<Number>    lame;
    Matrix3<Number> S;
    Matrix3<Number> B; ///< tr(S) I - S
    Number          p;
    Number          phi;
    Number          phi_derivative;
    Matrix3<Number> T;
    Matrix3<Number> W;
    Matrix3<Number> B_inverse;
    Number          guard_force;
  };
} // namespace Exemplar

#endif
