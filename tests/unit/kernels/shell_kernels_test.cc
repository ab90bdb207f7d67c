// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/hinge_angle.h>
#include <exemplar/kernels/membrane_strain.h>

#include <gtest/gtest.h>

#include <random>

namespace Exemplar::Testing
{
  namespace
  {
    using Long = long double; // so that differences have more digits than what they check

    using LongVector = Vector3<Long>;

    template <std::size_t n>
    std::array<LongVector, n>
    random_vectors(const unsigned int seed)
    {
      std::mt19937                     engine(seed);
      std::uniform_real_distribution<> random(-1., 1.);
      std::array<LongVector, n>        result;
      for (LongVector &x : result)
        for (int c = 0; c < 3; ++c)
          x[c] = random(engine);
      return result;
    }

    using HingePlaces = std::array<LongVector, 4>;

    /// A hinge without needles.
    HingePlaces
    random_hinge(const unsigned int seed)
    {
      HingePlaces x = random_vectors<4>(seed);
      for (LongVector &vertex : x)
        vertex = times(Long(0.3), vertex);
      x[1][0] += 1.;
      x[2][0] += 0.4;
      x[2][1] += 1.;
      x[3][0] += 0.6;
      x[3][1] -= 1.;
      return x;
    }

    HingeAngle<Long>
    angle_of(const HingePlaces &x)
    {
      return { x[0], x[1], x[2], x[3] };
    }

    constexpr Long step = 1e-6L;

    /// Central difference of f(vectors) by component c of vector i.
    template <typename Vectors, typename Function>
    auto
    slope(Vectors x, const int i, const int c, const Function &f)
    {
      const Long at = x[i][c];
      x[i][c]       = at + step;
      const auto up = f(x);
      x[i][c]       = at - step;
      return (up - f(x)) / (2. * step);
    }

    TEST(HingeAngle, IsKnownForFoldsOfUnitSquares)
    {
      const Long pi = std::acos(Long(-1.));
      for (const Long angle : { -3.1, -2., -0.5, 0., 1e-9, 1., 3. })
      {
        const LongVector down{ { 0., -std::cos(angle), -std::sin(angle) } };
        EXPECT_NEAR(
            angle_of({ { { { 0., 0., 0. } }, { { 1., 0., 0. } }, { { 0.3, 1., 0. } }, down } })
                .value(),
            angle, 1e-17);
      }
      EXPECT_NEAR(angle_of({ { { { 0., 0., 0. } },
                               { { 1., 0., 0. } },
                               { { 0.3, 1., 0. } },
                               { { 0.1, 1., 0. } } } })
                      .value(),
                  pi, 1e-17);
    }

    TEST(HingeAngle, HasTheDerivativesOfDifferences)
    {
      for (const unsigned int seed : { 1, 2, 3, 4 })
      {
        const HingePlaces     x        = random_hinge(seed);
        const HingeForm<Long> gradient = angle_of(x).gradient();
        for (int i = 0; i < 4; ++i)
          for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(gradient[i][c],
                        slope(x, i, c, [](const auto &at) { return angle_of(at).value(); }), 1e-11);
        for (int i = 0; i < 4; ++i)
          for (int c = 0; c < 3; ++c)
            for (int j = 0; j < 4; ++j)
              for (int d = 0; d < 3; ++d)
              {
                Long sum = 0.;
                for (const HingeProduct<Long> &of : angle_of(x).hessian())
                  sum += of.factor * (of.a[i][c] * of.b[j][d] + of.b[i][c] * of.a[j][d]);
                EXPECT_NEAR(
                    sum,
                    slope(x, j, d, [&](const auto &at) { return angle_of(at).gradient()[i][c]; }),
                    1e-10);
              }
      }
    }

    using Columns = std::array<LongVector, 2>;

    const Symmetric2<Long> N = { { 1.3, -0.4, 0.7 } };

    /// N : U.
    Long
    stretched(const Columns &F)
    {
      Symmetric2<Long> U = MembraneStrain<Long>(F[0], F[1]).strain();
      U[0] += 1.;
      U[1] += 1.;
      return contract(N, U);
    }

    Columns
    random_columns(const unsigned int seed)
    {
      Columns F = random_vectors<2>(seed);
      for (LongVector &column : F)
        column = times(Long(0.4), column);
      F[0][0] += 1.;
      F[1][2] += 1.;
      return F;
    }

