// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_wrapped_operator_h
#define exemplar_wrapped_operator_h

#include <exemplar/algebra/spd_operator.h>

#include <memory>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// Does with the operator of another matrix all but what it inverts: solve(), twin() and keep() are left to whoever derives.
  class WrappedOperator : public SpdOperator
  {
  public:
    OperatorTraits
    traits() const override
    {
      return matrix->traits();
    }

    void
    reinit(const SymmetricPattern &pattern) override
    {
      matrix->reinit(pattern);
    }

    std::vector<double> &
    values() override
    {
      return matrix->values();
    }

    OuterProducts *
    outer_products() override
    {
      return matrix->outer_products();
    }

    UnknownShear *
    shear() override
    {
      return matrix->shear();
    }

    void
    factorize(const Vector &positions) override
    {
      matrix->factorize(positions);
    }

    void
    factorize_roughly(const Vector &positions) override
    {
      matrix->factorize_roughly(positions);
    }

    void
    factorize_near(const Vector &positions) override
    {
      matrix->factorize_near(positions);
    }

    bool
    leans_on_earlier() const override
    {
      return matrix->leans_on_earlier();
    }

    bool
    iterates() const override
    {
      return matrix->iterates();
    }

  protected:
    explicit WrappedOperator(std::unique_ptr<SpdOperator> matrix) : matrix(std::move(matrix)) {}

    const std::unique_ptr<SpdOperator> matrix;
  };
} // namespace Exemplar

#endif
