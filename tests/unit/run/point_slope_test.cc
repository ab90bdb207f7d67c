// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/adjoint/slope_of_points.h>

#include "matrices.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    const Material flesh(MaterialParameters(), { 0 });

    const PointScene scene = { { flesh, flesh, ActsOn::all, true }, { 0.8, 0.6 }, 0.5 };

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

    PatchFactors
    random_factors(std::mt19937 &generator)
    {
      std::uniform_real_distribution<double> some(-1e5, 1e5);
      PatchFactors                           factors;
      for (OfPoint::Changing &factor : factors.numbers)
        factor = OfPoint::Changing(some(generator), some(generator));
      return factors;
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
          const PointShape   shape(true, combine(1., F, t, dF), dF);
          const MatrixAlong &S      = shape.get();
          const auto         turned = [&](const double step)
          { return with_turn(combine(1., S.value, step, S.change), T); };
          return shape.derivatives(
              { with_turn(S.value, T), combine(0.5 / h, turned(h), -0.5 / h, turned(-h)) });
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
              return contract(T, shape.get().value);
            };
            EXPECT_NEAR(at_F.by_dF[i][j], (energy_at(1.) - energy_at(-1.)) / (2. * h), 1e-8);
            EXPECT_NEAR(at_F.by_F[i][j], (after.by_dF[i][j] - before.by_dF[i][j]) / (2. * h), 1e-7);
          }
      }
    }

    /// The derivatives of the slope of a law's potential with the factors of a patch.
    PointSlope
    slope_of(const CellLaw       law,
             const MatrixAlong  &F,
             const MatrixAlong  &wish,
             const PatchFactors &factors,
             const PointScene   &at = scene)
    {
      using Number            = OfPoint::Guarded;
      const MatrixAlong shape = PointShape(true, F.value, F.change).get();
      return slope_at<ElasticPoint>(
          PointPlace<Number>(at, law, 0, changing<Number>(shape.value, shape.change),
                             changing<Number>(wish.value, wish.change), 1.),
          shape.change, wish.change, &factors);
    }

    MatrixAlong
    moved(const MatrixAlong &A, const double t)
    {
      return { combine(1., A.value, t, A.change), A.change };
    }

    // The slope is a.grad Phi, so its derivative by the state along a is a.Phi''.a.
    TEST(PointSlope, ChangesAlongTheDirectionAsItsDerivativesSay)
    {
      std::mt19937 generator(7);
      const double h = 1e-5;
      for (const CellLaw law : { CellLaw::corotational, CellLaw::neo_hookean })
        for (const double size : { 1., 0.05, -0.7 }) // with guards in the last two
          for (int sample = 0; sample < 10; ++sample)
          {
            Matrix3<double> pinch = I;
            pinch[2][2]           = size;
            const MatrixAlong F{ random_F(generator) * pinch, random_matrix(generator) };
            const MatrixAlong wish{ random_strain(generator), random_strain(generator) };
            PatchFactors      factors = random_factors(generator);
            for (OfPoint::Changing &factor : factors.numbers)
              factor.by[0] = 0.;
            const PointSlope found  = slope_of(law, F, wish, factors);
            const auto       slopes = [&](const double t)
            { return slope_of(law, moved(F, t), moved(wish, t), factors).by_volume; };
            const auto derivatives
                = PointShape(true, F.value, F.change).derivatives(found.by_shape);
            const double expected = (slopes(h) - slopes(-h)) / (2. * h);
            const double value    = contract(derivatives.by_F, F.change)
                                 + contract(found.by_wish.change, wish.change);
            EXPECT_NEAR(value, expected, 1e-6 * (std::abs(expected) + 1e6));
          }
    }

    TEST(PointSlope, HasDerivativesByEtaAndByTheBoundOfTheGuard)
    {
      std::mt19937 generator(8);
      const double h         = 1e-5;
      int          n_guarded = 0;
      for (const CellLaw law : { CellLaw::corotational, CellLaw::neo_hookean })
        for (int sample = 0; sample < 10; ++sample)
        {
          Matrix3<double> pinch = I;
          pinch[2][2]           = -0.7;
          const MatrixAlong  F{ random_F(generator) * pinch, random_matrix(generator) };
          const MatrixAlong  wish{ random_strain(generator), random_strain(generator) };
          const PatchFactors factors = random_factors(generator);
          const PointSlope   found   = slope_of(law, F, wish, factors);
          const auto         slopes  = [&](const double bound, const double eta)
          {
            PointScene there = scene;
            there.examples.guard_bound += bound;
            there.examples.importance += eta;
            return slope_of(law, F, wish, factors, there).by_volume;
          };
          const double by_bound  = (slopes(h, 0.) - slopes(-h, 0.)) / (2. * h);
          const double by_eta    = (slopes(0., h) - slopes(0., -h)) / (2. * h);
          const double tolerance = 1e-5 * (std::abs(by_bound) + std::abs(by_eta));
          EXPECT_NEAR(found.by_constants[OfPoint::guard_bound - 1], by_bound, tolerance);
          EXPECT_NEAR(found.by_constants[OfPoint::eta - 1], by_eta, tolerance);
          n_guarded += by_bound != 0.;
        }
      EXPECT_GT(n_guarded, 10);
    }

    // A patch of far stretched cells, so that its guard acts.
    TEST(PatchPotential, DerivativesAreThoseOfItsEnergy)
    {
      const double      h    = 1e-5;
      PatchSums<double> sums = { { { 2., 3., 1.1, 0.7, 12.4, 0.9, 0.3, 0.6, 1.3, 0.8, 9.8 } } };
      for (const bool has_own : { false, true })
        for (const bool is_volumetric : { false, true })
        {
          const PatchScene settings{ 0.5, true, is_volumetric, has_own };
          const auto       found = patch_potential(settings, sums, 0.6);
          for (std::size_t k = 0; k < sums.size; ++k)
          {
            const auto energy = [&](const double step)
            {
              PatchSums<double> there = sums;
              there.numbers[k] += step;
              return patch_potential(settings, there, 0.6).energy;
            };
            EXPECT_NEAR(found.by_sums.numbers[k], (energy(h) - energy(-h)) / (2. * h), 1e-8) << k;
          }
          const auto energy
              = [&](const double eta) { return patch_potential(settings, sums, eta).energy; };
          EXPECT_NEAR(found.by_importance, (energy(0.6 + h) - energy(0.6 - h)) / (2. * h), 1e-8);
        }
    }
  } // namespace
} // namespace Exemplar::Testing
