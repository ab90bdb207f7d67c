// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/potential/incremental_potential.h>

#include "body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace Exemplar::Testing
{
  namespace
  {
    /// A spring of stiffness k [N/m] and no length between two nodes, however far apart.
    class SpringTerm : public PotentialTerm
    {
    public:
      std::string
      name() const override
      {
        return "spring";
      }

      SpringTerm(const unsigned int a, const unsigned int b, const double k) : a(a), b(b), k(k) {}

      void
      begin_step(const State &, double) override
      {
        is_new = (++n_steps == 2);
      }

      /// From its second step on it ends at another node.
      TermChange
      renew(const TermPoint &) override
      {
        b -= is_new ? 1 : 0;
        return std::exchange(is_new, false) ? TermChange::couplings : TermChange::none;
      }

      void
      add(const TermPoint &at, ElasticSums &sums) override
      {
        const Vector &x      = at.positions;
        double        energy = 0.;
        for (unsigned int c = 0; c < 3; ++c)
        {
          const double stretch = x[3 * a + c] - x[3 * b + c];
          sums->gradient[3 * a + c] += k * stretch;
          sums->gradient[3 * b + c] -= k * stretch;
          energy += 0.5 * k * stretch * stretch;
        }
        sums->force_scale[a] += std::sqrt(2. * k * energy);
        sums->force_scale[b] += std::sqrt(2. * k * energy);
        sums->energy += energy;
      }

      std::vector<std::pair<unsigned int, unsigned int>>
      couplings() const override
      {
        return { { a, b } };
      }

      void
      attach(const SymmetricPattern &pattern, const FreeDofs &free_dofs) override
      {
        diagonal.clear();
        beside.clear();
        for (unsigned int c = 0; c < 3; ++c)
        {
          const int i = free_dofs.free_index(3 * a + c), j = free_dofs.free_index(3 * b + c);
          diagonal.push_back(pattern.position(i, i));
          diagonal.push_back(pattern.position(j, j));
          beside.push_back(pattern.position(std::max(i, j), std::min(i, j)));
        }
      }

      void
      add_tangent(const TermPoint &,
                  Tangent,
                  std::vector<double> &values,
                  std::vector<double> &) override
      {
        for (const int position : diagonal)
          values[position] += k;
        for (const int position : beside)
          values[position] -= k;
      }

      double
      rounding_force(const Vector & /*positions*/) const override
      {
        return 1e3;
      }

      std::size_t
      memory_consumption() const override
      {
        return sizeof(int) * (diagonal.size() + beside.size());
      }

    private:
      const unsigned int a;
      unsigned int       b, n_steps = 0;
      bool               is_new = false;
      const double       k;
      std::vector<int>   diagonal, beside;
    };

    /// A bar with a spring between two of its corners.
    struct SprungBar
    {
      explicit SprungBar(const Exchange &exchange = Exchange::serial())
          : body(box_mesh(4., 6, 1)),
            free_dofs(body.fe_space.n_dofs(), { 0, 1, 2, 5, 9 }, exchange),
            examples(body.examples(ExampleParameters())),
            cells({ CellLaw::corotational, body.fe_space, body.material, body.material,
                    no_patches(), *examples.poses, *examples.weights, free_dofs }),
            potential(
                cells, *examples.weights, free_dofs, springs(body.fe_space.n_nodes() - 1), nullptr)
      {
        std::mt19937 generator(1);
        state.positions = body.random_positions(generator, 0.05);
        potential.set_time(0., state);
      }

      static std::vector<std::unique_ptr<PotentialTerm>>
      springs(const unsigned int last_node)
      {
        std::vector<std::unique_ptr<PotentialTerm>> terms;
        terms.push_back(std::make_unique<SpringTerm>(4, last_node, 3e5));
        return terms;
      }

      Evaluation
      evaluate()
      {
        Evaluation evaluation;
        potential.evaluate(state, RotationUse::update, evaluation);
        return evaluation;
      }

      const Body           body;
      FreeDofs             free_dofs;
      const Examples       examples;
      ElasticPotential     cells;
      IncrementalPotential potential;
      State                state;
    };

    void
    expect_derivatives_of_each_other(SprungBar &bar)
    {
      const Evaluation    at = bar.evaluate();
      std::vector<double> matrix(bar.potential.get_tangent().get_pattern().n_values()), no_columns;
      bar.potential.get_tangent().assemble(bar.state.positions, {}, 0., matrix, no_columns);
      const SymmetricPattern &pattern = bar.potential.get_tangent().get_pattern();
      const auto             &free    = bar.free_dofs.list();
      const auto              entry   = [&](const int i, const int j)
      {
        const int position = pattern.position(std::max(i, j), std::min(i, j));
        return position < pattern.column_start[std::min(i, j) + 1]
                       && pattern.row[position] == std::max(i, j)
                   ? matrix[position]
                   : 0.;
      };
      ASSERT_EQ(at.term_energies.size(), 1u);
      EXPECT_GT(at.term_energies[0], 1e5); // else it proves nothing
      EXPECT_NEAR(at.potential, at.elastic.energy + at.term_energies[0], 1e-9 * at.potential);
      const double h = 1e-6;
      for (unsigned int j = 0; j < free.size(); ++j)
      {
        double      &x         = bar.state.positions[free[j]];
        const double value     = x;
        x                      = value + h;
        const Evaluation above = bar.evaluate();
        x                      = value - h;
        const Evaluation below = bar.evaluate();
        x                      = value;
        EXPECT_NEAR(at.gradient[free[j]], (above.potential - below.potential) / (2. * h), 1.);
        for (unsigned int i = 0; i < free.size(); ++i)
          EXPECT_NEAR(entry(static_cast<int>(i), static_cast<int>(j)),
                      (above.gradient[free[i]] - below.gradient[free[i]]) / (2. * h), 1.);
      }
    }

    TEST(IncrementalPotential, ATermAddsItsEnergyForcesAndTangent)
    {
      SprungBar bar;
      expect_derivatives_of_each_other(bar);
    }

    TEST(IncrementalPotential, ThePatternFollowsWhatATermCouplesAndWhatIsHeld)
    {
      SprungBar bar;
      for (const unsigned int version : { 0, 1 })
      {
        bar.potential.begin_step(bar.state, 0.);
        EXPECT_EQ(bar.potential.get_tangent().get_pattern().version, version);
        expect_derivatives_of_each_other(bar);
      }
      bar.free_dofs.reinit({ 0, 1, 2, 3, 4, 5, 7, 20 });
      bar.potential.get_tangent().renew_pattern();
      expect_derivatives_of_each_other(bar);
    }

    TEST(IncrementalPotential, ATermsRoundingCounts)
    {
      // forces below the rounding that a term claims are no residual
      SprungBar  bar;
      Evaluation small;
      small.gradient.reinit(bar.body.fe_space.n_dofs());
      small.force_scale.reinit(bar.body.fe_space.n_nodes());
      small.force_scale = 1e6;
      small.gradient    = 2e3;
      EXPECT_NEAR(bar.potential.residual(bar.state, small).positions, 2e-3, 1e-15);
      small.gradient = 0.9e3;
      EXPECT_EQ(bar.potential.residual(bar.state, small).positions, 0.);
      small.gradient[7] = std::nan("");
      EXPECT_THROW(bar.potential.residual(bar.state, small), SolverFailure);
    }

    /// One of two processes of which the other has greater forces.
    class WithAnother : public Exchange
    {
    public:
      double
      max(const double own) const override
      {
        return 3. * own;
      }
    };

    TEST(IncrementalPotential, TheResidualIsThatOfAllProcesses)
    {
      const WithAnother another;
      SprungBar         alone, together(another);
      const double      own = alone.free_dofs.max_magnitude(alone.evaluate().gradient);
      EXPECT_EQ(together.free_dofs.max_magnitude(together.evaluate().gradient), 3. * own);
    }
  } // namespace
} // namespace Exemplar::Testing