    TEST(MembraneStrain, IsThatOfTheRootOfFtF)
    {
      const Columns              F = random_columns(1);
      const MembraneStrain<Long> of(F[0], F[1]);
      Symmetric2<Long>           U = of.strain();
      U[0] += 1.;
      U[1] += 1.;
      EXPECT_NEAR(U[0] * U[0] + U[2] * U[2], dot(F[0], F[0]), 1e-17);
      EXPECT_NEAR(U[1] * U[1] + U[2] * U[2], dot(F[1], F[1]), 1e-17);
      EXPECT_NEAR(U[2] * (U[0] + U[1]), dot(F[0], F[1]), 1e-17);
      EXPECT_NEAR(dot(of.axis(0), of.axis(1)), 0., 1e-17);
      EXPECT_NEAR(dot(of.axis(0), of.axis(0)), 1., 1e-17);
      EXPECT_NEAR(of.area_ratio(), U[0] * U[1] - U[2] * U[2], 1e-17);
    }

    TEST(MembraneStrain, HasTheDerivativesOfDifferences)
    {
      for (const unsigned int seed : { 1, 2, 3, 4 })
      {
        const Columns              F = random_columns(seed);
        const MembraneStrain<Long> of(F[0], F[1]);
        const auto                 P        = of.force(N);
        const auto                 geometry = of.geometry(N, false);
        const auto                 change   = [&](const int j, const int c)
        {
          LongVector d{};
          d[c] = 1.;
          return of.change(d, j == 0 ? 1. : 0., j == 1 ? 1. : 0.);
        };
        for (int i = 0; i < 2; ++i)
          for (int c = 0; c < 3; ++c)
          {
            EXPECT_NEAR(P[i][c], slope(F, i, c, stretched), 1e-11);
            for (int k = 0; k < 3; ++k)
              EXPECT_NEAR(change(i, c).dU[k],
                          slope(F, i, c,
                                [&](const Columns &at)
                                { return MembraneStrain<Long>(at[0], at[1]).strain()[k]; }),
                          1e-11);
            for (int j = 0; j < 2; ++j)
              for (int d = 0; d < 3; ++d)
              {
                const auto u = change(i, c), v = change(j, d);
                const Long in_plane
                    = geometry.of_spin * u.spin * v.spin
                      + geometry.of_product * (u.spin * geometry.of(v) + v.spin * geometry.of(u));
                const Long out = of.normal()[c] * of.normal()[d] * geometry.S[i == j ? i : 2];
                EXPECT_NEAR(in_plane + out,
                            slope(F, j, d,
                                  [&](const Columns &at)
                                  { return MembraneStrain<Long>(at[0], at[1]).force(N)[i][c]; }),
                            1e-10);
              }
          }
      }
    }

    TEST(MembraneStrain, HasAConvexGeometryThatIsTheNearestOne)
    {
      for (const unsigned int seed : { 1, 2, 3, 4 })
      {
        const Columns              F = random_columns(seed);
        const MembraneStrain<Long> of(F[0], F[1]);
        const auto                 exact = of.geometry(N, false), convex = of.geometry(N, true);
        const auto                 quadratic
            = [](const MembraneGeometry<Long> &form, const MembraneChange<Long> &change)
        {
          const Long L = form.of(change);
          return form.of_spin * change.spin * change.spin + 2. * form.of_product * change.spin * L
                 + form.of_square * L * L;
        };
        Long least_gap = 1.;
        for (const LongVector &d : random_vectors<40>(seed))
        {
          const auto g      = random_vectors<1>(static_cast<unsigned int>(1000. * d[0] + 2000.))[0];
          const auto change = of.change(d, g[0], g[1]);
          EXPECT_GE(quadratic(convex, change), 0.);
          EXPECT_GE(quadratic(convex, change), quadratic(exact, change) - 1e-15);
          least_gap = std::min(least_gap, quadratic(convex, change) - quadratic(exact, change));
        }
        EXPECT_LT(least_gap, 0.02); // it is the same where that is positive
        EXPECT_GE(convex.S[0] * convex.S[1] - convex.S[2] * convex.S[2], -1e-15);
        EXPECT_GE(convex.S[0] + convex.S[1], 0.);
      }
    }
  } // namespace
} // namespace Exemplar::Testing
