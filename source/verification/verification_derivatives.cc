// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/run/problem/problem.h>
#include <exemplar/verification/verification.h>
#include <exemplar/verification/verification_scene.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

// Forces and tangents of a whole body against differences of its energy and forces.

namespace Exemplar::Verification
{
  namespace
  {
    /// Whether rotations follow the positions, or are kept so that the energy is quadratic.
    enum class Rotations
    {
      followed,
      kept
    };

    /// Derivatives of the cells' energy at a state: errors of the program's relative to finite
    /// differences.
    class Differences
    {
    public:
      /// `weights` [-] are used if the problem has examples.
      Differences(Problem                      &problem,
                  const dealii::Vector<double> &positions,
                  const std::vector<double>    &weights,
                  Rotations                     rotations)
          : problem(problem), x(positions),
            w(problem.examples.poses.size() > 0 ? weights : std::vector<double>()),
            rotations(rotations)
      {
        problem.cells().get_field().update_rotations(x);
        at = evaluate(x, w);
        problem.cells().get_field().update_rotations(x);
        matrix.resize(problem.potential.get_tangent().get_pattern().n_values());
        problem.cells().assemble_tangent(rotations == Rotations::followed ? Tangent::exact
                                                                          : Tangent::convex,
                                         x, w, matrix, columns);
      }

      /// Greatest error of the gradient, relative to 1 + its greatest entry.
      double
      of_gradient() const
      {
        double maximum = 0.;
        for (unsigned int dof = 0; dof < x.size(); ++dof)
        {
          const double slope
              = derivative([&](const double h) { return shifted(unit(dof), h).energy; });
          maximum = max_or_nan(maximum, std::abs(slope - at.gradient[dof]));
        }
        return maximum / (1. + max_entry(at.gradient.begin(), at.gradient.end()));
      }

      /// Relative error of the slope of the energy along its gradient f, which is |f|.
      double
      along_gradient() const
      {
        const double norm = at.gradient.l2_norm();
        if (norm < 1e-12)
          return norm; // no such direction at rest
        dealii::Vector<double> direction = at.gradient;
        direction /= norm;
        const double slope
            = derivative([&](const double h) { return shifted(direction, h).energy; });
        return std::abs(slope - norm) / (1. + norm);
      }

      /// Greatest error of the entries of the tangent, relative to the greatest entry.
      double
      of_tangent() const
      {
        const auto &free    = problem.constraints.free_dofs.list();
        double      maximum = 0., scale = 1.;
        for (unsigned int j = 0; j < free.size(); ++j)
        {
          const auto column = derivative_of_gradient(unit(free[j]));
          for (unsigned int i = 0; i < free.size(); ++i)
          {
            maximum = max_or_nan(maximum, std::abs(column[free[i]] - entry(i, j)));
            scale   = max_or_nan(scale, std::abs(entry(i, j)));
          }
        }
        return maximum / scale;
      }

      /// Greatest error of the derivatives by the weights and of the coupling -G, relative to 1 +
      /// the greatest entry of the gradient.
      double
      of_weights() const
      {
        const auto &free    = problem.constraints.free_dofs.list();
        double      maximum = 0.;
        for (unsigned int k = 0; k < w.size(); ++k)
        {
          const auto weight_moved = [&](const double h)
          {
            std::vector<double> moved = w;
            moved[k] += h;
            return evaluate(x, moved);
          };
          const double slope = derivative([&](const double h) { return weight_moved(h).energy; });
          maximum            = max_or_nan(maximum, std::abs(slope - at.weight_gradient[k]));
          for (unsigned int i = 0; i < free.size(); ++i)
          {
            const double change
                = derivative([&](const double h) { return weight_moved(h).gradient[free[i]]; });
            const double entry
                = problem.examples.poses.is_strained(k)
                      ? columns[problem.examples.poses.strained_index(k) * free.size() + i]
                      : 0.;
            maximum = max_or_nan(maximum, std::abs(change + entry));
          }
        }
        return maximum / (1. + max_entry(at.gradient.begin(), at.gradient.end()));
      }

    private:
      /// Central difference of fourth order at 0.
      template <typename Function>
      static double
      derivative(const Function &f)
      {
        const double h = 1e-3;
        return (8. * (f(h) - f(-h)) - (f(2. * h) - f(-2. * h))) / (12. * h);
      }

      dealii::Vector<double>
      derivative_of_gradient(const dealii::Vector<double> &direction) const
      {
        const double           h = 1e-3;
        dealii::Vector<double> sum(x.size());
        for (const auto &[steps, factor] :
             { std::pair(1., 8.), std::pair(-1., -8.), std::pair(2., -1.), std::pair(-2., 1.) })
          sum.add(factor / (12. * h), shifted(direction, steps * h).gradient);
        return sum;
      }

      dealii::Vector<double>
      unit(const unsigned int dof) const
      {
        dealii::Vector<double> direction(x.size());
        direction[dof] = 1.;
        return direction;
      }

