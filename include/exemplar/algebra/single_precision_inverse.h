// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_single_precision_inverse_h
#define exemplar_single_precision_inverse_h

#include <exemplar/algebra/factor_columns.h>
#include <exemplar/algebra/kept_inverse.h>
#include <exemplar/algebra/multifrontal_factor.h>

#include <memory>

namespace Exemplar
{
  /// Overwrite columns C by an approximation of A^-1 C, by a factor in single precision.
  void
  apply_in_single_precision(MultifrontalFactor<float> &factor, std::vector<double> &columns);

  /// A Cholesky factor in single precision as an approximate inverse: solving costs a third of that
  /// in double precision.
  class SinglePrecisionInverse : public KeptInverse
  {
  public:
    explicit SinglePrecisionInverse(std::shared_ptr<MultifrontalFactor<float>> factor)
        : factor(std::move(factor))
    {
    }

    void
    apply(std::vector<double> &vector) override
    {
      apply_in_single_precision(*factor, vector);
    }

    std::unique_ptr<InverseEntries>
    entries() const override
    {
      return std::make_unique<FactorColumns>(factor);
    }

    double
    cost_in_iterations(std::size_t n_columns) const override;

    std::size_t
    memory_consumption() const override
    {
      return factor->memory_consumption();
    }

  private:
    const std::shared_ptr<MultifrontalFactor<float>> factor;
  };
} // namespace Exemplar

#endif
