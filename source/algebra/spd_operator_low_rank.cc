// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/wrapped_operator.h>

#include <deal.II/base/memory_consumption.h>
#include <deal.II/lac/full_matrix.h>

#include <numeric>

namespace Exemplar
{
  namespace
  {
    /// (A + U F U^T)^-1 = A^-1 - Z S^-1 Z^T with Z = A^-1 U and S = F^-1 + U^T Z.
    class Correction
    {
    public:
      Correction() = default;

      /// `columns` are U, and `inverse_columns` Z.
      Correction(const std::vector<double> &factors,
                 const std::vector<double> &columns,
                 std::vector<double>        inverse_columns)
          : n(factors.empty() ? 0 : columns.size() / factors.size()), Z(std::move(inverse_columns)),
            inverse_of_S(factors.size(), factors.size())
      {
        for (std::size_t i = 0; i < factors.size(); ++i)
        {
          for (std::size_t j = 0; j < factors.size(); ++j)
            inverse_of_S(i, j) = std::inner_product(
                columns.begin() + i * n, columns.begin() + (i + 1) * n, Z.begin() + j * n, 0.);
          inverse_of_S(i, i) += 1. / factors[i];
        }
        if (rank() == 0)
          return;
        inverse_of_S.symmetrize();
        inverse_of_S.gauss_jordan();
      }

      std::size_t
      rank() const
      {
        return inverse_of_S.m();
      }

      /// Subtract Z S^-1 Z^T b from a column.
      void
      subtract(const double *b, double *column) const
      {
        if (rank() == 0)
          return;
        dealii::Vector<double> products(rank()), coefficients(rank());
        for (std::size_t i = 0; i < rank(); ++i)
          products[i] = std::inner_product(b, b + n, Z.begin() + i * n, 0.);
        inverse_of_S.vmult(coefficients, products);
        for (std::size_t i = 0; i < rank(); ++i)
          for (std::size_t k = 0; k < n; ++k)
            column[k] -= coefficients[i] * Z[i * n + k];
      }

      /// An entry of Z S^-1 Z^T.
      double
      entry(const unsigned int row, const unsigned int column) const
      {
        double sum = 0.;
        for (std::size_t i = 0; i < rank(); ++i)
          for (std::size_t j = 0; j < rank(); ++j)
            sum += inverse_of_S(i, j) * Z[i * n + row] * Z[j * n + column];
        return sum;
      }

      std::size_t
      memory_consumption() const
      {
        return dealii::MemoryConsumption::memory_consumption(Z) + inverse_of_S.memory_consumption();
      }

    private:
      std::size_t                n = 0;
      std::vector<double>        Z;
      dealii::FullMatrix<double> inverse_of_S;
    };

    class CorrectedEntries : public InverseEntries
    {
    public:
      CorrectedEntries(std::unique_ptr<InverseEntries>   entries,
                       std::shared_ptr<const Correction> correction)
          : entries(std::move(entries)), correction(std::move(correction))
      {
      }

      std::size_t
      add(const unsigned int unknown) override
      {
        unknowns.push_back(unknown);
        return entries->add(unknown);
      }

      double
      entry(const std::size_t row, const std::size_t column) const override
      {
        return entries->entry(row, column) - correction->entry(unknowns[row], unknowns[column]);
      }

      std::size_t
      memory_consumption() const override
      {
        return entries->memory_consumption()
               + dealii::MemoryConsumption::memory_consumption(unknowns);
      }

    private:
      const std::unique_ptr<InverseEntries>   entries;
      const std::shared_ptr<const Correction> correction;
      std::vector<unsigned int>               unknowns;
    };

    class CorrectedInverse : public KeptInverse
    {
    public:
      CorrectedInverse(std::unique_ptr<KeptInverse> inverse, Correction correction)
          : inverse(std::move(inverse)),
            correction(std::make_shared<const Correction>(std::move(correction)))
      {
      }

      void
      apply(std::vector<double> &vector) override
      {
        right_side = vector;
        inverse->apply(vector);
        correction->subtract(right_side.data(), vector.data());
      }

      std::unique_ptr<InverseEntries>
      entries() const override
      {
        auto plain = inverse->entries();
        return plain == nullptr ? nullptr
                                : std::make_unique<CorrectedEntries>(std::move(plain), correction);
      }

