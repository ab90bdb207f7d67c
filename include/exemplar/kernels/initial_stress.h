// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_initial_stress_h
#define exemplar_initial_stress_h

#include <exemplar/kernels/stretch_guard.h>

// An initial stress tau of a cell, in the axes of its rest pose, with the energy density
//
//   tau : (S - I) - (1 - phi) S : dev tau,        Eq. (39)
//
// where S is the symmetric factor of F = R S, and phi the guard of Eq. (16), without which the
// energy would jump where the rotation is ambiguous. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// A deformed cell with an initial stress.
  class InitialStress
  {
  public:
    /// `rotation` is that of `deformation_gradient`.
    InitialStress(const Matrix3<double> &tau,
                  const Matrix3<double> &rotation,
                  const Matrix3<double> &deformation_gradient)
        : tau(tau), deviator_of_tau(deviator(tau)),
          S(symmetric_part(transpose_times(rotation, deformation_gradient)))
    {
      Matrix3<double> B = combine(-1., S, 0., S);
      for (int i = 0; i < 3; ++i)
        B[i][i] += trace(S);
      of_product = guard(determinant(B), p_0);
      B_inverse  = bounded_inverse(B, 1e-8);
      T          = combine(1., tau, of_product.phi - 1., deviator_of_tau);
      W          = skew_part_of_force(commutator(S, T));
    }

    /// Energy density [J/m^3], 0 at rest.
    double
    energy() const
    {
      return contract(tau, S) - trace(tau) - (1. - of_product.phi) * contract(S, deviator_of_tau);
    }

    /// R^T P = T + W + the guard's force, as in Eq. (17), where P is the derivative by F.
    Matrix3<double>
    force() const
    {
      return combine(1., combine(1., T, 1., W),
                     of_product.derivative * contract(S, deviator_of_tau), p_derivative(S));
    }

    /// R^T dP for R^T dF = M, Eq. (18) with C = 0; symmetric in M.
    Matrix3<double>
    response(const Matrix3<double> &M) const
    {
      Matrix3<double> difference;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          difference[i][j] = M[i][j] - M[j][i];
      const Matrix3<double> Omega = skew_part_of_force(difference);
      const Matrix3<double> dS    = symmetric_part(combine(1., M, -1., Omega * S));
      const Matrix3<double> by_S  = p_derivative(S);
      const double          dp    = contract(by_S, dS);
      const Matrix3<double> dT
          = combine(of_product.derivative * dp, deviator_of_tau, 0., deviator_of_tau);
      const Matrix3<double> commutators = combine(1., commutator(dS, T), 1., commutator(S, dT));
      const Matrix3<double> of_W        = combine(1., dS * W, 1., W * dS);
      const Matrix3<double> dW          = skew_part_of_force(combine(1., commutators, -1., of_W));
      const Matrix3<double> dP
          = combine(1., Omega * combine(1., T, 1., W), 1., combine(1., dT, 1., dW));
      const double          g = contract(S, deviator_of_tau), dg = contract(dS, deviator_of_tau);
      const Matrix3<double> of_guard = combine(
          of_product.second * dp * g + of_product.derivative * dg, by_S, of_product.derivative * g,
          combine(1., p_second_derivative(S, dS), 1., Omega * by_S));
      return combine(1., dP, 1., of_guard);
    }

  private:
    static constexpr double p_0 = 0.8;

    /// The skew matrix X with S X + X S = K.
    Matrix3<double>
    skew_part_of_force(const Matrix3<double> &K) const
    {
      return skew_matrix(B_inverse * axial_vector(K));
    }

    Matrix3<double> tau, deviator_of_tau;
    Matrix3<double> S;
    Guard<double>   of_product;
    Matrix3<double> B_inverse; ///< inverse of tr(S) I - S
    Matrix3<double> T, W;
  };
} // namespace Exemplar

#endif
