// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/dense.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/solvers/contact_gradients.h>
#include <exemplar/solvers/contact_problem.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace Exemplar::Testing
{
  namespace
  {
    /// A small body with an inverse H, forces r on it, and gaps.
    class SmallContact
    {
    public:
      SmallContact(const unsigned int n_nodes,
                   const unsigned int n_gaps,
                   const double       friction,
                   const double       push)
          : n(3 * n_nodes), H(n, n), K(n, n), r(n)
      {
        dealii::FullMatrix<double> root(n, n);
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j < n; ++j)
            root(i, j) = normal(generator);
        root.mTmult(H, root);
        for (unsigned int i = 0; i < n; ++i)
          H(i, i) += 0.5;
        K.invert(H);
        std::vector<Gap> gaps(n_gaps);
        for (unsigned int g = 0; g < n_gaps; ++g)
        {
          Gap &gap            = gaps[g];
          gap.n_nodes         = g % 3 == 2 && n_nodes > 1 ? 2 : 1;
          gap.nodes           = { g % n_nodes, (g + 1) % n_nodes };
          gap.coefficients    = { gap.n_nodes == 2 ? 0.3 : 1., 0.7 };
          gap.normal          = random_normal();
          gap.width           = 0.05;
          gap.distance        = g % 2 == 0 ? 0.01 : 0.2; // one in two does not push yet
          gap.stiffness       = 2.;
          gap.friction        = g % 2 == 0 ? friction : 0.;
          gap.friction_normal = random_normal();
          gap.slip_width      = 0.02;
          gap.slip            = 0.01 * random_normal();
        }
        rows = std::make_unique<GapEnergies>(gaps);
        for (double &force : r)
          force = push * normal(generator);
      }

      std::vector<double>
      respond(const std::vector<double> &forces) const
      {
        std::vector<double> result(n);
        for (unsigned int i = 0; i < n; ++i)
          result[i] = dot(forces, &H(i, 0));
        return result;
      }

      std::vector<double>
      forces(const std::vector<double> &by_row) const
      {
        Vector field(n);
        rows->add_forces(by_row, field);
        return { field.begin(), field.end() };
      }

      std::vector<double>
      changes(const std::vector<double> &u) const
      {
        return rows->changes(Vector(u.begin(), u.end()));
      }

      /// U^T H U
      dealii::FullMatrix<double>
      between_rows() const
      {
        const std::size_t          m = rows->n_rows();
        dealii::FullMatrix<double> W(m, m);
        for (std::size_t j = 0; j < m; ++j)
        {
          std::vector<double> unit(m);
          unit[j]                          = 1.;
          const std::vector<double> column = changes(respond(forces(unit)));
          for (std::size_t i = 0; i < m; ++i)
            W(i, j) = column[i];
        }
        return W;
      }

      double
      energy(const std::vector<double> &u) const
      {
        double sum = rows->value(changes(u)) - dot(r, u);
        for (unsigned int i = 0; i < n; ++i)
          sum += 0.5 * u[i] * dot(u, &K(i, 0));
        return sum;
      }

      /// K u - r + U B'
      std::vector<double>
      gradient(const std::vector<double> &u) const
      {
        std::vector<double> result = forces(rows->slopes(changes(u)));
        for (unsigned int i = 0; i < n; ++i)
          result[i] += dot(u, &K(i, 0)) - r[i];
        return result;
      }

      double
      greatest_force(const std::vector<double> &u) const
      {
        return std::max(max_entry(r), max_entry(rows->slopes(changes(u))));
      }

      ContactForces
      find_forces(const double enough, const std::vector<double> &first) const
      {
        const std::vector<double> free = respond(r);
        return minimize_with_contact(*rows, between_rows(), changes(free), dot(r, free), enough,
                                     first);
      }

      std::vector<double>
      solve_in_forces(unsigned int &iterations) const
      {
        const std::vector<double> free  = respond(r);
        const ContactForces       found = find_forces(0., {});
        iterations                      = found.iterations;
        EXPECT_EQ(found.part, 1.);
        std::vector<double> u = respond(forces(found.forces));
        add(u, found.part, free);
        const std::vector<double> of_u = changes(u);
        for (std::size_t i = 0; i < of_u.size(); ++i)
          EXPECT_NEAR(of_u[i], found.changes[i], 1e-9 * (1. + max_entry(of_u)));
        return u;
      }

      std::vector<double>
      solve_by_gradients() const
      {
        const ContactOperators operators
            = { [this](const std::vector<double> &f) { return respond(f); },
                [this](const std::vector<double> &by_row) { return forces(by_row); },
                [this](const std::vector<double> &u) { return changes(u); }, Exchange::serial() };
        return minimize_with_contact(*rows, operators, r).step;
      }

      dealii::Tensor<1, 3>
      random_normal()
      {
        dealii::Tensor<1, 3> vector;
        for (unsigned int c = 0; c < 3; ++c)
          vector[c] = normal(generator);
        return vector / vector.norm();
      }

      std::mt19937                     generator{ 11 };
      std::normal_distribution<double> normal;
      const unsigned int               n;
      dealii::FullMatrix<double>       H, K;
      std::vector<double>              r;
      std::unique_ptr<GapEnergies>     rows;
    };

    TEST(GapEnergiesTest, SlopesAndCurvaturesAreThoseOfTheEnergy)
    {
      SmallContact              body(4, 9, 0.7, 1.);
      const GapEnergies        &rows = *body.rows;
      std::vector<double>       at(rows.n_rows());
      const std::vector<double> none = at;
      for (double &change : at)
        change = 2e-3 * body.normal(body.generator);
      const std::vector<double> slopes = rows.slopes(at);
      for (std::size_t i = 0; i < at.size(); ++i)
      {
        const double        step   = 1e-6;
        std::vector<double> beyond = at, before = at, unit = none, once, twice;
        beyond[i] += step;
        before[i] -= step;
        unit[i] = 1.;
        EXPECT_NEAR(slopes[i], (rows.value(beyond) - rows.value(before)) / (2. * step), 1e-6);
        rows.root_of_curvatures(at).multiply(unit, once);
        rows.root_of_curvatures(at).multiply(once, twice);
        for (std::size_t j = 0; j < at.size(); ++j)
          EXPECT_NEAR(twice[j], (rows.slopes(beyond)[j] - rows.slopes(before)[j]) / (2. * step),
                      1e-4 * (1. + std::abs(twice[j])));
      }
    }

    TEST(ContactProblemTest, ItsSolutionIsTheMinimumOverAllDisplacements)
    {
      for (const double friction : { 0., 0.7 })
        for (const double push : { 0.1, 1., 30. })
        {
          const SmallContact        body(6, 8, friction, push);
          unsigned int              iterations = 0;
          const std::vector<double> u          = body.solve_in_forces(iterations);
          EXPECT_LT(max_entry(body.gradient(u)), 1e-5 * body.greatest_force(u));
          EXPECT_LE(iterations, 40u);
          const double least        = body.energy(u),
                       of_gradients = body.energy(body.solve_by_gradients());
          EXPECT_LT(least, body.energy(std::vector<double>(u.size())));
          EXPECT_NEAR(of_gradients, least, 3e-3 * std::abs(least));
        }
    }

    TEST(ContactProblemTest, ForcesToBeginWithSaveIterationsAndChangeNothing)
    {
      for (const double push : { 1., 30. })
      {
        SmallContact        body(6, 8, 0.7, push);
        const ContactForces found = body.find_forces(0., {});
        std::vector<double> first = found.forces;
        // a gap that leaves less than a tenth is not reached at once
        const unsigned int iterations = body.find_forces(1e-6 * max_entry(first), first).iterations;
        EXPECT_LT(iterations, found.iterations);
        EXPECT_TRUE(iterations == 0 || push > 1.);
        first.resize(first.size() / 2); // others have joined
        const ContactForces again = body.find_forces(0., first);
        EXPECT_EQ(again.part, 1.);
        for (std::size_t i = 0; i < found.forces.size(); ++i)
          EXPECT_NEAR(again.forces[i], found.forces[i], 1e-4 * max_entry(found.forces));
        for (double &force : body.r) // another problem than the one that they are from
          force *= -1.;
        const ContactForces other = body.find_forces(0., {}), there = body.find_forces(0., first);
        for (std::size_t i = 0; i < other.forces.size(); ++i)
          EXPECT_NEAR(there.forces[i], other.forces[i], 1e-4 * max_entry(other.forces));
      }
    }

    TEST(ContactProblemTest, ItEndsWhereSoMuchOfTheGradientIsLeft)
    {
      const SmallContact  body(6, 8, 0.7, 30.);
      const ContactForces exact  = body.find_forces(0., {});
      const double        enough = 0.03 * max_entry(exact.forces);
      const ContactForces found  = body.find_forces(enough, {});
      EXPECT_LT(found.iterations, exact.iterations);
      EXPECT_EQ(found.part, 1.);
      std::vector<double> u = body.respond(body.forces(found.forces));
      add(u, 1., body.respond(body.r));
      // a node may have several rows
      EXPECT_LT(max_entry(body.gradient(u)), 8. * enough);
    }

    TEST(ContactProblemTest, MoreGapsThanUnknownsAreNoTrouble)
    {
      const SmallContact         body(2, 9, 0., 3.); // of rank 6
      dealii::FullMatrix<double> W = body.between_rows();
      EXPECT_EQ(rank(W, 1e-9), 6u);
      unsigned int              iterations = 0;
      const std::vector<double> u          = body.solve_in_forces(iterations);
      EXPECT_LT(max_entry(body.gradient(u)), 1e-5 * body.greatest_force(u));
      EXPECT_LE(iterations, 40u);
    }
  } // namespace
} // namespace Exemplar::Testing
