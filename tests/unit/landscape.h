// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_landscape_h
#define exemplar_tests_landscape_h

#include <exemplar/solvers/step_solver.h>

#include "body.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>

// Steps with two unknowns of which the solution is known.
namespace Exemplar::Testing
{
  /// A potential of two distances from rest a and b [m], with a tangent without mixed derivatives.
  struct Landscape
  {
    using Pair = std::array<double, 2>;

    std::function<double(double a, double b)> energy;
    std::function<Pair(double a, double b)>   gradient;
    std::function<Pair(double a, double b)>   curvature; ///< of the exact tangent
    std::function<Pair(double a, double b)>   convex;    ///< of the convex one

    /// Of steps from (a, b) by (da, db); empty where none is bounded.
    std::function<double(double a, double b, double da, double db)> max_step = {};
  };

  /// f(a) + b^2 / 2, with this convex curvature along a.
  inline Landscape
  valley(const std::function<double(double)> &f,
         const std::function<double(double)> &first,
         const std::function<double(double)> &second,
         const double                         convex)
  {
    using Pair = Landscape::Pair;
    return { [=](const double a, const double b) { return f(a) + 0.5 * b * b; },
             [=](const double a, const double b) {
               return Pair{ { first(a), b } };
             },
             [=](const double a, double) {
               return Pair{ { second(a), 1. } };
             },
             [=](double, double) {
               return Pair{ { convex, 1. } };
             } };
  }

  /// The same with walls at a = -wall and a = wall, of which a step goes nine tenths of the way.
  /// `was_beyond` becomes true when the energy there is asked for.
  inline Landscape
  between_walls(Landscape landscape, const double wall, bool &was_beyond)
  {
    landscape.energy = [=, inner = landscape.energy, &was_beyond](const double a, const double b)
    {
      was_beyond |= std::abs(a) > (1. + 1e-12) * wall; // steps add up to the whole way
      return inner(a, b);
    };
    landscape.max_step = [=](const double a, double, const double da, double)
    {
      return da == 0. ? std::numeric_limits<double>::infinity()
                      : 0.9 * ((da > 0. ? wall : -wall) - a) / da;
    };
    return landscape;
  }

  /// The landscape over two degrees of freedom. The scale of its forces is 1 N.
  class LandscapeTerm : public PotentialTerm
  {
  public:
    LandscapeTerm(const Landscape                   &landscape,
                  const Vector                      &rest,
                  const std::array<unsigned int, 2> &dofs)
        : landscape(landscape), rest(rest), dofs(dofs)
    {
    }

    std::string
    name() const override
    {
      return "landscape";
    }

    void
    attach(const SymmetricPattern &pattern, const FreeDofs &free_dofs) override
    {
      for (unsigned int i = 0; i < 2; ++i)
        diagonal[i]
            = pattern.position(free_dofs.free_index(dofs[i]), free_dofs.free_index(dofs[i]));
    }

    void
    add(const TermPoint &at, ElasticSums &sums) override
    {
      const double a = distance(at, 0), b = distance(at, 1);
      const auto   force = landscape.gradient(a, b);
      for (unsigned int i = 0; i < 2; ++i)
      {
        sums->gradient[dofs[i]] += force[i];
        sums->force_scale[dofs[i] / 3] += 1.;
      }
      sums->energy += landscape.energy(a, b);
    }

    void
    add_tangent(const TermPoint     &at,
                const Tangent        kind,
                std::vector<double> &values,
                std::vector<double> &) override
    {
      const double a = distance(at, 0), b = distance(at, 1);
      const auto   curvature
          = kind == Tangent::exact ? landscape.curvature(a, b) : landscape.convex(a, b);
      for (unsigned int i = 0; i < 2; ++i)
        values[diagonal[i]] += curvature[i];
    }

    double
    max_step(const Vector &positions, const Vector &displacement) const override
    {
      if (!landscape.max_step)
        return std::numeric_limits<double>::infinity();
      return landscape.max_step(positions[dofs[0]] - rest[dofs[0]],
                                positions[dofs[1]] - rest[dofs[1]], displacement[dofs[0]],
                                displacement[dofs[1]]);
    }

