// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/neo_hookean_cell.h>
#include <exemplar/kernels/polar_decomposition.h>

#include "matrices.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    using NeoCell = NeoHookeanCell<double>;

    const CellMaterial<double> flesh = { 1.3, 0.7 };

    // The constants of the formula as it is published.
    const double mu_S = 4. / 3. * flesh.mu, lambda_S = flesh.lambda + 5. / 6. * flesh.mu,
                 alpha = 1. + 0.75 * mu_S / lambda_S;

    NeoCell
    neo_cell_at(const Matrix3<double> &F, const double importance = 0.)
    {
      return { flesh, closest_rotation(F), F, { 0.8, importance } };
    }

    Matrix3<double>
    neo_stress_at(const Matrix3<double> &F)
    {
      return closest_rotation(F) * neo_cell_at(F).elastic_force();
    }

    double
    published_energy(const Matrix3<double> &F)
    {
      const double I_C = contract(F, F), J = determinant(F);
      return 0.5 * mu_S * (I_C - 3.) + 0.5 * lambda_S * (J - alpha) * (J - alpha)
             - 0.5 * mu_S * std::log(I_C + 1.);
    }

    TEST(NeoHookean, EnergyIsThePublishedOneLessThatOfTheRestPose)
    {
      std::mt19937          generator(3);
      const Matrix3<double> I = identity_matrix<double>();
      EXPECT_EQ(neo_cell_at(I).elastic_density(), 0.);
      for (int sample = 0; sample < 50; ++sample)
      {
        const Matrix3<double> F = combine(1., I, 0.8, random_matrix(generator));
        EXPECT_NEAR(neo_cell_at(F).elastic_density(), published_energy(F) - published_energy(I),
                    1e-13);
      }
    }

    TEST(NeoHookean, SimpleShear)
    {
      for (const double gamma : { 0.1, 1., 5. })
      {
        Matrix3<double> F       = identity_matrix<double>();
        F[0][1]                 = gamma;
        const Matrix3<double> P = neo_stress_at(F);
        const double          k = mu_S * (1. - 1. / (4. + gamma * gamma)); // J = 1
        EXPECT_NEAR(P[0][1], k * gamma, 1e-14 * k * gamma + 1e-14);
        EXPECT_NEAR(P[1][0], flesh.mu * gamma, 1e-13);
        EXPECT_NEAR(P[0][0], k - flesh.mu, 1e-13);
        EXPECT_NEAR(P[2][2], k - flesh.mu, 1e-13);
      }
    }

    // The sides are free where k = mu_S (1 - 1/(I_C + 1)) equals -lambda_S (J - alpha) s.
    TEST(NeoHookean, UniaxialTension)
    {
      for (const double s : { 0.3, 0.8, 1.2, 3., 10. })
      {
        const auto k = [&](const double r) { return mu_S * (1. - 1. / (s * s + 2. * r * r + 1.)); };
        double     low = 0., high = 3.;
        while (high - low > 1e-15 * high && 0.5 * (low + high) > low && 0.5 * (low + high) < high)
        {
          const double r                                                = 0.5 * (low + high);
          (k(r) + lambda_S * (s * r * r - alpha) * s < 0. ? low : high) = r;
        }
        const double          r = 0.5 * (low + high);
        const Matrix3<double> Q = rotation_about({ { 1., 2., -1. } }, 0.8);
        const Matrix3<double> P = transpose_times(
            Q,
            neo_stress_at(Q * Matrix3<double>{ { { s, 0., 0. }, { 0., r, 0. }, { 0., 0., r } } }));
        EXPECT_NEAR(P[1][1], 0., 1e-12);
        EXPECT_NEAR(P[0][0], k(r) * (s - r * r / s), 1e-12); // -lambda_S (J - alpha) = k / s
      }
    }

    // Young's modulus and Poisson's ratio of small strains are those of C.
    TEST(NeoHookean, RestIsFreeOfStressAndOfTheStiffnessOfTheMaterial)
    {
      std::mt19937          generator(5);
      const Matrix3<double> I = identity_matrix<double>();
      for (const double importance : { 0., 0.6, 1. })
      {
        NeoCell cell = neo_cell_at(I, importance);
        cell.set_target({});
        EXPECT_EQ(norm(cell.force()), 0.);
        for (int sample = 0; sample < 10; ++sample)
        {
          const Matrix3<double> M = random_matrix(generator);
          EXPECT_LT(max_difference(cell.response(M), stress(flesh, symmetric_part(M))), 1e-14);
        }
      }
      for (const double nu : { -0.7, -0.3, 0., 0.3, 0.49 })
      {
        const double               mu = 0.5 / (1. + nu);
        const CellMaterial<double> C  = { 2. * mu * nu / (1. - 2. * nu), mu };
        for (int sample = 0; sample < 1000; ++sample)
        {
          const Matrix3<double> F = combine(0.5, I, 1., random_matrix(generator));
          EXPECT_GE(NeoCell(C, closest_rotation(F), F, {}).elastic_density(), 0.) << nu;
        }
      }
    }

    // A flat cell, and one that is mirrored, are pushed back through the plane.
    TEST(NeoHookean, InvertedCellsArePushedBack)
    {
      for (const double s : { 0., -0.2, -0.5, -2. })
      {
        Matrix3<double> F = identity_matrix<double>();
        F[2][2]           = s;
        EXPECT_LT(neo_stress_at(F)[2][2], -flesh.mu * 0.9) << s;
      }
    }
  } // namespace
} // namespace Exemplar::Testing