      ElasticEvaluation
      shifted(const dealii::Vector<double> &direction, const double h) const
      {
        dealii::Vector<double> moved = x;
        moved.add(h, direction);
        return evaluate(moved, w);
      }

      ElasticEvaluation
      evaluate(const dealii::Vector<double> &positions, const std::vector<double> &at_weights) const
      {
        if (rotations == Rotations::followed)
          problem.cells().get_field().update_rotations(positions);
        ElasticEvaluation evaluation;
        problem.cells().evaluate(positions, at_weights, evaluation);
        return evaluation;
      }

      double
      entry(unsigned int i, unsigned int j) const
      {
        if (i < j)
          std::swap(i, j);
        const auto &pattern  = problem.potential.get_tangent().get_pattern();
        const int   position = pattern.position(i, j);
        const bool  is_there = position < pattern.column_start[j + 1]
                              && pattern.row[position] == static_cast<int>(i);
        return is_there ? matrix[position] : 0.;
      }

      Problem                     &problem;
      const dealii::Vector<double> x;
      const std::vector<double>    w;
      const Rotations              rotations;
      ElasticEvaluation            at;
      std::vector<double>          matrix;
      std::vector<double>          columns;
    };

    // E = 1 and unit lengths: forces and stiffnesses are of order 1, and errors are relative to 1 +
    // the greatest entry, so that vanishing forces have a scale, too
    const std::string short_bar
        = set("Scene", "static") + box({ { 3., 1., 1. } }, { { 3, 1, 1 } })
          + section("Material", set("Young's modulus", 1.) + set("Poisson's ratio", 0.3))
          + named_sections("Handles", { { "left", set("Select", "boundary 1") } });

    const std::string mixed_examples
        = section("Examples",
                  set("Pose functions", twist(60., 3.) + " | 1.1*x; 0.9*y; z")
                      + set("Importance", 0.7) + set("Weights", "free"));

    const std::string frozen_forces = section("Model", set("Gradient", "frozen"))
                                      + section("Solver", set("Method", "fixed point"));

    const std::vector<double> weights = { 0.2, 0.5, 0.3 };

    constexpr double tolerance = 1e-7;

    dealii::Vector<double>
    perturbed(const dealii::Vector<double> &positions, const double amplitude)
    {
      std::mt19937                     generator(3);
      std::normal_distribution<double> normal;
      dealii::Vector<double>           result = positions;
      for (double &x : result)
        x += amplitude * normal(generator);
      return result;
    }

    void
    measure(const Differences &differences, const std::string &with, std::vector<Measurement> &all)
    {
      const auto add = [&](const std::string &what, const double error) {
        all.push_back({ what + with, 0., error, Comparison::absolute, tolerance });
      };
      add("forces", differences.of_gradient());
      add("along the forces", differences.along_gradient());
      add("tangent", differences.of_tangent());
    }

    /// Errors of the derivatives at F (X + perturbation), without and with examples.
    std::vector<Measurement>
    derivatives_at(const Matrix3<double> &F, const double amplitude, const std::string &model)
    {
      std::vector<Measurement> all;
      Scene                    plain(short_bar + model), with(short_bar + mixed_examples + model);
      const auto               x = moved_rigidly(
                        perturbed(plain.problem.body.fe_space.rest_positions(), amplitude), F, {});
      measure(Differences(plain.problem, x, weights, Rotations::followed), "", all);
      const Differences differences(with.problem, x, weights, Rotations::followed);
      measure(differences, ", examples", all);
      all.push_back({ "weights", 0., differences.of_weights(), Comparison::absolute, tolerance });
      return all;
    }

    std::vector<Measurement>
    frozen_derivatives()
    {
      Scene                    scene(short_bar + mixed_examples + frozen_forces);
      const auto               x = perturbed(scene.problem.body.fe_space.rest_positions(), 0.15);
      const Differences        differences(scene.problem, x, weights, Rotations::kept);
      std::vector<Measurement> all;
      measure(differences, ", examples", all);
      all.push_back({ "weights", 0., differences.of_weights(), Comparison::absolute, tolerance });
      return all;
    }

    /// The energy in the form of the left side of Eq. (38), cell by cell; fibres are along x.
    double
    energy_of_two_elasticities(const Problem                &p,
                               const dealii::Vector<double> &x,
                               const double                  alpha)
    {
      const double      eta = 0.7;
      Isotropic<double> body{ 0.3 / (1.3 * 0.4), 0.5 / 1.3 },
          wish{ 3. * 0.1 / (1.1 * 0.8), 1.5 / 1.1 };
      const auto strain_at = [&](const unsigned int point, const dealii::Vector<double> &positions)
      {
        const auto F = p.body.fe_space.deformation_gradient(point, positions);
        return model_strain(CellLaw::corotational, model_rotation(CellLaw::corotational, F), F);
      };
      double sum = 0.;
      for (unsigned int point = 0; point < p.body.fe_space.n_points(); ++point)
      {
        const Matrix3<double> strain  = strain_at(point, x);
        Matrix3<double>       missing = strain;
        for (unsigned int i = 0; i < weights.size(); ++i)
          missing = combine(1., missing, -weights[i], strain_at(point, p.examples.poses.pose(i)));
        sum += 0.5 * p.body.fe_space.volume(point)
               * ((1. - eta)
                      * (contract(stress(body, strain), strain)
                         + alpha * strain[0][0] * strain[0][0])
                  + eta * contract(stress(wish, missing), missing));
      }
      return sum;
    }

