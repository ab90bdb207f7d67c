// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/algebra/weight_qp.h>
#include <exemplar/base/errors.h>
#include <exemplar/verification/verification.h>
#include <exemplar/verification/verification_scene.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

// Properties of example poses and their weights.

namespace Exemplar::Verification
{
  namespace
  {
    const std::string long_bar = box({ { 4., 1., 1. } }, { { 4, 1, 1 } });

    const std::string dragged
        = set("Scene", "static") + long_bar
          + named_sections(
              "Handles",
              { { "left", set("Select", "boundary 1") },
                { "right", set("Select", "boundary 2") + set("Motion", "0.2*t; 0.6*t; 0.3*t") } })
          + section("Solver", set("Tolerance", 1e-11));

    const std::string twisted = twist(60., 4.), stretched = "1.2*x; 0.9*y; z";

    std::string
    examples_of(const std::string &poses, const std::string &keys = "")
    {
      return section("Examples", set("Pose functions", poses) + keys);
    }

    /// A step from a rigid motion of each example must leave it in place with w = e_i.
    std::vector<Measurement>
    example_recovery()
    {
      Scene    scene(set("Scene", "dynamic") + long_bar
                     + examples_of(twisted + " | " + stretched,
                                   set("Importance", "1") + set("Weight penalty", "0"))
                     + section("Time", set("Step", 0.1) + set("End", 1.))
                     + section("Solver", set("Tolerance", 1e-12)));
      Problem &p        = scene.problem;
      double   residual = 0., weight_error = 0., distance = 0.;
      for (unsigned int i = 0; i < p.examples.poses.size(); ++i)
      {
        State start      = p.state;
        start.positions  = moved_rigidly(p.examples.poses.pose(i),
                                         rotation_about({ { 1., 1., 0. } }, 2.), { { 5., 5., 5. } });
        start.velocities = 0.;
        std::vector<double> unit(p.examples.poses.size(), 0.);
        unit[i] = 1.;
        const ElasticEvaluation strained
            = evaluate(p, start.positions, std::vector<double>{ 1., 0., 0. });
        const ElasticEvaluation at = evaluate(p, start.positions, unit);
        const double            scale
            = max_or_nan(max_entry(strained.force_scale.begin(), strained.force_scale.end()),
                         p.cells().rounding_force(0.) * 1e14);
        residual = max_or_nan(residual, max_entry(at.gradient.begin(), at.gradient.end()) / scale);
        p.resume_from(start);
        if (!is_success(p.advance().status))
          throw SolverFailure(fmt::format("example {}: the step failed", i));
        distance = max_or_nan(distance, max_difference(p.state.positions, start.positions));
        for (unsigned int j = 0; j < unit.size(); ++j)
          weight_error = max_or_nan(weight_error, std::abs(p.state.weights[j] - unit[j]));
      }
      return { { "relative residual", 0., residual, Comparison::absolute, 1e-12 },
               { "w - e_i", 0., weight_error, Comparison::absolute, 1e-8 },
               { "motion in a step", 0., distance, Comparison::absolute, 1e-9 } };
    }

    std::vector<Measurement>
    importance_zero()
    {
      Scene without(dragged);
      Scene with(dragged + examples_of("2*x; y; z", set("Importance", "0")));
      return { { "difference, bit for bit", 0.,
                 max_difference(without.solve().positions, with.solve().positions),
                 Comparison::absolute, 0. } };
    }

    std::vector<Measurement>
    one_region()
    {
      Scene global(dragged + examples_of(twisted, ""));
      Scene local(dragged
                  + examples_of(twisted, set("Weights per region", "true")
                                             + set("Region blend length", "0.5")));
      return { { "difference, bit for bit", 0.,
                 max_difference(global.solve().positions, local.solve().positions),
                 Comparison::absolute, 0. } };
    }

