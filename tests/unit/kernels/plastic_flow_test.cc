// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/plastic_cell.h>
#include <exemplar/kernels/polar_decomposition.h>

#include "matrices.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace Exemplar::Testing
{
  namespace
  {
    using Constants = PlasticConstants<double>;
    using Flow      = PlasticFlow<double>;

    constexpr double root = 0.81649658092772603; // sqrt(2/3)

    /// A flow and what it starts from.
    struct Case
    {
      Constants       constants;
      Matrix3<double> d, p_n;
      double          a_n       = 0.1;
      double          step_size = 0.5;

      Flow
      flow() const
      {
        return { constants, d, p_n, a_n, step_size };
      }

      double
      energy(const Matrix3<double> &p) const
      {
        const Matrix3<double> e = combine(1., d, -1., p), change = combine(1., p, -1., p_n);
        const double          g = norm(change), a = a_n + root * g;
        return constants.mu * contract(e, e) + constants.kinematic / 3. * contract(p, p)
               + 0.5 * constants.isotropic * a * a + root * constants.yield_stress * g
               + 0.5 * constants.viscosity / step_size * g * g;
      }

      double
      maximum() const
      {
        return constants.greatest / root;
      }
    };

    Matrix3<double>
    random_deviator(std::mt19937 &generator)
    {
      return deviator(symmetric_part(random_matrix(generator)));
    }

    Matrix3<double>
    scaled(const double factor, const Matrix3<double> &A)
    {
      return combine(factor, A, 0., A);
    }

    /// With and without hardening and viscosity, strained little and much beyond the bound, also from it.
    std::vector<Case>
    cases()
    {
      std::mt19937      generator(3);
      std::vector<Case> all;
      for (const double hardening : { 0., 0.3 })
        for (const double viscosity : { 0., 0.2 })
          for (const double strain : { 0.02, 0.2, 1. })
            for (const double before : { 0., 0.5, 1. })
              for (const bool is_radial : { false, true })
              {
                Case one{ { { 0.4, 0.7 }, 0.1, hardening, 0.7 * hardening, viscosity, 0.3 },
                          {},
                          {} };
                one.p_n = random_deviator(generator);
                one.p_n = scaled(before * one.maximum() / norm(one.p_n), one.p_n);
                one.d   = scaled(strain, random_deviator(generator));
                if (is_radial)
                  one.d = combine(0.1, one.d, 2., one.p_n);
                all.push_back(one);
              }
      return all;
    }

    TEST(PlasticFlow, IsTheMinimumOfItsEnergy)
    {
      std::mt19937 generator(4);
      unsigned int n_flowing = 0, n_at_bound = 0;
      for (const Case &one : cases())
      {
        const Matrix3<double> p = one.flow().strain();
        n_flowing += max_difference(p, one.p_n) > 0.;
        n_at_bound += norm(p) > (1. - 1e-12) * one.maximum();
        EXPECT_LE(norm(p), (1. + 1e-13) * one.maximum());
        EXPECT_NEAR(trace(p), 0., 1e-15);
        const double least = one.energy(p);
        for (const double size : { 1e-6, 1e-4, 1e-2, 0.3 })
          for (int sample = 0; sample < 50; ++sample)
          {
            Matrix3<double> other = combine(1., p, size, random_deviator(generator));
            if (const double length = norm(other); length > one.maximum())
              other = scaled(one.maximum() / length, other);
            EXPECT_GE(one.energy(other), least - 1e-15);
          }
        EXPECT_GE(one.energy(one.p_n), least);
      }
      EXPECT_GT(n_flowing, 30u);
      EXPECT_GT(n_at_bound, 20u);
    }

    TEST(PlasticFlow, ResponseIsItsDerivativeSymmetricAndBetweenZeroAndOne)
    {
      std::mt19937 generator(5);
      for (const Case &one : cases())
      {
        const Flow            flow = one.flow();
        const Matrix3<double> u = random_deviator(generator), v = random_deviator(generator);
        const Matrix3<double> of_u = flow.response(u);
        const auto            at   = [&](const double h)
        {
          Case moved = one;
          moved.d    = combine(1., one.d, h, u);
          return moved.flow().strain();
        };
        const double    h = 1e-5;
        Matrix3<double> difference
            = combine(8. / (12. * h), combine(1., at(h), -1., at(-h)), -1. / (12. * h),
                      combine(1., at(2. * h), -1., at(-2. * h)));
        EXPECT_LT(max_difference(of_u, difference), 1e-8);
        EXPECT_NEAR(contract(of_u, v), contract(flow.response(v), u), 1e-13);
        EXPECT_GE(contract(of_u, u), -1e-15);
        EXPECT_LE(contract(of_u, u), contract(u, u));
      }
    }

    // With the flow g = |p - p_n| heat is what the yield stress and the viscosity resist with, times it; the potential, of which
    // the flow minimises the sum with the energy, is the integral of that.
    TEST(PlasticFlow, HeatIsTheResistanceTimesTheFlow)
    {
      unsigned int n_flowing = 0;
      for (const Case &one : cases())
      {
        const Flow   flow = one.flow();
        const double g    = norm(combine(1., flow.strain(), -1., one.p_n));
        const double v    = one.constants.viscosity / one.step_size;
        EXPECT_NEAR(flow.dissipation(), (root * one.constants.yield_stress + v * g) * g, 1e-14);
        EXPECT_NEAR(flow.dissipation_potential(), flow.dissipation() - 0.5 * v * g * g, 1e-14);
        n_flowing += g > 0. && v > 0.;
      }
      EXPECT_GT(n_flowing, 10u);
    }

    TEST(PlasticFlow, NothingFlowsBetweenSteps)
    {
      for (Case one : cases())
      {
        one.step_size = 0.;
        EXPECT_EQ(max_difference(one.flow().strain(), one.p_n), 0.);
        EXPECT_EQ(one.flow().accumulated(), one.a_n);
        EXPECT_EQ(max_difference(one.flow().response(one.d), {}), 0.);
      }
    }

    TEST(PlasticFlow, YieldsWhereTheStressOfVonMisesReachesTheYieldStress)
    {
      // 2 mu d: pure shear tau = sigma_y / sqrt(3)
      const double mu = 0.7, yield = 0.1, d = yield / std::sqrt(3.) / (2. * mu);
      for (const double factor : { 1. - 1e-12, 1. + 1e-12 })
      {
        Case one{ { { 0.4, mu }, yield, 0., 0., 0., 0.9 }, {}, {}, 0., 1. };
        one.d[0][1] = one.d[1][0] = factor * d;
        EXPECT_EQ(one.flow().accumulated() > 0., factor > 1.);
      }
    }

    TEST(PlasticFlow, ViscosityLetsItGrowByTheExcessOfStress)
    {
      Case one{ { { 0.4, 0.7 }, 0.1, 0.2, 0.3, 0.25, 0.9 }, {}, {} };
      one.d[0][0]              = 0.2;
      one.d[1][1]              = -0.2;
      const Matrix3<double> p  = one.flow().strain();
      const double          a  = one.flow().accumulated();
      const Matrix3<double> xi = combine(2. * 0.7, combine(1., one.d, -1., p), -2. / 3. * 0.2, p);
      EXPECT_NEAR(norm(p) / one.step_size, (norm(xi) - root * (0.1 + 0.3 * a)) / 0.25, 1e-14);
    }

    // Examples see all of the strain: with all of the body's share a cell yields as without them.
    TEST(PlasticCell, YieldsWhateverTheImportanceOfExamplesIs)
    {
      const Constants       constants = { { 0.4, 0.7 }, 0.1, 0.2, 0.3, 0., 0.9 };
      const Matrix3<double> F         = { { { 1.4, 0.2, 0. }, { 0., 0.9, 0.1 }, { 0., 0., 0.9 } } };
      std::vector<double>   strains, works;
      for (const double importance : { 0., 0.5, 0.8 })
      {
        PlasticCell<double> cell(constants, closest_rotation(F), F, { 0.8, importance });
        cell.remember([](std::size_t) { return 0.; }, 1.);
        strains.push_back(cell.new_history(PlasticCell<double>::traits.plastic_strain));
        works.push_back(cell.new_history(PlasticCell<double>::traits.dissipated)
                        / (1. - importance));
      }
      EXPECT_GT(strains[0], 0.1);
      EXPECT_EQ(strains[1], strains[0]);
      EXPECT_EQ(strains[2], strains[0]);
      EXPECT_NEAR(works[1], works[0], 1e-15);
      EXPECT_NEAR(works[2], works[0], 1e-15);
    }

    // A cell may wish for the greatest plastic strain that a scene can ask for: it is free of stress there.
    TEST(PlasticCell, NoGuardActsAtTheStrainThatItKeeps)
    {
      const double m = 0.95;
      for (const double angle : { 0., 0.2, 0.5, 0.8, 1.04719755 })
      {
        // eigenvalues of a deviator of |p| = m / root, from tension to compression
        Matrix3<double> F{};
        for (int i = 0; i < 3; ++i)
          F[i][i] = 1. + m * std::cos(angle + 2. * M_PI / 3. * i);
        const Constants     constants = { { 10., 0.7 }, 0.1, 0., 0., 0., m };
        PlasticCell<double> cell(constants, identity_matrix<double>(), F, ExampleConstants());
        cell.remember([&](const std::size_t k) { return k < 2 ? F[k][k] - 1. : 0.; },
                      std::numeric_limits<double>::infinity());
        cell.set_target({});
        EXPECT_NEAR(norm(cell.force()), 0., 1e-13);
        EXPECT_NEAR(cell.energy({}), 0., 1e-13);
        EXPECT_FALSE(cell.is_guarded());
        EXPECT_FALSE(cell.is_stretched());
        EXPECT_GT(cell.product_of_sums(), NearKink<double>::y_0 * contract(F, F));
        EXPECT_LT(contract(F, F), 5.); // the least bound of Eq. (26)
      }
    }
  } // namespace
} // namespace Exemplar::Testing
