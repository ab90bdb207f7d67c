// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/kernels/cell_model.h>
#include <exemplar/run/problem/balance.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Exemplar
{
  namespace
  {
    void
    refuse_balance(const std::string &why, const std::string &remedy)
    {
      throw UserError("Loads/Balanced = true, but " + why + ". " + remedy);
    }

    void
    check_balance(const SceneParameters &parameters,
                  const Body            &body,
                  const Constraints     &constraints,
                  const Loads           *loads)
    {
      const std::string without = " or set Loads/Balanced = false.";
      if (loads == nullptr)
        refuse_balance("no load acts on the body", "Set Loads/Gravity," + without);
      if (parameters.loads.ramp == LoadRamp::increments)
        refuse_balance("with Loads/Ramp = increments no load acts in the beginning",
                       "Set Loads/Ramp = none," + without);
      if (parameters.model.law() == CellLaw::green)
        refuse_balance("a body with Model/Strain = green cannot be",
                       "Set Model/Strain = corotational," + without);
      if (parameters.model.is_frozen())
        refuse_balance("a stress that turns with the cells needs Model/Gradient = consistent",
                       "Set that," + without);
      if (parameters.solver.linear_solver == LinearSolver::umfpack)
        refuse_balance("Solver/Linear solver = umfpack has no factor of the positions alone",
                       "Set Solver/Linear solver = auto," + without);
      const auto free_of_pieces
          = n_free_rigid_motions(body.mesh, body.fe_space, constraints.handles.held_dofs());
      if (const unsigned int n_free
          = *std::max_element(free_of_pieces.begin(), free_of_pieces.end());
          n_free > 0)
        refuse_balance(
            fmt::format("the handles leave {} of 6 rigid motions free in the beginning, so that "
                        "nothing bears the body",
                        n_free),
            "Hold its feet: add a handle that holds three nodes not on a line," + without);
    }

    /// C : sym M of the law of a point at rest, without the dilatation of patches.
    Matrix3<double>
    stress_at_rest(const CellBatches &batches, const unsigned int point, const Matrix3<double> &M)
    {
      const auto         I = identity_matrix<double>();
      LawTangent<double> tangent;
      law_functions<double>(batches.law(point))
          .tangent(batches.law_input(point, I, I), false, tangent);
      return symmetric_part(tangent.response(M));
    }

    /// The body at rest, without loads and inertia, whose linear stiffness answers to forces.
    class RestingBody
    {
    public:
      RestingBody(const SceneParameters &parameters,
                  const Body            &body,
                  Examples              &examples,
                  const FreeDofs        &free_dofs)
          : body(body), exchange(body.exchange()), free_dofs(free_dofs),
            weights(examples.weights.size(), 0.),
            cells(elastic_parts(parameters, body, examples.poses, examples.weights, free_dofs)),
            potential(
                cells,
                examples.weights,
                free_dofs,
                {},
                nullptr,
                is_assembled_in_parts(parameters.solver, body.fe_space, examples.weights.size())),
            system(make_bordered_system(parameters.solver, potential))
      {
        ElasticEvaluation evaluation; // finds the rotations
        cells.evaluate(rest(), weights, evaluation, RotationUse::update);
        assemble();
        if (!is_iterative())
          stiffness = system->matrix_values();
        coupling = system->columns();
        system->factorize(rest());
      }

      /// tau with sum V tau g = force on the free degrees of freedom, found by corrections.
      PointStresses
      stresses_of(const Vector &force)
      {
        PointStresses stresses(body.fe_space.n_points(), Matrix3<double>{});
        Vector        missing = force;
        double        before  = std::numeric_limits<double>::infinity();
        for (unsigned int correction = 0; correction < max_corrections; ++correction)
        {
          const double size = free_dofs.max_magnitude(missing);
          if (!(size > 0.) || !(size < 0.5 * before))
            break; // the rest is rounding
          before = size;
          add_stresses(displacement_of(missing), stresses);
          missing = force;
          missing -= forces_of(stresses);
        }
        return stresses;
      }

      /// The least factor of the elasticity at which the body is stable under these stresses, 1 if
      /// it is as it is; 1 also if the solver does not factorise.
      double
      least_factor(const PointStresses &stresses)
      {
        if (is_iterative())
          return 1.;
        InitialStressTerm term(cells.get_field(), body.fe_space, stresses);
        term.attach(potential.get_tangent().get_pattern(), free_dofs);
        std::vector<double> of_stresses(stiffness.size(), 0.), none;
        term.add_tangent({ rest(), weights }, Tangent::exact, of_stresses, none);
        double high = 1.;
        while (!stands(high, of_stresses) && high < 1e12)
          high *= 2.;
        if (high == 1.)
          return high;
        double low = 0.5 * high;
        while (high > 1.01 * low)
        {
          const double middle                        = std::sqrt(low * high);
          (stands(middle, of_stresses) ? high : low) = middle;
        }
        return high;
      }

    private:
      static constexpr unsigned int max_corrections  = 30;
      static constexpr double       rounding_of_sums = 1e-8;

      const Vector &
      rest() const
      {
        return body.fe_space.rest_positions();
      }

      /// Whether the system does not factorise.
      bool
      is_iterative() const
      {
        return system->outer_products() != nullptr;
      }

      void
      assemble()
      {
        potential.get_tangent().assemble(rest(), weights, 1., system->matrix_values(),
                                         system->columns(), system->outer_products());
        free_dofs.assemble_columns(system->columns(), system->weight_form().coupled.size());
      }

      Vector
      displacement_of(const Vector &force)
      {
        std::vector<double> unknowns;
        for (const unsigned int dof : free_dofs.list())
          unknowns.push_back(force[dof]);
        system->apply_inverse(unknowns);
        Vector displacement(force.size());
        for (std::size_t i = 0; i < unknowns.size(); ++i)
          displacement[free_dofs.list()[i]] = unknowns[i];
        exchange.share(displacement);
        return displacement;
      }

      void
      add_stresses(const Vector &displacement, PointStresses &stresses)
      {
        const FESpace &fe_space = body.fe_space;
        const Patches &patches  = body.patches;
        for (unsigned int point = 0; point < stresses.size(); ++point)
        {
          const Matrix3<double> M = fe_space.deformation_gradient(point, displacement);
          stresses[point]         = combine(1., stresses[point], 1.,
                                            stress_at_rest(cells.get_field().get_batches(), point, M));
        }
        for (unsigned int patch = 0; patch < patches.size(); ++patch)
        {
          double sum = 0.;
          for (const unsigned int point : patches.points(patch))
            sum += fe_space.volume(point)
                   * trace(fe_space.deformation_gradient(point, displacement));
          for (const unsigned int point : patches.points(patch))
            for (int i = 0; i < 3; ++i)
              stresses[point][i][i] += patches.lambda(patch) * sum / patches.volume(patch);
        }
      }

      Vector
      forces_of(const PointStresses &stresses) const
      {
        const FESpace      &fe_space = body.fe_space;
        Vector              sum(fe_space.n_dofs());
        std::vector<double> forces;
        for (unsigned int point = 0; point < stresses.size(); ++point)
        {
          fe_space.nodal_forces(point, stresses[point], forces);
          const auto nodes = fe_space.nodes(fe_space.cell_of(point));
          for (unsigned int a = 0; a < nodes.size(); ++a)
            for (unsigned int c = 0; c < 3; ++c)
              sum[3 * nodes[a] + c] += forces[3 * a + c];
        }
        exchange.assemble(sum.begin(), 3);
        return sum;
      }

      bool
      stands(const double factor, const std::vector<double> &of_stresses)
      {
        std::vector<double> &values = system->matrix_values();
        for (std::size_t i = 0; i < values.size(); ++i)
          values[i] = factor * stiffness[i] + of_stresses[i];
        try
        {
          system->factorize(rest());
        }
        catch (const SolverFailure &)
        {
          return false;
        }
        return stands_beside_examples(factor);
      }

      /// A small weight w_i > 0 changes the energy by S_ii w_i^2 / 2 with the Schur complement S,
      /// Eq. (11). If S_ii < 0 beyond rounding, the body slides towards the example.
      bool
      stands_beside_examples(const double factor)
      {
        const WeightForm &form = system->weight_form();
        if (form.coupled.empty())
          return true;
        std::vector<double> G = coupling;
        for (double &entry : G)
          entry *= factor;
        std::vector<double> Z = G;
        system->apply_inverse(Z);
        const auto S = make_schur_complement(form, G, Z.data(), free_dofs.list().size(), exchange);
        return std::all_of(form.coupled.begin(), form.coupled.end(),
                           [&](const unsigned int i)
                           {
                             const double H = form.H(i, i);
                             return S(i, i) + (factor - 1.) * H > -rounding_of_sums * factor * H;
                           });
      }

      const Body                           &body;
      const Exchange                       &exchange;
      const FreeDofs                       &free_dofs;
      const std::vector<double>             weights; ///< zero
      ElasticPotential                      cells;
      IncrementalPotential                  potential;
      const std::unique_ptr<BorderedSystem> system;
      std::vector<double> stiffness; ///< K; empty if the system does not factorise
      std::vector<double> coupling;  ///< G
    };

    /// Warning that the body is unstable, but stable with `factor` times this Young's modulus [Pa];
    /// `is_led`: with unknown weights of examples, which contribute to that.
    std::string
    warning_of_instability(const double factor, const double youngs_modulus, const bool is_led)
    {
      const std::string unstable = "Loads/Balanced: the rest pose is an equilibrium, but no stable "
                                   "one: the body",
                        who      = is_led ? ", with its examples, is" : " is",
                        or_else  = is_led ? "; or with less Examples/Importance." : ".";
      return unstable + who
             + fmt::format(" too soft for its loads and falls from there at the least disturbance. "
                           "It stands with {:.3g} times its stiffness: Material/Young's modulus = "
                           "{:.3g}, and those of regions and maps alike",
                           factor, factor * youngs_modulus)
             + or_else;
    }
  } // namespace

  PointStresses
  initial_stresses(const SceneParameters    &parameters,
                   const Body               &body,
                   Examples                 &examples,
                   const Constraints        &constraints,
                   const Loads              *loads,
                   std::vector<std::string> &warnings)
  {
    check_balance(parameters, body, constraints, loads);
    Vector force(body.fe_space.n_dofs());
    if (loads->has_named_loads())
      loads->named_loads(0., force);
    if (loads->has_gravity())
      force += loads->gravity();
    RestingBody         resting(parameters, body, examples, constraints.free_dofs);
    const PointStresses stresses = resting.stresses_of(force);
    if (const double factor = resting.least_factor(stresses); factor > 1.)
      warnings.push_back(warning_of_instability(
          factor, parameters.material.everywhere.youngs_modulus, examples.weights.n_unknown() > 0));
    return stresses;
  }
} // namespace Exemplar
