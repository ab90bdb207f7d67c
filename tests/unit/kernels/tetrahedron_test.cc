// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/elasticity.h>
#include <exemplar/kernels/polar_decomposition.h>
#include <exemplar/kernels/tetrahedron.h>

#include "matrices.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    const CellMaterial<double> soft = { 1.3, 0.7 };

    /// The tetrahedron with nodes 0, e_x, e_y, e_z.
    Tetrahedron<double>
    unit_tetrahedron()
    {
      return {
        { { { -1., -1., -1. } }, { { 1., 0., 0. } }, { { 0., 1., 0. } }, { { 0., 0., 1. } } },
        1. / 6.
      };
    }

    double
    energy_density(const Matrix3<double> &strain)
    {
      return 0.5 * contract(stress(soft, strain), strain);
    }

    double
    energy_density_of(const Matrix3<double> &F)
    {
      return energy_density(corotated_strain(closest_rotation(F), F));
    }

    void
    set_random_positions(Vector3<double> (&x)[4], std::mt19937 &generator)
    {
      const Matrix3<double> A = random_matrix(generator);
      for (int a = 0; a < 4; ++a)
        for (int i = 0; i < 3; ++i)
          x[a][i] = A[i][a % 3] + 0.1 * a;
    }

    TEST(Corotational, DeformationGradientOfAnAffineMap)
    {
      const Matrix3<double> A = { { { 1., 2., 3. }, { 0., 1., 4. }, { 5., 6., 0. } } };
      const Vector3<double> x[4]
          = { { { 7., 8., 9. } }, { { 8., 8., 14. } }, { { 9., 9., 15. } }, { { 10., 12., 9. } } };
      EXPECT_LT(max_difference(deformation_gradient(unit_tetrahedron(), x), A), 1e-14);
    }

    TEST(Corotational, EnergyOfUniformScale)
    {
      const double s = 0.6;
      EXPECT_NEAR(energy_density_of({ { { s, 0., 0. }, { 0., s, 0. }, { 0., 0., s } } }),
                  3. * soft.mu * (s - 1.) * (s - 1.) + 4.5 * soft.lambda * (s - 1.) * (s - 1.),
                  1e-14);
    }

    TEST(Corotational, EnergyOfSimpleShear)
    {
      for (const double gamma : { 0.1, 1., 3. })
      {
        const double r = std::sqrt(4. + gamma * gamma);
        EXPECT_NEAR(energy_density_of({ { { 1., gamma, 0. }, { 0., 1., 0. }, { 0., 0., 1. } } }),
                    soft.mu * (4. + gamma * gamma - 2. * r)
                        + 0.5 * soft.lambda * (r - 2.) * (r - 2.),
                    1e-13);
      }
    }

    TEST(Corotational, UniaxialStretchOfTheBiotMaterial)
    {
      // lateral stretch 1 - nu (s - 1), stress E (s - 1) along, none across
      const double          nu = soft.lambda / (2. * (soft.lambda + soft.mu));
      const double          E = 2. * soft.mu * (1. + nu), s = 1.5, t = 1. - nu * (s - 1.);
      const Matrix3<double> F = { { { s, 0., 0. }, { 0., t, 0. }, { 0., 0., t } } };
      const Matrix3<double> T = stress(soft, corotated_strain(closest_rotation(F), F));
      EXPECT_NEAR(T[0][0], E * (s - 1.), 1e-14);
      EXPECT_NEAR(T[1][1], 0., 1e-14);
    }

    TEST(Corotational, RigidMotionTurnsTheForces)
    {
      std::mt19937          generator(1);
      const Matrix3<double> Q   = rotation_about({ { 3., -1., 2. } }, 3.1);
      const auto            tet = unit_tetrahedron();
      for (int sample = 0; sample < 100; ++sample)
      {
        Vector3<double> x[4], turned[4], force[4], turned_force[4];
        set_random_positions(x, generator);
        for (int a = 0; a < 4; ++a)
          turned[a] = Q * x[a];
        const auto forces = [&](const Vector3<double>(&positions)[4], Vector3<double>(&f)[4])
        {
          const Matrix3<double> F = deformation_gradient(tet, positions);
          const Matrix3<double> R = closest_rotation(F);
          frozen_forces(tet, R, stress(soft, corotated_strain(R, F)), f);
        };
        forces(x, force);
        forces(turned, turned_force);
        for (int a = 0; a < 4; ++a)
        {
          const Vector3<double> expected = Q * force[a];
          for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(turned_force[a][i], expected[i], 1e-11);
        }
      }
    }

    // With the rotation held fixed the energy is quadratic in x, so that central
    // differences are exact up to rounding.
    TEST(Corotational, FrozenForcesAreTheGradientOfTheFrozenEnergy)
    {
      std::mt19937 generator(2);
      const auto   tet = unit_tetrahedron();
      for (int sample = 0; sample < 20; ++sample)
      {
        const Matrix3<double> R      = closest_rotation(random_matrix(generator));
        const Matrix3<double> target = symmetric_part(random_matrix(generator));
        Vector3<double>       x[4];
        set_random_positions(x, generator);
        const auto deviation = [&]
        {
          Matrix3<double> e = corotated_strain(R, deformation_gradient(tet, x));
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
              e[i][j] -= target[i][j];
          return e;
        };
        Vector3<double> force[4];
        frozen_forces(tet, R, stress(soft, deviation()), force);
        for (int a = 0; a < 4; ++a)
          for (int i = 0; i < 3; ++i)
          {
            const double h = 1e-3, at = x[a][i];
            x[a][i]            = at + h;
            const double above = energy_density(deviation());
            x[a][i]            = at - h;
            const double below = energy_density(deviation());
            x[a][i]            = at;
            EXPECT_NEAR(force[a][i], tet.volume * (above - below) / (2. * h), 1e-10);
          }
      }
    }
  } // namespace
} // namespace Exemplar::Testing
