// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/lbfgs.h>
#include <exemplar/algebra/linear_prediction.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/potential/inertia_term.h>
#include <exemplar/solvers/rotated_metric.h>

#include "body.h"

#include <gtest/gtest.h>

#include <cmath>

namespace Exemplar::Testing
{
  namespace
  {
    /// What follows a sequence, the oldest first.
    std::vector<double>
    predict(const std::vector<std::vector<double>> &sequence,
            const unsigned int                      order = LinearPrediction::max_order)
    {
      LinearPrediction    prediction(Exchange::serial(), order);
      std::vector<double> next;
      for (std::vector<double> vector : sequence)
        prediction.add(vector);
      prediction.predict(next);
      return next;
    }

    void
    add_pair(Lbfgs &lbfgs, std::vector<double> s, std::vector<double> y)
    {
      lbfgs.add_pair(s, y);
    }

    /// Samples of t -> (f, g, h), the newest at t = 0.
    template <typename Function>
    std::vector<std::vector<double>>
    samples(const Function &function, const unsigned int n)
    {
      std::vector<std::vector<double>> sequence;
      for (unsigned int i = n; i-- > 0;)
        sequence.push_back(function(-0.1 * i));
      return sequence;
    }

    TEST(LinearPrediction, DoesNotContinueRoundingByMotion)
    {
      const std::vector<double> rest = { 1e-7, 0., -1e-7 }, motion = { 0.2, 0.1, 0. };
      EXPECT_EQ(predict({ rest, rest, motion }), motion);
      EXPECT_EQ(predict({ rest, motion }), motion);
    }

    TEST(LinearPrediction, ContinuesOscillationsAndPolynomials)
    {
      const auto damped = [](const double t)
      {
        return std::vector<double>{ std::exp(-t) * std::cos(3. * t),
                                    std::exp(-t) * std::sin(3. * t), 1.,
                                    0.3 * std::exp(-t) * std::sin(3. * t + 1.) };
      };
      const auto parabola = [](const double t) {
        return std::vector<double>{ 1. + t, t * t, 2. * t - t * t };
      };
      // with more samples than are kept, too
      for (const unsigned int n : { 6, 9 })
        for (unsigned int i = 0; i < 4; ++i)
          EXPECT_NEAR(predict(samples(damped, n))[i], damped(0.1)[i], 1e-4);
      for (unsigned int i = 0; i < 3; ++i)
        EXPECT_NEAR(predict(samples(parabola, 4))[i], parabola(0.1)[i], 1e-4);
    }

    TEST(LinearPrediction, CombinesAsManyVectorsAsItsOrderSays)
    {
      const auto cubic = [](const double t) {
        return std::vector<double>{ 1., t, t * t, t * t * t };
      };
      // of a cubic the next value follows from four, and not from three
      const auto error = [&](const unsigned int order)
      { return std::abs(predict(samples(cubic, 9), order)[3] - cubic(0.1)[3]); };
      EXPECT_LT(error(4), 1e-4);
      EXPECT_GT(error(3), 1e-3);
      // one vector is only made longer or shorter
      const std::vector<double> turned = predict({ { 1., 0. }, { 2., 2. } }, 1);
      EXPECT_NEAR(turned[0], 4., 1e-8);
      EXPECT_NEAR(turned[1], 4., 1e-8);
    }

    TEST(LinearPrediction, NeedsNoHistory)
    {
      EXPECT_EQ(predict({ { 1., 2. } }), (std::vector<double>{ 1., 2. }));
      EXPECT_EQ(predict({ { 0., 0. }, { 0., 0. } }), (std::vector<double>{ 0., 0. }));
      EXPECT_EQ(predict({ { 0., 0. }, { 3., 1. } }), (std::vector<double>{ 3., 1. }));
    }

    TEST(Lbfgs, MeetsItsPairs)
    {
      // the secant equation: what made a change y of the gradient was s
      Lbfgs                     lbfgs(Exchange::serial());
      const std::vector<double> s = { 1., -2., 0.5 }, y = { 2., -1., 0.3 };
      for (std::size_t i = 0; i < Lbfgs::max_pairs; ++i) // of which the first leaves
        add_pair(lbfgs, { 0.1, 0.2, 0.3 }, { 0.2, 0.2, 0.9 });
      add_pair(lbfgs, s, y);
      add_pair(lbfgs, s, { -2., 1., -0.3 }); // curves downwards: not taken
      std::vector<double> vector = y;
      lbfgs.before(vector);
      for (double &entry : vector)
        entry *= 0.7; // any approximate inverse
      lbfgs.after(vector);
      for (unsigned int i = 0; i < 3; ++i)
        EXPECT_NEAR(vector[i], s[i], 1e-14);
      lbfgs.clear();
      vector = y;
      lbfgs.before(vector);
      lbfgs.after(vector);
      EXPECT_EQ(vector, y);
    }

