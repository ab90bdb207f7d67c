// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/body/supports.h>
#include <exemplar/kernels/cell_model.h>
#include <exemplar/run/space_error_estimator.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// The scene in quadratic elements, of which a system is solved and no step is made.
    SceneParameters
    quadratic_scene(SceneParameters scene)
    {
      scene.model.element = Element::P2;
      if (traits_of(scene.model.strain).has_patches)
        scene.model.dilatation = DilatationKind::patches;
      scene.initial                = InitialParameters();
      scene.output                 = OutputParameters();
      scene.output.every           = 0;
      scene.time.scheme            = TimeScheme::implicit_euler;
      scene.time.mass_damping      = 0.;
      scene.time.stiffness_damping = 0.;
      return scene;
    }

    /// Of a linear field: in the middle of an edge the mean of its ends.
    Vector
    on_quadratic_nodes(const FESpace &fe_space, const Vector &linear)
    {
      Vector field(fe_space.n_dofs());
      for (unsigned int dof = 0; dof < field.size(); ++dof)
        if (dof < linear.size())
          field[dof] = linear[dof];
        else
          for (const unsigned int end : fe_space.edge_of(dof / 3))
            field[dof] += 0.5 * linear[3 * end + dof % 3];
      return field;
    }

    /// The forces on linear shape functions, which are sums of quadratic ones [N].
    Vector
    on_linear_nodes(const FESpace &fe_space, const Vector &quadratic, const unsigned int n_dofs)
    {
      Vector forces(n_dofs);
      for (unsigned int dof = 0; dof < quadratic.size(); ++dof)
        if (dof < n_dofs)
          forces[dof] += quadratic[dof];
        else
          for (const unsigned int end : fe_space.edge_of(dof / 3))
            forces[3 * end + dof % 3] += 0.5 * quadratic[dof];
      return forces;
    }

    /// The step of implicit Euler [s] in which an error's inertia is that of one which has grown
    /// with the square of time since the scene began: d'' = 2 d / t^2.
    double
    growth_time(const Problem &problem)
    {
      return std::max(problem.state.time, problem.time_axis.step_size(1)) / std::sqrt(2.);
    }

    /// What the forces would accelerate free nodes by, with the mass of each lumped [m/s^2].
    Vector
    accelerations(const Problem &problem, const Vector &gradient)
    {
      Vector ones(gradient.size());
      ones              = 1.;
      const Vector mass = problem.actions.mass->times(ones);
      Vector       a(gradient.size());
      for (const unsigned int dof : problem.constraints.free_dofs.list())
        a[dof] = -gradient[dof] / mass[dof];
      return a;
    }

    /// (sum V |u|^2)^(1/2) with the volume of each node [m^(5/2)].
    double
    norm(const FESpace &fe_space, const Vector &u)
    {
      const NodeShares    shares = shares_in_cell(fe_space.element(), ShareRule::lumped);
      std::vector<double> volumes(fe_space.n_nodes(), 0.);
      for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
        fe_space.share_out(fe_space.cell_volume(cell), shares, cell, volumes);
      double sum = 0.;
      for (unsigned int dof = 0; dof < u.size(); ++dof)
        sum += volumes[dof / 3] * u[dof] * u[dof];
      return std::sqrt(sum);
    }

    /// From the rest pose; of a body that nothing holds, from where a rigid motion brings that
    /// nearest.
    Vector
    displacement(const Problem &quadratic, const Vector &positions)
    {
      Vector rest = quadratic.body.fe_space.rest_positions();
      if (quadratic.constraints.handles == nullptr)
        align(positions, rest);
      Vector u = positions;
      u -= rest;
      return u;
    }

    /// Of the strain that a small displacement from `positions` makes, by cell [J/m^3].
    std::vector<double>
    energy_densities(const Problem &quadratic, const Vector &positions, const Vector &displacement)
    {
      const FESpace      &fe_space    = quadratic.body.fe_space;
      const bool          has_patches = quadratic.body.patches != nullptr;
      std::vector<double> densities(fe_space.n_cells(), 0.), traces(fe_space.n_cells(), 0.);
      for (unsigned int point = 0; point < fe_space.n_points(); ++point)
      {
        const unsigned int          cell = fe_space.cell_of(point);
        const CellMaterial<double> &C    = quadratic.body.material.elasticity(cell);
        const double                part = fe_space.volume(point) / fe_space.cell_volume(cell);
        const Matrix3<double>       F    = fe_space.deformation_gradient(point, positions);
        // the change of R^T F, of Green's strain that of F^T F / 2
        const StrainMeasure   strain = quadratic.parameters.model.strain;
        const Matrix3<double> R = strain == StrainMeasure::green ? F : model_rotation(strain, F);
        const Matrix3<double> e = symmetric_part(
            transpose_times(R, fe_space.deformation_gradient(point, displacement)));
        densities[cell]
            += 0.5 * part * contract(stress(has_patches ? C.without_dilatation() : C, e), e);
        traces[cell] += part * trace(e);
      }
      for (unsigned int cell = 0; has_patches && cell < densities.size(); ++cell)
        densities[cell]
            += 0.5 * quadratic.body.material.elasticity(cell).lambda * traces[cell] * traces[cell];
      return densities;
    }
  } // namespace

  struct SpaceErrorEstimator::Correction
  {
    State          from;  ///< of the linear elements
    BorderedVector step;  ///< the system's solution
    Vector         moves; ///< displacements by it [m]
    State          to;
    Evaluation     corrected;
    double         work;            ///< of loads and inertia along it [J]
    double         change;          ///< of the quadratic elements' potential [J]
    double         expected_change; ///< by the tangent [J]
  };

  SpaceErrorEstimator::SpaceErrorEstimator(Problem &problem) : problem(problem) {}

  SpaceErrorEstimator::~SpaceErrorEstimator() = default;

  State
  SpaceErrorEstimator::take_over(const Evaluation &linear)
  {
    const FESpace &fe_space = quadratic->body.fe_space;
    State          at;
    at.step      = problem.state.step;
    at.positions = on_quadratic_nodes(fe_space, problem.state.positions);
    at.weights   = problem.state.weights;
    quadratic->potential.set_time(problem.state.time, at);
    Vector inertia(fe_space.n_dofs());
    if (problem.actions.mass != nullptr)
    {
      // a step from where its mass pulls with the force M a
      const double time  = growth_time(problem);
      const Vector a     = on_quadratic_nodes(fe_space, accelerations(problem, linear.gradient));
      State        start = at;
      start.velocities   = a;
      start.velocities *= -time;
      quadratic->potential.begin_step(start, time);
      inertia = quadratic->actions.mass->times(a);
    }
    quadratic->potential.evaluate(at, RotationUse::update, quadratic->evaluation);
    // linear shape functions see the equilibrium that the linear elements have
    const Vector seen = on_linear_nodes(fe_space, inertia, linear.gradient.size());
    for (const unsigned int dof : problem.constraints.free_dofs.list())
      quadratic->evaluation.gradient[dof] -= linear.gradient[dof] + seen[dof];
    return at;
  }

  SpaceErrorEstimator::Correction
  SpaceErrorEstimator::correct(const Evaluation &linear)
  {
    Correction result;
    result.from = take_over(linear);
    try
    {
      // the energy has to change as the tangent says, to half of that
      solve(0., result);
      if (std::abs(result.change - result.expected_change)
          <= 0.5 * std::abs(result.expected_change))
        return result;
    }
    catch (const SolverFailure &) // the exact tangent is not definite
    {
    }
    result.from = take_over(linear);
    solve(1., result);
    return result;
  }

  void
  SpaceErrorEstimator::solve(const double convexity, Correction &result)
  {
    StepSystem       &system = quadratic->system;
    const Evaluation &from   = quadratic->evaluation;
    system.factorize(result.from.positions, result.from.weights, convexity);
    result.step  = system.solve(result.from, from);
    result.moves = system.displacement(result.from, result.step);
    if (problem.constraints.handles == nullptr)
      remove_rigid_motion(result.from.positions, result.moves);
    result.to = result.from;
    system.add(result.step, result.to);
    result.expected_change = 0.5 * (from.gradient * result.moves);
    for (std::size_t i = 0; i < result.step.weights.size(); ++i)
      result.expected_change += 0.5 * from.elastic.weight_gradient[i] * result.step.weights[i];
    // the work of loads and inertia, which are taken as constant
    Vector forces = from.gradient;
    forces -= from.elastic.gradient;
    result.work = -(forces * result.moves);
    quadratic->potential.evaluate(result.to, RotationUse::update, result.corrected);
    result.change = result.corrected.elastic.energy - from.elastic.energy - result.work;
  }

  SpaceError
  SpaceErrorEstimator::estimate()
  {
    SpaceError error;
    try
    {
      if (quadratic == nullptr)
        quadratic = std::make_unique<Problem>(quadratic_scene(problem.parameters), *problem.inputs);
      const FESpace &fe_space = quadratic->body.fe_space;
      Evaluation     linear;
      problem.potential.leave_step();
      problem.potential.evaluate(problem.state, RotationUse::update, linear);
      const Correction correction = correct(linear);
      Vector           u          = displacement(*quadratic, correction.from.positions);
      u += correction.moves;
      const auto over
          = [](const double part, const double whole) { return part > 0. ? part / whole : 0.; };
      error.displacement = over(norm(fe_space, correction.moves), norm(fe_space, u));
      const ElasticEvaluation &corrected = correction.corrected.elastic;
      error.energy = over(std::abs(corrected.energy - linear.elastic.energy - correction.work),
                          corrected.energy_elastic);
      if (quadratic->potential.unknown_weights() != nullptr)
      {
        error.weights = 0.;
        for (const double w : correction.step.weights)
          error.weights = std::max(*error.weights, std::abs(w));
      }
      error.energy_density
          = energy_densities(*quadratic, correction.from.positions, correction.moves);
      if (!std::isfinite(error.displacement + error.energy + error.weights.value_or(0.)))
        throw SolverFailure("its numbers are not finite");
    }
    catch (const SolverFailure &failure)
    {
      error         = SpaceError();
      error.failure = failure.what();
    }
    return error;
  }
} // namespace Exemplar