    /// eta w of the stretched and dragged bar with scaled energy, free weights and no ridge.
    double
    scaled_weight(const double importance)
    {
      Scene scene(dragged
                  + examples_of(twisted, set("Importance", importance) + set("Energy", "scaled")
                                             + set("Weights", "free")
                                             + set("Weight penalty", "0")));
      return importance * scene.solve().weights[1];
    }

    std::vector<Measurement>
    free_weights_undo_importance()
    {
      return { { "eta w at 0.5 and 1, ratio", 1., scaled_weight(0.5) / scaled_weight(1.),
                 Comparison::relative, 1e-8 } };
    }

    std::vector<Measurement>
    permutation()
    {
      const std::string free = set("Weights", "free"); // bounds would make some zero
      Scene             pq(dragged + examples_of(twisted + " | " + stretched, free));
      Scene             qp(dragged + examples_of(stretched + " | " + twisted, free));
      const State       a = pq.solve(), b = qp.solve();
      return { { "w_1 less w_2 of the other order", a.weights[1], b.weights[2],
                 Comparison::absolute, 1e-8 },
               { "w_2 less w_1 of the other order", a.weights[2], b.weights[1],
                 Comparison::absolute, 1e-8 },
               { "positions", 0., max_difference(a.positions, b.positions), Comparison::absolute,
                 1e-8 } };
    }

    std::vector<Measurement>
    duplicate()
    {
      const std::string        both = twisted + " | " + stretched, free = set("Weights", "free");
      Scene                    once(dragged + examples_of(both, free + set("Weight penalty", "5")));
      Scene                    twice(dragged
                                     + examples_of(both + " | x; y; z | " + both, free + set("Weight penalty", "10")));
      const State              a = once.solve(), b = twice.solve();
      std::vector<Measurement> all = { { "positions", 0., max_difference(a.positions, b.positions),
                                         Comparison::absolute, 1e-8 } };
      for (unsigned int i = 0; i < 3; ++i)
        all.push_back({ fmt::format("w_{}", i), a.weights[i], b.weights[i] + b.weights[i + 3],
                        Comparison::absolute, 1e-8 });
      return all;
    }

    std::vector<Measurement>
    dependent_examples()
    {
      // the second stretch is half the first: an affine combination with the rest pose
      const std::string half       = "1.1*x; 0.95*y; z";
      double            is_refused = 0.;
      try
      {
        Scene(dragged + examples_of(stretched + " | " + half, set("Weight penalty", "0")));
      }
      catch (const UserError &error)
      {
        is_refused
            = std::string(error.what()).find("'" + half + "'") != std::string::npos ? 1. : 0.;
      }
      return { { "refused by name", 1., is_refused, Comparison::absolute, 0. } };
    }

    struct WeightQp
    {
      dealii::FullMatrix<double> H;
      std::vector<double>        c;

      double
      value(const std::vector<double> &w) const
      {
        double sum = 0.;
        for (unsigned int i = 0; i < w.size(); ++i)
        {
          sum -= c[i] * w[i];
          for (unsigned int j = 0; j < w.size(); ++j)
            sum += 0.5 * w[i] * H(i, j) * w[j];
        }
        return sum;
      }
    };

    WeightQp
    random_qp(std::mt19937 &generator, const unsigned int k)
    {
      std::normal_distribution<double> normal;
      WeightQp                         qp{ dealii::FullMatrix<double>(k, k), {} };
      dealii::FullMatrix<double>       L(k, k);
      for (unsigned int i = 0; i < k; ++i)
      {
        qp.c.push_back(normal(generator));
        for (unsigned int j = 0; j < k; ++j)
          L(i, j) = normal(generator);
      }
      L.mTmult(qp.H, L);
      qp.H.diagadd(1e-3);
      return qp;
    }

