// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_single_precision_inverse_h
#define exemplar_single_precision_inverse_h

#include <exemplar/algebra/kept_inverse.h>
#include <exemplar/algebra/single_precision_factor.h>

namespace Exemplar
{
  /// A Cholesky factor that is kept in single precision.
  class SinglePrecisionInverse : public KeptInverse
  {
  public:
    explicit SinglePrecisionInverse(FactorPanels panels);

    void
    apply(std::vector<double> &vector) override;

    double
    cost_in_iterations(std::size_t /*n_columns*/) const override // they cost little
    {
      return relative_cost;
    }

    std::size_t
    memory_consumption() const override;

  private:
    const double          relative_cost;
    SinglePrecisionFactor factor;
    std::vector<float>    right_side;
  };
} // namespace Exemplar

#endif
