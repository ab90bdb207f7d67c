// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/cell_model.h>
#include <exemplar/kernels/law_functions.h>

#include "matrices.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace Exemplar::Testing::AtPoints
{
  namespace
  {
    const ExampleConstants examples = { 0.8, 0.6 };

    /// Number k of the constants of a law: positive, with a C that is positive definite.
    template <typename Constants>
    double
    constant(const std::size_t k)
    {
      const std::array<double, 2> lambda_and_mu = { 1.3, 0.7 };
      if (k < lambda_and_mu.size())
        return lambda_and_mu[k];
      if constexpr (Constants::n_numbers == Anisotropic<double>::n_numbers)
        for (const std::size_t diagonal : { 3, 9, 14, 18, 21, 23 })
          if (k == diagonal)
            return 1.5;
      if constexpr (std::is_same_v<Constants, Anisotropic<double>>)
        return 0.2 * std::cos(0.3 * k);
      const std::array<double, 4> fibres = { 1.7, 0.48, 0.6, -0.64 };
      return Constants::is_isotropic || k + 4 < Constants::n_numbers
                 ? 0.2
                 : fibres[k + 4 - Constants::n_numbers];
    }

    /// A point of a law that is deformed, driven and damped, and remembers.
    class DrivenPoint
    {
    public:
      DrivenPoint(const CellLaw law, const bool with_damping)
          : law(law), functions(law_functions<double>(law)),
            constants(functions.n_constants * batch_size), history(max_history * batch_size)
      {
        with_cell_model<double>(law,
                                [&](auto model)
                                {
                                  for (std::size_t k = 0; k < functions.n_constants; ++k)
                                    constants[k * batch_size]
                                        = constant<typename decltype(model)::type::Constants>(k);
                                });
        for (std::size_t k = 0; k < max_history; ++k)
          history[k * batch_size] = 0.03 * std::sin(1. + k);
        in.constants  = constants.data();
        in.history    = history.data();
        in.examples   = examples;
        in.step_size  = 0.5;
        in.has_target = true;
        std::mt19937          generator(3);
        const Matrix3<double> E = symmetric_part(random_matrix(generator));
        in.target               = combine(0.1, E, 0., E);
        in.is_damped            = with_damping;
        if (with_damping)
        {
          in.damping = 0.3;
          in.past    = combine(0.05, symmetric_part(random_matrix(generator)), 0., E);
        }
      }

      const LawInput<double> &
      at(const Matrix3<double> &F)
      {
        in.R = traits_of(law).has_rotations && law != CellLaw::frozen ? closest_rotation(F)
                                                                      : identity_matrix<double>();
        in.F = F;
        return in;
      }

      LawValue<double>
      value(const Matrix3<double> &F, const bool with_weight_stress = false)
      {
        LawValue<double> out{};
        functions.evaluate(at(F), with_weight_stress, out);
        return out;
      }

      double
      energy(const Matrix3<double> &F)
      {
        const LawValue<double> out = value(F);
        return out.energy + out.damping;
      }

      Matrix3<double>
      force(const Matrix3<double> &F)
      {
        const Matrix3<double> P = value(F).P;
        return in.R * P;
      }

      const CellLaw               law;
      const LawFunctions<double> &functions;
      LawInput<double>            in;
      std::vector<double>         constants;

    private:
      std::vector<double> history;
    };

    Matrix3<double>
    moved(const Matrix3<double> &A, const double h, const Matrix3<double> &B)
    {
      return combine(1., A, h, B);
    }

    /// Fourth-order central difference at 0.
    template <typename Function>
    Matrix3<double>
    derivative(const Function &f, const double h)
    {
      const Matrix3<double> near = combine(8. / (12. * h), f(h), -8. / (12. * h), f(-h)),
                            far  = combine(1. / (12. * h), f(2. * h), -1. / (12. * h), f(-2. * h));
      return combine(1., near, -1., far);
    }

    /// A number as a matrix, for derivative().
    Matrix3<double>
    in_matrix(const double number)
    {
      Matrix3<double> M{};
      M[0][0] = number;
      return M;
    }

    class LawFunctionsTest : public testing::TestWithParam<std::tuple<std::size_t, bool>>
    {
    protected:
      DrivenPoint  point{ static_cast<CellLaw>(std::get<0>(GetParam())), std::get<1>(GetParam()) };
      std::mt19937 generator{ 5 };
      const Matrix3<double> F
          = combine(1., rotation_about({ { 1., 2., -1. } }, 0.8), 0.15, random_matrix(generator));

      /// Fixed rotations have no energy whose gradient the forces are.
      bool
      has_energy() const
      {
        return point.law != CellLaw::frozen;
      }
    };

    TEST_P(LawFunctionsTest, ForcesAreTheGradientOfEnergyAndDamping)
    {
      if (!has_energy())
        GTEST_SKIP();
      const Matrix3<double> P = point.force(F);
      for (int sample = 0; sample < 4; ++sample)
      {
        const Matrix3<double> dF = random_matrix(generator);
        EXPECT_NEAR(contract(P, dF),
                    derivative([&](const double h)
                               { return in_matrix(point.energy(moved(F, h, dF))); },
                               1e-4)[0][0],
                    1e-8);
      }
    }

    TEST_P(LawFunctionsTest, ThePressureActsAlongTheRotation)
    {
      const Matrix3<double> without = point.value(F).P;
      point.in.has_pressure         = true;
      point.in.pressure             = 0.4;
      Matrix3<double> expected      = without;
      if (traits_of(point.law).trace_gradient_is_R)
        for (int i = 0; i < 3; ++i)
          expected[i][i] += 0.4;
      EXPECT_LT(max_difference(point.value(F).P, expected), 1e-15);
    }

    TEST_P(LawFunctionsTest, TheExactTangentIsTheDerivativeOfForces)
    {
      if (!has_energy())
        GTEST_SKIP();
      LawTangent<double> tangent;
      for (int sample = 0; sample < 4; ++sample)
      {
        const Matrix3<double> dF = random_matrix(generator);
        point.functions.tangent(point.at(F), false, tangent);
        const Matrix3<double> R        = point.in.R;
        const Matrix3<double> response = R * tangent.response(transpose_times(R, dF));
        EXPECT_LT(max_difference(response, derivative([&](const double h)
                                                      { return point.force(moved(F, h, dF)); },
                                                      1e-4)),
                  1e-7);
      }
    }

    TEST_P(LawFunctionsTest, SlopesAreThoseOfTheEnergyAndHaveTheirDerivatives)
    {
      if (point.functions.slope == nullptr || point.in.is_damped)
        GTEST_SKIP();
      LawChange<double> change{ random_matrix(generator),
                                symmetric_part(random_matrix(generator)) };
      const auto        slope_at = [&](const Matrix3<double> &there)
      {
        LawSlope<double> slope;
        point.functions.slope(point.at(there), change, slope);
        return slope;
      };
      const LawSlope<double> found = slope_at(F);
      EXPECT_FALSE(found.is_guarded);
      const Matrix3<double> D = point.in.target, E = symmetric_part(random_matrix(generator)),
                            M = random_matrix(generator);
      const double expected   = derivative(
          [&](const double h)
          {
            point.in.target = moved(D, h, change.target);
            return in_matrix(point.energy(moved(F, h, change.F)));
          },
          1e-4)[0][0];
      point.in.target = D;
      EXPECT_NEAR(found.value, expected, 1e-8);
      // `set` moves one of the variables by h, and back for 0
      const auto by = [&](const auto &set)
      {
        const double slope = derivative(
            [&](const double h)
            {
              set(h);
              return in_matrix(slope_at(F).value);
            },
            1e-4)[0][0];
        set(0.);
        return slope;
      };
      EXPECT_NEAR(contract(found.by_F, M),
                  derivative([&](const double h)
                             { return in_matrix(slope_at(moved(F, h, M)).value); },
                             1e-4)[0][0],
                  1e-8);
      const LawChange<double> at = change;
      EXPECT_NEAR(contract(found.by_change_of_F, M),
                  by([&](const double h) { change.F = moved(at.F, h, M); }), 1e-8);
      EXPECT_NEAR(contract(found.by_target, E),
                  by([&](const double h) { point.in.target = moved(D, h, E); }), 1e-8);
      EXPECT_NEAR(contract(found.by_change_of_target, E),
                  by([&](const double h) { change.target = moved(at.target, h, E); }), 1e-8);
      for (std::size_t k = 0; k < LawSlope<double>::n_constants; ++k)
      {
        const double constant = point.constants[k * batch_size];
        EXPECT_NEAR(found.by_constants[k],
                    by([&](const double h) { point.constants[k * batch_size] = constant + h; }),
                    1e-8);
      }
      EXPECT_NEAR(
          found.by_importance,
          by([&](const double h) { point.in.examples.importance = examples.importance + h; }),
          1e-8);
      point.in.has_target          = false;
      point.in.target              = {};
      point.in.examples.importance = 0.;
      LawSlope<double> slope;
      point.functions.slope(point.at(F), change, slope);
      const Matrix3<double> P = point.force(F);
      EXPECT_NEAR(slope.value, contract(P, change.F), 1e-12);
      EXPECT_EQ(contract(slope.by_target, slope.by_target), 0.);
    }

    // psi + p tr e + q tr D, whose p and q change along the direction
    TEST_P(LawFunctionsTest, SlopesHaveTheTermsOfPressuresAndTheirDerivatives)
    {
      if (point.functions.slope == nullptr || point.in.is_damped
          || !traits_of(point.law).trace_gradient_is_R)
        GTEST_SKIP();
      LawChange<double> change{ random_matrix(generator), symmetric_part(random_matrix(generator)),
                                0.7, -0.3, 0.9 };
      point.in.pressure   = 0.4;
      const auto slope_at = [&](const Matrix3<double> &there, const bool has_pressure)
      {
        LawSlope<double> slope;
        point.in.has_pressure = has_pressure;
        point.functions.slope(point.at(there), change, slope);
        return slope;
      };
      const Matrix3<double> D = point.in.target, E = symmetric_part(random_matrix(generator)),
                            M        = random_matrix(generator);
      const LawSlope<double> without = slope_at(F, false), found = slope_at(F, true);
      const auto             of_trace = [&](const Matrix3<double> &there)
      { return trace(model_strain(point.law, model_rotation(point.law, there), there)); };
      // what pressures add to the slope at places F + h M and D + h E, along dF and dD
      const auto added = [&](const Matrix3<double> &there, const Matrix3<double> &target)
      {
        return derivative(
            [&](const double h)
            {
              return in_matrix((0.4 + 0.7 * h) * of_trace(moved(there, h, change.F))
                               + (-0.3 + 0.9 * h) * trace(moved(target, h, change.target)));
            },
            1e-3)[0][0];
      };
      EXPECT_NEAR(found.value - without.value, added(F, D), 1e-9);
      EXPECT_NEAR(contract(found.by_F, M) - contract(without.by_F, M),
                  derivative([&](const double h) { return in_matrix(added(moved(F, h, M), D)); },
                             1e-3)[0][0],
                  1e-7);
      EXPECT_NEAR(contract(found.by_target, E) - contract(without.by_target, E),
                  derivative([&](const double h) { return in_matrix(added(F, moved(D, h, E))); },
                             1e-3)[0][0],
                  1e-7);
      const auto along = [&](const Matrix3<double> &dF, const Matrix3<double> &dD)
      {
        change.F      = dF;
        change.target = dD;
        return slope_at(F, true).value - slope_at(F, false).value;
      };
      const Matrix3<double> dF = change.F, dD = change.target;
      EXPECT_NEAR(contract(found.by_change_of_F, M) - contract(without.by_change_of_F, M),
                  along(moved(dF, 1., M), dD) - along(dF, dD), 1e-12);
      EXPECT_NEAR(contract(found.by_change_of_target, E) - contract(without.by_change_of_target, E),
                  along(dF, moved(dD, 1., E)) - along(dF, dD), 1e-12);
      for (std::size_t k = 0; k < LawSlope<double>::n_constants; ++k)
        EXPECT_EQ(found.by_constants[k], without.by_constants[k]);
      EXPECT_EQ(found.by_importance, without.by_importance);
    }

    TEST_P(LawFunctionsTest, AConvexTangentIsNotNegative)
    {
      LawTangent<double> tangent;
      for (int sample = 0; sample < 20; ++sample)
      {
        const Matrix3<double> M = random_matrix(generator);
        point.functions.tangent(point.at(moved(F, 0.3, M)), true, tangent);
        EXPECT_GT(contract(M, tangent.response(M)), -1e-12);
      }
    }

    TEST_P(LawFunctionsTest, WeightStressAndColumnsAreDerivativesByTheTarget)
    {
      const Matrix3<double> E = symmetric_part(random_matrix(generator)), D = point.in.target;
      const auto            at     = [&](const double h) { point.in.target = moved(D, h, E); };
      const double          change = derivative(
          [&](const double h)
          {
            at(h);
            return in_matrix(point.energy(F));
          },
          1e-3)[0][0];
      const Matrix3<double> force_change = derivative(
          [&](const double h)
          {
            at(h);
            return point.value(F).P;
          },
          1e-3);
      at(0.);
      EXPECT_NEAR(-contract(point.value(F, true).weight_stress, E), change, 1e-9);
      Matrix3<double> column;
      point.functions.columns(point.at(F), false, 1, &E, &column);
      EXPECT_LT(max_difference(times(-1., column), force_change), 1e-9);
    }

    TEST_P(LawFunctionsTest, TheEnergyTowardsATargetHasThatStress)
    {
      if (traits_of(point.law).has_guard) // whose energy depends on the strain, too
        point.in.examples.guard_bound = 0.;
      const Matrix3<double> dT = point.functions.stress(point.at(F));
      EXPECT_LT(max_difference(dT, symmetric_part(dT)), 1e-14);
      if (!traits_of(point.law).has_volumetric_energy && traits_of(point.law).n_history == 0)
      {
        // psi is quadratic in the target: at -D, 0 and D the mixed part is -T(e, 0):D
        const Matrix3<double> D    = point.in.target;
        const double          with = point.value(F).energy;
        point.in.target            = times(-1., D);
        const double opposite      = point.value(F).energy;
        point.in.target            = Matrix3<double>{};
        EXPECT_NEAR(0.5 * (opposite - with), contract(point.functions.stress(point.at(F)), D),
                    1e-12);
      }
    }

    TEST_P(LawFunctionsTest, HistoryStaysWithoutAStepAndIsRememberedAfterOne)
    {
      const std::size_t n = traits_of(point.law).n_history;
      if (n == 0)
        GTEST_SKIP();
      std::array<double, max_history> next{};
      point.functions.advance(point.at(F), next.data());
      double change = 0.;
      for (std::size_t k = 0; k < n; ++k)
        change = std::max(change, std::abs(next[k] - point.in.history[k * batch_size]));
      EXPECT_GT(change, 1e-3);
      point.in.step_size = 0.;
      point.functions.advance(point.at(F), next.data());
      for (std::size_t k = 0; k < n && traits_of(point.law).name != std::string("viscoelastic");
           ++k)
        EXPECT_NEAR(next[k], point.in.history[k * batch_size], 1e-15);
    }

    INSTANTIATE_TEST_SUITE_P(
        AllLaws,
        LawFunctionsTest,
        testing::Combine(testing::Range<std::size_t>(0, std::tuple_size_v<CellLaws<double>>),
                         testing::Bool()));
  } // namespace
} // namespace Exemplar::Testing::AtPoints
