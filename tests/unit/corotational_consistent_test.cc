// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/corotational_consistent.h>
#include <exemplar/polar_decomposition.h>

#include "matrices.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace Exemplar::Testing
{
  namespace
  {
    using Cell = ConsistentCell<double>;

    const Lame<double> lame = { 1.3, 0.7 };
    const double       p_0  = 0.8;

    Cell
    cell_at(const Matrix3<double> &F)
    {
      return Cell(lame, closest_rotation(F), F, p_0);
    }

    double
    energy(const Matrix3<double> &F, const Matrix3<double> &A)
    {
      return cell_at(F).energy(A);
    }

    /// P = R (T + W + guard).
    Matrix3<double>
    force(const Matrix3<double> &F, const Matrix3<double> &A)
    {
      Cell cell = cell_at(F);
      cell.set_target(A);
      return closest_rotation(F) * cell.force();
    }

    Matrix3<double>
    response(const Matrix3<double> &F, const Matrix3<double> &A, const Matrix3<double> &dF)
    {
      const Matrix3<double> R    = closest_rotation(F);
      Cell                  cell = cell_at(F);
      cell.set_target(A);
      return R * cell.response(transpose_times(R, dF));
    }

    Matrix3<double>
    moved(const Matrix3<double> &F, const double h, const Matrix3<double> &dF)
    {
      return combine(1., F, h, dF);
    }

    /// Fourth-order central difference of a function of h at 0.
    template <typename Function>
    double
    derivative(const Function &f, const double h)
    {
      return (8. * (f(h) - f(-h)) - (f(2. * h) - f(-2. * h))) / (12. * h);
    }

    std::vector<std::pair<std::string, Matrix3<double>>>
    states()
    {
      std::mt19937          generator(5);
      const Matrix3<double> I        = identity_matrix<double>();
      const auto            diagonal = [](double a, double b, double c) {
        return Matrix3<double>{ { { a, 0., 0. }, { 0., b, 0. }, { 0., 0., c } } };
      };
      const Matrix3<double> Q      = rotation_about({ { 1., 2., -1. } }, 0.8);
      const auto            turned = [&](const Matrix3<double> &D) {
        return Q * D * rotation_about({ { 0., 1., 3. } }, 2.);
      };
      std::vector<std::pair<std::string, Matrix3<double>>> all
          = { { "rest", I },
              { "turned by 179.9 degrees",
                rotation_about({ { 3., 1., 1. } }, 179.9 * M_PI / 180.) },
              { "flat", turned(diagonal(1.3, 0.8, 0.)) },
              { "nearly flat", turned(diagonal(1.3, 0.8, 1e-7)) },
              { "inverted", turned(diagonal(1.5, 1.2, -0.4)) },
              { "inverted, guarded", turned(diagonal(1.1, 0.7, -0.5)) },
              { "compressed", turned(diagonal(0.4, 0.3, 0.2)) },
              { "line", turned(diagonal(1.2, 0.3, 0.1)) } };
      for (int sample = 0; sample < 6; ++sample)
        all.emplace_back("random", combine(1., I, 0.4, random_matrix(generator)));
      return all;
    }

    std::vector<Matrix3<double>>
    targets()
    {
      std::mt19937          generator(6);
      const Matrix3<double> I = identity_matrix<double>();
      return { I, combine(1., I, 0.3, symmetric_part(random_matrix(generator))) };
    }

    TEST(ConsistentForce, IsTheGradientOfTheEnergy)
    {
      std::mt19937 generator(7);
      for (const auto &[name, F] : states())
        for (const Matrix3<double> &A : targets())
        {
          const Matrix3<double> P = force(F, A);
          const double scale      = std::sqrt(contract(P, P)) + lame.mu * std::sqrt(contract(F, F));
          std::vector<Matrix3<double>> directions = { combine(
              1. / (std::sqrt(contract(P, P)) + 1e-300), P, 0., P) }; // along the gradient, too
          for (int sample = 0; sample < 4; ++sample)
            directions.push_back(random_matrix(generator));
          for (const Matrix3<double> &dF : directions)
          {
            const double difference
                = derivative([&](const double h) { return energy(moved(F, h, dF), A); }, 1e-4);
            EXPECT_NEAR(contract(P, dF), difference,
                        1e-7 * scale * (1. + std::sqrt(contract(dF, dF))))
                << name;
          }
        }
    }

    TEST(ConsistentForce, TangentIsItsDerivative)
    {
      std::mt19937 generator(8);
      for (const auto &[name, F] : states())
        for (const Matrix3<double> &A : targets())
        {
          if (cell_at(F).is_guarded() && max_difference(A, identity_matrix<double>()) > 0.)
            continue; // there the tangent leaves out the derivative of the guard
          for (int sample = 0; sample < 4; ++sample)
          {
            const Matrix3<double> dF = random_matrix(generator), dP = response(F, A, dF);
            const double          scale = std::sqrt(contract(dP, dP)) + 1.;
            for (int i = 0; i < 3; ++i)
              for (int j = 0; j < 3; ++j)
                EXPECT_NEAR(dP[i][j],
                            derivative([&](const double h)
                                       { return force(moved(F, h, dF), A)[i][j]; },
                                       1e-4),
                            1e-7 * scale)
                    << name;
          }
        }
    }

    TEST(ConsistentForce, TangentIsSymmetric)
    {
      std::mt19937 generator(9);
      for (const auto &[name, F] : states())
        for (const Matrix3<double> &A : targets())
        {
          const Matrix3<double> a = random_matrix(generator), b = random_matrix(generator);
          const double ab = contract(a, response(F, A, b)), ba = contract(b, response(F, A, a));
          EXPECT_NEAR(ab, ba, 1e-11 * (std::abs(ab) + 10.)) << name;
        }
    }

    TEST(ConsistentForce, ExertsNoTorqueOnItsCell)
    {
      // P F^T is symmetric: angular momentum. The frozen force R T fails here.
      for (const auto &[name, F] : states())
        for (const Matrix3<double> &A : targets())
        {
          const Matrix3<double> P = force(F, A);
          Matrix3<double>       torque;
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
              torque[i][j] = P[i][0] * F[j][0] + P[i][1] * F[j][1] + P[i][2] * F[j][2];
          EXPECT_LT(max_difference(torque, symmetric_part(torque)), 1e-12) << name;
        }
    }

    TEST(ConsistentForce, WithoutExampleItIsTheFrozenForce)
    {
      const Matrix3<double> I = identity_matrix<double>();
      for (const auto &[name, F] : states())
      {
        const Matrix3<double> R = closest_rotation(F);
        EXPECT_LT(max_difference(force(F, I), R * stress(lame, corotated_strain(R, F))), 1e-12)
            << name;
      }
    }

    TEST(ConsistentForce, DerivativesByTheTarget)
    {
      std::mt19937 generator(10);
      for (const auto &[name, F] : states())
      {
        const Matrix3<double> A    = targets()[1];
        const Matrix3<double> E    = symmetric_part(random_matrix(generator));
        Cell                  cell = cell_at(F);
        cell.set_target(A);
        EXPECT_NEAR(-contract(cell.weight_stress(A), E),
                    derivative([&](const double h) { return energy(F, moved(A, h, E)); }, 1e-3),
                    1e-9)
            << name;
        if (cell.is_guarded())
          continue; // the column leaves out the derivative of the guard
        const Matrix3<double> column = closest_rotation(F) * cell.example_response(E);
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            EXPECT_NEAR(
                -column[i][j],
                derivative([&](const double h) { return force(F, moved(A, h, E))[i][j]; }, 1e-3),
                1e-9)
                << name;
      }
    }

    TEST(ConsistentForce, StaysBoundedAndContinuousWhereTheRotationIsAmbiguous)
    {
      // around sigma_2 + sigma_3 = 0 the rotation turns through all directions
      const Matrix3<double> A = targets()[1];
      for (const double angle : { 0., 0.5, 1., 2., 4. })
        for (const double r : { 1e-3, 1e-6, 1e-12, 0. })
        {
          const Matrix3<double> F = { { { 1.2, 0., 0. },
                                        { 0., 0.6 + r * std::cos(angle), r * std::sin(angle) },
                                        { 0., r * std::sin(angle), -0.6 } } };
          const Matrix3<double> P = force(F, A);
          EXPECT_LT(std::sqrt(contract(P, P)), 20.);
          if (r < 1e-5)
          {
            const Matrix3<double> at = { { { 1.2, 0., 0. }, { 0., 0.6, 0. }, { 0., 0., -0.6 } } };
            EXPECT_NEAR(energy(F, A), energy(at, A), 1e-4);
          }
        }
    }
  } // namespace
} // namespace Exemplar::Testing
