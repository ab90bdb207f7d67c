// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/adjoint/point_slope.h>

#include "matrices.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    constexpr double importance = 0.6;

    const Material flesh(MaterialParameters(), { 0 });

    const PointMaterial at_cell(flesh, flesh, ActsOn::all, 1., 0);

    const PointScene scene = { { 0.8, importance }, 0.5, 1. };

    const Matrix3<double> I = identity_matrix<double>();

    /// A turned body.
    Matrix3<double>
    random_F(std::mt19937 &generator)
    {
      const Matrix3<double> R = closest_rotation(combine(1., I, 3., random_matrix(generator)));
      return R * combine(1., I, 0.2, random_matrix(generator));
    }

    Matrix3<double>
    random_strain(std::mt19937 &generator)
    {
      return symmetric_part(times(0.2, random_matrix(generator)));
    }

    template <typename Number>
    PointPlace<Number>
    place(const PointShape &shape, const Matrix3<double> &wish, const Matrix3<double> &change)
    {
      const auto constant_of = [](const double value, const std::size_t k)
      { return OfPoint::seeded<Number>(value, 0., k); };
      const Number eta = constant_of(importance, OfPoint::eta);
      return { OfPoint::seeded_shape<Number>(shape),
               OfPoint::seeded_symmetric<Number>(wish, change, OfPoint::wish),
               MaterialFunctions<Number>(
                   at_cell, constant_of(at_cell.body.youngs_modulus, OfPoint::E),
                   constant_of(at_cell.body.poissons_ratio, OfPoint::nu), eta),
               eta };
    }

    PatchFactors
    random_factors(std::mt19937 &generator)
    {
      std::uniform_real_distribution<double> some(-1e5, 1e5);
      PatchFactors                           factors;
      for (HyperDual<0> &factor : factors.numbers)
        factor = HyperDual<0>(some(generator), some(generator));
      return factors;
    }

    void
    expect_equal(const Matrix3<HyperDual<0>> &A, const Matrix3<HyperDual<0>> &B, const double scale)
    {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
        {
          EXPECT_NEAR(A[i][j].value, B[i][j].value, 1e-12 * scale);
          EXPECT_NEAR(A[i][j].change, B[i][j].change, 1e-12 * scale);
        }
    }

    TEST(PointShape, DerivativesAreThoseOfStretches)
    {
      std::mt19937 generator(5);
      const double h = 1e-5;
      for (int sample = 0; sample < 20; ++sample)
      {
        const Matrix3<double> F = random_F(generator), dF = random_matrix(generator),
                              T   = random_strain(generator);
        const auto derivatives_at = [&](const double t)
        {
          const PointShape shape(true, combine(1., F, t, dF), dF);
          return shape.derivatives(with_turn(
              OfPoint::seeded_symmetric<HyperDual<0>>(shape.get_value(), shape.get_change(), 0),
              constant_matrix<HyperDual<0>>(T)));
        };
        const auto at_F = derivatives_at(0.), before = derivatives_at(-h),
                   after = derivatives_at(h);
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
          {
            Matrix3<double> unit{};
            unit[i][j]           = h;
            const auto energy_at = [&](const double sign)
            {
              const PointShape shape(true, combine(1., F, sign, unit), dF);
              return contract(T, shape.get_value());
            };
            EXPECT_NEAR(at_F.by_dF[i][j], (energy_at(1.) - energy_at(-1.)) / (2. * h), 1e-8);
            EXPECT_NEAR(at_F.by_F[i][j], (after.by_dF[i][j] - before.by_dF[i][j]) / (2. * h), 1e-7);
          }
      }
    }

    TEST(RegularPoint, ForcesAreDerivativesOfThePotential)
    {
      using Regular = OfPoint::Regular;
      using Number  = HyperDual<OfPoint::n_with_S>;
      std::mt19937 generator(7);
      for (const CellLaw law : { CellLaw::corotational, CellLaw::neo_hookean })
        for (int sample = 0; sample < 10; ++sample)
        {
          const PointShape      shape(true, random_F(generator), random_matrix(generator));
          const Matrix3<double> wish = random_strain(generator), change = random_strain(generator);
          const PatchFactors    factors = random_factors(generator);
          const FactorsAtPoint  of_patches(&factors, 1);
          const auto            found = regular_point<ElasticPoint>(
              law, scene, place<Regular>(shape, wish, change), 0.7, of_patches);
          ASSERT_TRUE(found);
          const auto potential
              = point_potential<ElasticPoint>(law, scene, place<Number>(shape, wish, change), 0.7,
                                              of_patches)
                    .potential;
          const PointSlope slope = slope_of_stress(shape, { wish, change }, *found);
          const double     scale = 1e7;
          expect_equal(slope.stress.by_shape, OfPoint::by_shape(potential, shape), scale);
          expect_equal(slope.stress.by_wish, OfPoint::by_symmetric(potential, OfPoint::wish),
                       scale);
          EXPECT_NEAR(slope.slope, potential.change, 1e-12 * (scale + std::abs(potential.change)));
          for (std::size_t k = 0; k < OfPoint::n_constants; ++k)
            EXPECT_NEAR(slope.by_constants[k], potential.change_by[k],
                        1e-10 * std::abs(potential.change_by[k]) + 1e-12);
        }
    }
  } // namespace
} // namespace Exemplar::Testing