      double
      cost_in_iterations(const std::size_t n_columns) const override
      {
        return inverse->cost_in_iterations(n_columns + correction->rank());
      }

      std::size_t
      memory_consumption() const override
      {
        return inverse->memory_consumption() + correction->memory_consumption();
      }

    private:
      const std::unique_ptr<KeptInverse>      inverse;
      const std::shared_ptr<const Correction> correction;
      std::vector<double>                     right_side; ///< for its memory
    };

    class LowRankOperator : public WrappedOperator
    {
    public:
      LowRankOperator(std::unique_ptr<SpdOperator> matrix, const FreeDofs &free_dofs)
          : WrappedOperator(std::move(matrix)), free_dofs(free_dofs)
      {
      }

      OperatorTraits
      traits() const override
      {
        OperatorTraits traits = matrix->traits();
        traits.bytes += correction.memory_consumption();
        return traits;
      }

      OuterProducts *
      outer_products() override
      {
        return &products;
      }

      void
      factorize(const Vector &positions) override
      {
        matrix->factorize(positions);
        correct();
      }

      void
      factorize_roughly(const Vector &positions) override
      {
        matrix->factorize_roughly(positions);
        correct();
      }

      void
      factorize_near(const Vector &positions) override
      {
        matrix->factorize_near(positions);
        correct();
      }

      void
      solve(std::vector<double> &solved, const double accuracy) override
      {
        const std::vector<double> right_sides = solved;
        matrix->solve(solved, accuracy);
        for (std::size_t begin = 0; begin < solved.size(); begin += n())
          correction.subtract(right_sides.data() + begin, solved.data() + begin);
      }

      std::unique_ptr<SpdOperator>
      twin() const override
      {
        std::unique_ptr<SpdOperator> other = matrix->twin();
        return other == nullptr ? nullptr
                                : std::make_unique<LowRankOperator>(std::move(other), free_dofs);
      }

      /// The correction is that of the kept inverse itself: with another one the two would not cancel, nor their sum be definite,
      /// where the products are much stiffer than the rest.
      std::unique_ptr<KeptInverse>
      keep() const override
      {
        std::unique_ptr<KeptInverse> inverse = matrix->keep();
        std::vector<double>          Z, column;
        for (std::size_t begin = 0; begin < columns.size(); begin += n())
        {
          column.assign(columns.begin() + begin, columns.begin() + begin + n());
          inverse->apply(column);
          Z.insert(Z.end(), column.begin(), column.end());
        }
        return std::make_unique<CorrectedInverse>(std::move(inverse),
                                                  Correction(factors, columns, std::move(Z)));
      }

    private:
      std::size_t
      n() const
      {
        return free_dofs.list().size();
      }

      /// Let columns and factors be those of the products.
      void
      read_products()
      {
        factors.clear();
        columns.clear();
        for (std::size_t k = 0; k < products.size(); ++k)
        {
          if (!(products.factors[k] > 0.))
            continue;
          factors.push_back(products.factors[k]);
          columns.resize(columns.size() + n(), 0.);
          double *column = columns.data() + columns.size() - n();
          for (std::size_t i = products.begin(k); i < products.ends[k]; ++i)
            for (unsigned int c = 0; c < 3; ++c)
              if (const int row = free_dofs.free_index(3 * products.blocks[i] + c);
                  row != FreeDofs::held)
                column[row] += products.values[3 * i + c];
        }
      }

      void
      correct()
      {
        read_products();
        std::vector<double> Z = columns;
        matrix->solve(Z);
        correction = Correction(factors, columns, std::move(Z));
      }

      const FreeDofs     &free_dofs;
      OuterProducts       products;
      std::vector<double> factors, columns; ///< F and U since factorize()
      Correction          correction;       ///< of the matrix' own solve()
    };
  } // namespace

  std::unique_ptr<SpdOperator>
  make_low_rank_operator(std::unique_ptr<SpdOperator> matrix, const FreeDofs &free_dofs)
  {
    return std::make_unique<LowRankOperator>(std::move(matrix), free_dofs);
  }
} // namespace Exemplar