    std::size_t
    memory_consumption() const override
    {
      return 0;
    }

  private:
    double
    distance(const TermPoint &at, const unsigned int i) const
    {
      return at.positions[dofs[i]] - rest[dofs[i]];
    }

    const Landscape                   landscape;
    const Vector                     &rest;
    const std::array<unsigned int, 2> dofs;
    std::array<int, 2>                diagonal;
  };

  /// A bar 4 m long that is so soft that it counts for nothing, held but for one degree of freedom at
  /// each end.
  class TwoUnknowns
  {
  public:
    TwoUnknowns(const Landscape &landscape, const double a, const double b)
        : TwoUnknowns(std::vector<Landscape>{ landscape }, a, b)
    {
    }

    TwoUnknowns(const std::vector<Landscape> &landscapes, const double a, const double b)
        : body(box_mesh(4., 4, 1), soft()), dofs{ { 0, body.fe_space.n_dofs() - 1 } },
          free_dofs(body.fe_space.n_dofs(), all_but_two(), Exchange::serial()),
          none(body.examples(ExampleParameters())),
          handles({}, body.mesh, body.fe_space, TimeAxis::of_increments(TimeParameters())),
          cells({ CellLaw::linear, body.fe_space, body.material, body.material, no_patches(),
                  *none.poses, *none.weights, free_dofs }),
          potential(cells, *none.weights, free_dofs, terms(landscapes), nullptr),
          system(
              potential, [this] { return plain_system(); }, clock, false)
    {
      state.positions = body.fe_space.rest_positions();
      state.velocities.reinit(state.positions.size());
      state.positions[dofs[0]] += a;
      state.positions[dofs[1]] += b;
      potential.set_time(0., state);
      potential.evaluate(state, RotationUse::update, evaluation);
    }

    SolveReport
    solve(const SolverParameters &parameters, std::function<bool(const SolveReport &)> observe = {})
    {
      const auto solver = make_step_solver(parameters, potential, system, handles, clock);
      solver->observe   = std::move(observe);
      return solver->solve(state, evaluation, 1., 1.);
    }

    double
    a() const
    {
      return distance(0);
    }

    double
    b() const
    {
      return distance(1);
    }

    const Body                        body;
    const std::array<unsigned int, 2> dofs; ///< of a and b
    const FreeDofs                    free_dofs;
    StepClock                         clock{ Phase::evaluate };
    const Examples                    none;
    const Handles                     handles;
    ElasticPotential                  cells;
    IncrementalPotential              potential;
    StepSystem                        system;
    State                             state;
    Evaluation                        evaluation;

  private:
    static MaterialParameters
    soft()
    {
      MaterialParameters parameters;
      parameters.everywhere.youngs_modulus = 1e-12;
      return parameters;
    }

    std::vector<unsigned int>
    all_but_two() const
    {
      std::vector<unsigned int> held;
      for (unsigned int dof = 1; dof + 1 < body.fe_space.n_dofs(); ++dof)
        held.push_back(dof);
      return held;
    }

    PotentialTerms
    terms(const std::vector<Landscape> &landscapes) const
    {
      PotentialTerms result;
      for (const Landscape &landscape : landscapes)
        result.push_back(
            std::make_unique<LandscapeTerm>(landscape, body.fe_space.rest_positions(), dofs));
      return result;
    }

    std::unique_ptr<BorderedSystem>
    plain_system() const
    {
      auto matrix = make_cholesky_operator();
      matrix->reinit(potential.get_tangent().get_pattern());
      return make_block_system(std::move(matrix), none.weights->weight_form(), Exchange::serial());
    }

    double
    distance(const unsigned int i) const
    {
      return state.positions[dofs[i]] - body.fe_space.rest_positions()[dofs[i]];
    }
  };

  inline SolverParameters
  by_method(const Method method, const double tolerance = 1e-9)
  {
    SolverParameters parameters;
    parameters.method         = method;
    parameters.tolerance      = tolerance;
    parameters.step_tolerance = 0.;
    return parameters;
  }
} // namespace Exemplar::Testing

#endif