    /// Minimum over sum w = 1 with weights outside of `active` at 0, by the KKT system; infinite if
    /// a weight is negative.
    double
    value_on_active_set(const WeightQp &qp, const std::vector<unsigned int> &active)
    {
      const unsigned int         n = active.size();
      dealii::FullMatrix<double> kkt(n + 1, n + 1);
      dealii::Vector<double>     right_side(n + 1), solution(n + 1);
      for (unsigned int i = 0; i < n; ++i)
      {
        right_side[i] = qp.c[active[i]];
        kkt(i, n) = kkt(n, i) = 1.;
        for (unsigned int j = 0; j < n; ++j)
          kkt(i, j) = qp.H(active[i], active[j]);
      }
      right_side[n] = 1.;
      kkt.gauss_jordan();
      kkt.vmult(solution, right_side);
      std::vector<double> w(qp.c.size(), 0.);
      for (unsigned int i = 0; i < n; ++i)
        w[active[i]] = solution[i];
      return *std::min_element(w.begin(), w.end()) < 0. ? std::numeric_limits<double>::infinity()
                                                        : qp.value(w);
    }

    double
    min_by_brute_force(const WeightQp &qp)
    {
      double minimum = std::numeric_limits<double>::infinity();
      for (unsigned int set = 1; set < (1u << qp.c.size()); ++set)
      {
        std::vector<unsigned int> active;
        for (unsigned int i = 0; i < qp.c.size(); ++i)
          if ((set >> i & 1u) != 0)
            active.push_back(i);
        minimum = min_or_nan(minimum, value_on_active_set(qp, active));
      }
      return minimum;
    }

    /// Violation of the conditions of Karush, Kuhn and Tucker by a solution.
    double
    kkt_error(const WeightQp &qp, const WeightQpSolution &solution)
    {
      double error = 0., sum = 0.;
      for (unsigned int i = 0; i < qp.c.size(); ++i)
      {
        double derivative = solution.multipliers[0] - qp.c[i];
        for (unsigned int j = 0; j < qp.c.size(); ++j)
          derivative += qp.H(i, j) * solution.weights[j];
        sum += solution.weights[i];
        for (const double violation :
             { -solution.weights[i], -derivative, solution.weights[i] > 0. ? derivative : 0. })
          error = max_or_nan(error, violation);
      }
      return max_or_nan(error, std::abs(sum - 1.));
    }

    std::vector<Measurement>
    simplex_kkt()
    {
      std::mt19937 generator(1);
      double       max_kkt = 0., max_value = 0.;
      for (unsigned int sample = 0; sample < 300; ++sample)
      {
        const unsigned int k  = 1 + sample % 6;
        const WeightQp     qp = random_qp(generator, k);
        const auto best = minimize_over_weights(qp.H, qp.c, { 1. }, std::vector<double>(k, 0.));
        max_kkt         = max_or_nan(max_kkt, kkt_error(qp, best));
        max_value
            = max_or_nan(max_value, std::abs(qp.value(best.weights) - min_by_brute_force(qp)));
      }
      return { { "conditions of KKT", 0., max_kkt, Comparison::absolute, 1e-10 },
               { "value less brute force", 0., max_value, Comparison::absolute, 1e-10 } };
    }
  } // namespace

  std::vector<Case>
  example_cases()
  {
    return {
      { "example-recovery",
        "a moved example is an equilibrium with w = e_i; doc/model.md, closed forms",
        example_recovery },
      { "importance-zero", "examples of importance 0 change no bit", importance_zero },
      { "one-region", "weights of one region are the global ones", one_region },
      { "free-weights-undo-importance", "eta w does not depend on eta; doc/model.md, weights",
        free_weights_undo_importance },
      { "permutation", "permuted examples permute the weights; doc/model.md, closed forms",
        permutation },
      { "duplicate",
        "every example twice with sigma is each once with sigma/2; doc/model.md, closed forms",
        duplicate },
      { "dependent-examples", "refused without ridge; doc/model.md, weights", dependent_examples },
      { "simplex-kkt", "300 random programs of up to 6 weights: KKT, and all active sets",
        simplex_kkt }
    };
  }
} // namespace Exemplar::Verification
