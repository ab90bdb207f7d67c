// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/corotational_cell.h>

#include "matrices.h"

#include <gtest/gtest.h>

#include <random>

namespace Exemplar::Testing
{
  namespace
  {
    using Cell = CorotationalCell<double>;

    const CellMaterial<double> rubber = { 1.3, 0.7 };
    const double               nu     = rubber.lambda / (2. * (rubber.lambda + rubber.mu));

    Cell
    cell_at(const Matrix3<double> &F, const CellMaterial<double> &material = rubber)
    {
      return Cell(material, closest_rotation(F), F, ExampleConstants());
    }

    Matrix3<double>
    diagonal(const double a, const double b, const double c)
    {
      return { { { a, 0., 0. }, { 0., b, 0. }, { 0., 0., c } } };
    }

    Matrix3<double>
    times(const double factor, const Matrix3<double> &F)
    {
      return combine(factor, F, 0., F);
    }

    double
    energy(const Matrix3<double> &F)
    {
      const Cell cell = cell_at(F);
      return cell.energy({}) + (cell.is_stretched() ? cell.stretch().energy() : 0.);
    }

    TEST(StretchGuard, BeginsAtItsBound)
    {
      // |F| = 1 + 0.8/nu
      const double bound = 1. + 0.8 / nu;
      for (const double flatness : { 0., 0.01, 0.1, 0.5, 1. })
        for (const double mirrored : { 1., -1. })
        {
          Matrix3<double> F    = diagonal(1., flatness, mirrored * flatness);
          const double    norm = std::sqrt(contract(F, F));
          EXPECT_FALSE(cell_at(times((1. - 1e-9) * bound / norm, F)).is_stretched());
          EXPECT_EQ(cell_at(times((1. + 1e-9) * bound / norm, F)).is_stretched(),
                    mirrored < 0. || flatness < 0.05)
              << flatness;
        }
    }

    TEST(StretchGuard, NoMinimumOfTheEnergyIsAtTheKink)
    {
      // from S = diag(s_1, s, -s) the energy falls to both sides, as s_2 + s_3 grows from 0
      const auto energy_at = [](const double s_1, const double s, const double sum)
      { return energy(diagonal(s_1, s + sum, -s)); };
      for (const double pull : { 1.01, 1.5, 4., 10., 100. })
        for (const double s : { 0., 0.1, 0.5 })
        {
          const double s_1 = pull * (1. + 1. / nu);
          EXPECT_LT(energy_at(s_1, s, 1e-4), energy_at(s_1, s, 0.)) << s_1 << ' ' << s;
          // which without the guard it would not
          const Cell at   = cell_at(diagonal(s_1, s, -s)),
                     next = cell_at(diagonal(s_1, s + 1e-6, -s));
          EXPECT_TRUE(s > 0. || next.energy({}) > at.energy({}));
        }
    }

    // The loops ask for the energy first, which is cheaper.
    TEST(StretchGuard, ActsOnlyWhereTheEnergyIsHigh)
    {
      std::mt19937                           generator(8);
      std::uniform_real_distribution<double> number(-1., 1.);
      unsigned int                           n_stretched = 0;
      for (const double ratio : { -0.9, 0.01, 0.2, 0.3, 0.45, 0.49, 0.4999 })
      {
        const CellMaterial<double> material{ 2. * ratio / (1. - 2. * ratio), 1. };
        for (unsigned int i = 0; i < 2000; ++i)
        {
          Matrix3<double> F;
          for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
              F[j][k] = 3. * number(generator);
          const Cell            cell = cell_at(F, material);
          const Matrix3<double> T    = stress(material, cell.strain());
          if (!cell.is_stretched())
            continue;
          ++n_stretched;
          EXPECT_TRUE(cell.may_be_stretched(0.5 * contract(T, cell.strain()))) << ratio;
        }
      }
      EXPECT_GT(n_stretched, 100u);
    }
  } // namespace
} // namespace Exemplar::Testing
