// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/wrapped_operator.h>

namespace Exemplar
{
  namespace
  {
    class ShearedInverse : public KeptInverse
    {
    public:
      ShearedInverse(std::unique_ptr<KeptInverse> inverse, const UnknownShear &shear)
          : inverse(std::move(inverse)), shear(shear)
      {
      }

      void
      apply(std::vector<double> &vector) override
      {
        shear.forces_to_sheared(vector.data());
        inverse->apply(vector);
        shear.from_sheared(vector.data());
      }

      std::unique_ptr<InverseEntries>
      entries() const override
      {
        return inverse->entries(); // of unknowns that stay they are the same
      }

      double
      cost_in_iterations(const std::size_t n_columns) const override
      {
        return inverse->cost_in_iterations(n_columns);
      }

      std::size_t
      memory_consumption() const override
      {
        return inverse->memory_consumption() + shear.memory_consumption();
      }

    private:
      const std::unique_ptr<KeptInverse> inverse;
      const UnknownShear                 shear;
    };

    class ShearedOperator : public WrappedOperator
    {
    public:
      ShearedOperator(std::unique_ptr<SpdOperator> matrix, const std::size_t n)
          : WrappedOperator(std::move(matrix)), n(n)
      {
      }

      OperatorTraits
      traits() const override
      {
        OperatorTraits traits = matrix->traits();
        traits.bytes += of_unknowns.memory_consumption();
        return traits;
      }

      UnknownShear *
      shear() override
      {
        return &of_unknowns;
      }

      void
      solve(std::vector<double> &columns, const double accuracy) override
      {
        for (std::size_t begin = 0; begin < columns.size(); begin += n)
          of_unknowns.forces_to_sheared(columns.data() + begin);
        matrix->solve(columns, accuracy);
        for (std::size_t begin = 0; begin < columns.size(); begin += n)
          of_unknowns.from_sheared(columns.data() + begin);
      }

      std::unique_ptr<SpdOperator>
      twin() const override
      {
        std::unique_ptr<SpdOperator> other = matrix->twin();
        return other == nullptr ? nullptr : make_sheared_operator(std::move(other), n);
      }

      std::unique_ptr<KeptInverse>
      keep() const override
      {
        return std::make_unique<ShearedInverse>(matrix->keep(), of_unknowns);
      }

    private:
      const std::size_t n;
      UnknownShear      of_unknowns;
    };
  } // namespace

  std::unique_ptr<SpdOperator>
  make_sheared_operator(std::unique_ptr<SpdOperator> matrix, const std::size_t n)
  {
    return std::make_unique<ShearedOperator>(std::move(matrix), n);
  }
} // namespace Exemplar