    std::vector<Measurement>
    derivatives_of_two_elasticities()
    {
      const std::string examples = section(
          "Examples", set("Pose functions", twist(60., 3.) + " | 1.1*x; 0.9*y; z")
                          + set("Importance", 0.7) + set("Weights", "free")
                          + set("Energy", "blended") + set("Weight penalty", 0.)
                          + set("Example modulus", 3.) + set("Example Poisson ratio", 0.1));
      const std::string fibres
          = section("Material", set("Fibre stiffness", 0.8) + set("Fibre direction", "1; 0; 0"));
      std::vector<Measurement> all;
      for (const std::string dilatation : { "cells", "patches" })
        for (const std::string &grain : { std::string(), fibres })
        {
          Scene             scene(short_bar + examples + grain
                                  + section("Model", set("Dilatation", dilatation)));
          const auto        x    = perturbed(scene.problem.body.fe_space.rest_positions(), 0.1);
          const std::string with = ", " + dilatation + (grain.empty() ? "" : ", fibres");
          const Differences differences(scene.problem, x, weights, Rotations::followed);
          measure(differences, with, all);
          all.push_back(
              { "weights" + with, 0., differences.of_weights(), Comparison::absolute, tolerance });
          if (dilatation == "cells")
            all.push_back({ "energy" + with,
                            energy_of_two_elasticities(scene.problem, x, grain.empty() ? 0. : 0.8),
                            evaluate(scene.problem, x, weights).energy, Comparison::relative,
                            1e-12 });
        }
      return all;
    }

    Matrix3<double>
    diagonal(const double a, const double b, const double c)
    {
      return { { { a, 0., 0. }, { 0., b, 0. }, { 0., 0., c } } };
    }

    /// The case of a law, whose name includes the law's unless that is the default one.
    Case
    case_at(const CellLaw          law,
            const std::string     &name,
            const std::string     &state,
            const Matrix3<double> &F,
            const double           amplitude)
    {
      const std::string strain     = traits_of(law).name;
      const bool        is_default = law == ModelParameters().strain;
      return { "derivatives-" + (is_default ? "" : strain + "-") + name,
               "central differences, 4th order, " + (is_default ? "" : strain + " strain, ") + state
                   + "; doc/model.md, Eqs. (16) to (20)",
               [=, model = section("Model", set("Strain", strain))]
               { return derivatives_at(F, amplitude, model); } };
    }
  } // namespace

  std::vector<Case>
  derivative_cases()
  {
    const Matrix3<double> I         = identity_matrix<double>();
    const Matrix3<double> Q         = rotation_about({ { 1., 2., -1. } }, 0.8);
    const Matrix3<double> half_turn = rotation_about({ { 3., 1., 1. } }, 179.9 * M_PI / 180.);
    const Matrix3<double> flat      = Q * diagonal(1.3, 0.8, 0.),
                          mirrored  = Q * diagonal(1.5, 1.2, -0.4);
    std::vector<Case> all;
    for (const CellLaw law : all_laws())
      if (traits_of(law).is_strain())
        for (const Case &of_law :
             { case_at(law, "rest", "at rest", I, 0.), case_at(law, "random", "at random", I, 0.1),
               case_at(law, "turned", "turned by 179.9 degrees", half_turn, 0.03),
               case_at(law, "flat", "flattened into a plane", flat, 0.03),
               case_at(law, "inverted", "mirrored", mirrored, 0.02) })
          all.push_back(of_law);
    const CellLaw law = ModelParameters().strain;
    all.push_back(case_at(law, "guarded", "mirrored where the guard acts",
                          Q * diagonal(1.1, 0.7, -0.5), 0.01));
    all.push_back(case_at(law, "compressed", "compressed", Q * diagonal(0.6, 0.55, 0.5), 0.02));
    all.push_back(
        { "derivatives-frozen",
          "central differences with kept rotations, at random; doc/model.md, Eqs. (6) to (9)",
          frozen_derivatives });
    all.push_back(
        { "derivatives-two-elasticities",
          "central differences, and the energy summed up cell by cell, of examples with an "
          "elasticity of their own; doc/model.md, Eq. (38)",
          derivatives_of_two_elasticities });
    return all;
  }
} // namespace Exemplar::Verification
