// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/touch.h>

namespace Exemplar
{
  namespace
  {
    /// Edges are almost parallel where the square of sin of their angle, at rest lengths, is below this.
    constexpr double parallel = 1e-3;

    dealii::Tensor<2, 3>
    diagonal(const double value)
    {
      dealii::Tensor<2, 3> result;
      for (unsigned int c = 0; c < 3; ++c)
        result[c][c] = value;
      return result;
    }
  } // namespace

  EdgePart
  edge_part(const SpaceVector3 &e,
            const SpaceVector3 &f,
            const double        e_square,
            const double        f_square)
  {
    EdgePart     result;
    const double square = dealii::cross_product_3d(e, f).norm_square();
    const double full   = parallel * e_square * f_square;
    if (!(square < full))
      return result;
    const double                      part = square / full; // p, and m = p (2 - p)
    const double                      e_e = e.norm_square(), f_f = f.norm_square(), e_f = e * f;
    const std::array<SpaceVector3, 2> by{ { 2. / full * (f_f * e - e_f * f),
                                            2. / full * (e_e * f - e_f * e) } };
    std::array<std::array<dealii::Tensor<2, 3>, 2>, 2> twice;
    twice[0][0] = diagonal(f_f) - dealii::outer_product(f, f);
    twice[1][1] = diagonal(e_e) - dealii::outer_product(e, e);
    twice[0][1] = 2. * dealii::outer_product(e, f) - dealii::outer_product(f, e) - diagonal(e_f);
    twice[1][0] = dealii::transpose(twice[0][1]);
    result.m    = part * (2. - part);
    for (unsigned int i = 0; i < 2; ++i)
    {
      result.by[i] = 2. * (1. - part) * by[i];
      for (unsigned int j = 0; j < 2; ++j)
        result.twice[i][j]
            = 4. * (1. - part) / full * twice[i][j] - 2. * dealii::outer_product(by[i], by[j]);
    }
    return result;
  }
} // namespace Exemplar