    /// R K R^T + M of a bar of which one end is held, its node 5 partly.
    struct Factored
    {
      explicit Factored(const MeshParameters &mesh, const double degrees)
          : body(mesh),
            free_dofs(body.fe_space.n_dofs(), { 0, 1, 2, 3, 4, 5, 16 }, Exchange::serial()),
            mass(body.fe_space, body.material, MassMatrix::consistent),
            integrator(TimeParameters()), inertia(mass, integrator),
            elastic(body, ModelParameters(), {}, free_dofs),
            positions(body.fe_space.rest_positions())
      {
        const double c = std::cos(degrees * M_PI / 180.), s = std::sin(degrees * M_PI / 180.);
        for (unsigned int node = 0; node < body.fe_space.n_nodes(); ++node)
        {
          const double x = positions[3 * node], y = positions[3 * node + 1];
          positions[3 * node]     = c * x - s * y;
          positions[3 * node + 1] = s * x + c * y;
        }
        State state;
        state.positions = state.velocities = positions;
        integrator.begin_step(state, 0.1);
        inertia.begin_step(state, 0.1);
        inertia.attach(elastic.matrix_pattern, free_dofs);
        auto matrix = make_cholesky_operator();
        matrix->reinit(elastic.matrix_pattern);
        system = make_block_system(std::move(matrix), no_weights, Exchange::serial());
        elastic.update_rotations(positions);
        std::vector<double> columns;
        inertia.add_tangent({ positions, {} }, Tangent::convex, system->matrix_values(), columns);
        elastic.assemble_tangent(Tangent::convex, positions, {}, system->matrix_values(), columns);
        system->factorize(positions);
        elastic.node_rotations(rotations);
      }

      const WeightForm                no_weights;
      Body                            body;
      FreeDofs                        free_dofs;
      Mass                            mass;
      TimeIntegrator                  integrator;
      InertiaTerm                     inertia;
      BodyPotential                   elastic;
      std::unique_ptr<BorderedSystem> system;
      dealii::Vector<double>          positions;
      std::vector<float>              rotations;
    };

    std::vector<double>
    some_forces(const FreeDofs &free_dofs)
    {
      std::vector<double> forces;
      for (const unsigned int dof : free_dofs.list())
        forces.push_back(1e-9 * std::sin(1. + 7. * dof)); // small ones, too, must not be lost
      return forces;
    }

    double
    relative_difference(const std::vector<double> &a, const std::vector<double> &b)
    {
      std::vector<double> difference = a;
      add(difference, -1., b);
      return std::sqrt(dot(difference, difference) / dot(b, b));
    }

    TEST(SinglePrecisionInverse, SolvesAsTheFactorItself)
    {
      // supernodes of all widths, and rows that no register divides
      for (const unsigned int n : { 1, 2, 3 })
      {
        const Factored      now(box_mesh(4., 2 * n + 1, n), 0.);
        std::vector<double> exact = some_forces(now.free_dofs), kept = exact;
        now.system->apply_inverse(exact);
        now.system->keep()->apply(kept);
        EXPECT_LT(relative_difference(kept, exact), 1e-4);
      }
    }

    TEST(RotatedMetric, IsExactWhereTheBodyTurnsAsAWhole)
    {
      // but at the node that is partly held: a component cannot turn
      const MeshParameters bar = box_mesh(4., 4, 2);
      const Factored       then(bar, 0.), now(bar, 70.);
      RotatedMetric        metric(then.free_dofs);
      metric.reinit(*then.system, inverse_columns(*then.system), then.rotations);
      metric.rotate(now.rotations);
      std::vector<double> forces = some_forces(now.free_dofs), exact = forces;
      now.system->apply_inverse(exact);
      metric.rotate_back(forces);
      metric.apply(forces);
      metric.rotate_forth(forces);
      EXPECT_LT(relative_difference(forces, exact), 0.1);
      std::vector<double> unturned = some_forces(now.free_dofs);
      metric.rotate(then.rotations);
      metric.apply(unturned);
      EXPECT_GT(relative_difference(unturned, exact), 0.5);
    }
  } // namespace
} // namespace Exemplar::Testing
