// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/body/laws_of_cells.h>
#include <exemplar/body/supports.h>
#include <exemplar/run/problem/space_error_estimator.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>

namespace Exemplar
{
  namespace
  {
    /// An energy that is nothing but rounding, over that of a strain of 1.
    constexpr double rounding_of_energy = 1e-20;

    /// The scene in quadratic elements, for solving one system without steps.
    SceneParameters
    quadratic_scene(SceneParameters scene)
    {
      scene.model.element = richer(scene.model.element);
      if (traits_of(scene.model.law()).trace_gradient_is_R)
        scene.model.dilatation = DilatationKind::patches;
      scene.initial                = InitialParameters();
      scene.output                 = OutputParameters();
      scene.output.every           = 0;
      scene.time.scheme            = TimeScheme::implicit_euler;
      scene.time.mass_damping      = 0.;
      scene.time.stiffness_damping = 0.;
      return scene;
    }

    /// Interpolate a linear field at quadratic nodes: means at edge midpoints.
    Vector
    on_quadratic_nodes(const FESpace &fe_space, const Vector &linear)
    {
      Vector field(fe_space.n_dofs());
      for (unsigned int dof = 0; dof < field.size(); ++dof)
        if (dof < linear.size())
          field[dof] = linear[dof];
        else
          for (const unsigned int end : fe_space.numbering().ends(dof / 3))
            field[dof] += 0.5 * linear[3 * end + dof % 3];
      return field;
    }

    /// Copy the law's history of the one point of each linear cell to all points of the quadratic
    /// one.
    std::vector<double>
    on_quadratic_points(const std::vector<double> &linear, const unsigned int n_cells)
    {
      std::vector<double> history;
      for (unsigned int cell = 0; cell < n_cells; ++cell)
        for (unsigned int point = 0; point < points_per_cell(Element::P2); ++point)
          history.insert(history.end(), linear.begin() + linear.size() / n_cells * cell,
                         linear.begin() + linear.size() / n_cells * (cell + 1));
      return history;
    }

    /// Restrict forces to linear shape functions, which are sums of quadratic ones [N].
    Vector
    on_linear_nodes(const FESpace &fe_space, const Vector &quadratic, const unsigned int n_dofs)
    {
      Vector forces(n_dofs);
      for (unsigned int dof = 0; dof < quadratic.size(); ++dof)
        if (dof < n_dofs)
          forces[dof] += quadratic[dof];
        else
          for (const unsigned int end : fe_space.numbering().ends(dof / 3))
            forces[3 * end + dof % 3] += 0.5 * quadratic[dof];
      return forces;
    }

    /// Length of an implicit Euler step [s] whose inertia is that of an error that has grown with
    /// the square of time since the scene began: d'' = 2 d / t^2.
    double
    growth_time(const Problem &problem)
    {
      return std::max(problem.state.time, problem.time_axis.step_size(1)) / std::sqrt(2.);
    }

    /// Accelerations of free nodes by the forces, with lumped masses [m/s^2].
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

    /// (sum V |u|^2)^(1/2) with the volumes V of the nodes [m^(5/2)].
    double
    norm(const FESpace &fe_space, const Vector &u)
    {
      std::vector<double> volumes(fe_space.n_nodes(), 0.);
      for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
        fe_space.share_out(fe_space.cell_volume(cell), ShareRule::lumped, cell, volumes);
      double sum = 0.;
      for (unsigned int dof = 0; dof < u.size(); ++dof)
        sum += volumes[dof / 3] * u[dof] * u[dof];
      return std::sqrt(sum);
    }

    /// Displacement from the rest pose; for a body that nothing holds, from the rest pose rigidly
    /// aligned with `positions`.
    Vector
    displacement(const Problem &quadratic, const Vector &positions)
    {
      Vector rest = quadratic.body.fe_space.rest_positions();
      if (quadratic.constraints.handles.size() == 0)
        align(positions, rest, quadratic.body.exchange());
      Vector u = positions;
      u -= rest;
      return u;
    }

    /// Energy densities of the strain by a small displacement from `positions`, by cell [J/m^3].
    std::vector<double>
    energy_densities(const Problem &linear,
                     const Problem &quadratic,
                     const Vector  &positions,
                     const Vector  &displacement)
    {
      const FESpace &fe_space = quadratic.body.fe_space;
      const Material rest     = quadratic.body.material.without_dilatation();
      // dilatations that vary within a patch are no error
      const Patches      &patches   = linear.body.patches;
      const bool          are_there = patches.size() > 0;
      std::vector<double> densities(fe_space.n_cells(), 0.);
      std::vector<double> traces(are_there ? patches.size() : fe_space.n_cells(), 0.);
      const auto          part_of
          = [&](const unsigned int cell) { return are_there ? patches.of_point(cell) : cell; };
      const auto volume_of = [&](const unsigned int cell)
      { return are_there ? patches.volume(patches.of_point(cell)) : fe_space.cell_volume(cell); };
      for (unsigned int point = 0; point < fe_space.n_points(); ++point)
      {
        const unsigned int    cell = fe_space.cell_of(point);
        const Matrix3<double> F    = fe_space.deformation_gradient(point, positions);
        const CellLaw         law  = quadratic.parameters.model.law();
        const Matrix3<double> e    = model_strain_change(
               law, model_rotation(law, F), F, fe_space.deformation_gradient(point, displacement));
        const Matrix3<double> T = model_stress(
            law, [&](const std::size_t k) { return rest.number(law, cell, k); }, e);
        densities[cell]
            += 0.5 * fe_space.volume(point) / fe_space.cell_volume(cell) * contract(T, e);
        traces[part_of(cell)] += fe_space.volume(point) / volume_of(cell) * trace(e);
      }
      for (unsigned int cell = 0; cell < densities.size(); ++cell)
        densities[cell] += 0.5 * std::abs(quadratic.body.material.lambda_of_patches(cell))
                           * traces[part_of(cell)] * traces[part_of(cell)];
      return densities;
    }
  } // namespace

  struct SpaceErrorEstimator::Correction
  {
    State      from;  ///< of the linear elements
    Vector     moves; ///< displacements from there [m]
    State      to;
    Evaluation at;        ///< the present state, with the forces that stay
    Vector     forces;    ///< added to all gradients [N]
    double     work = 0.; ///< of loads and inertia along the moves [J]
  };

  SpaceErrorEstimator::SpaceErrorEstimator(Problem &problem) : problem(problem) {}

  SpaceErrorEstimator::~SpaceErrorEstimator() = default;

  SpaceErrorEstimator::Correction
  SpaceErrorEstimator::take_over(const Evaluation &linear)
  {
    const FESpace &fe_space = quadratic->body.fe_space;
    State          at;
    at.step      = problem.state.step;
    at.positions = on_quadratic_nodes(fe_space, problem.state.positions);
    at.weights   = problem.state.weights;
    at.history   = on_quadratic_points(problem.state.history, fe_space.n_cells());
    quadratic->potential.leave_step(at);
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
    // linear shape functions see the equilibrium that the linear elements have
    const Vector seen = on_linear_nodes(fe_space, inertia, linear.gradient.size());
    Correction   result;
    result.forces.reinit(fe_space.n_dofs());
    for (const unsigned int dof : problem.constraints.free_dofs.list())
      result.forces[dof] = -linear.gradient[dof] - seen[dof];
    result.from = at;
    result.to   = at;
    result.moves.reinit(fe_space.n_dofs());
    result.at = evaluate(result);
    return result;
  }

  Evaluation
  SpaceErrorEstimator::evaluate(const Correction &correction)
  {
    Evaluation evaluation;
    quadratic->potential.evaluate(correction.to, RotationUse::update, evaluation);
    evaluation.gradient += correction.forces;
    evaluation.potential += correction.forces * correction.moves;
    return evaluation;
  }

  std::optional<bool>
  SpaceErrorEstimator::improve(Correction &correction)
  {
    try
    {
      if (const auto found = improve_by(Tangent::exact, correction))
        return found;
    }
    catch (const SolverFailure &) // the exact tangent is not definite
    {
    }
    return improve_by(Tangent::convex, correction);
  }

  std::optional<bool>
  SpaceErrorEstimator::improve_by(const Tangent tangent, Correction &correction)
  {
    quadratic->system.factorize(correction.to.positions, correction.to.weights,
                                tangent == Tangent::convex ? 1. : 0.);
    const BorderedVector step  = quadratic->system.solve(correction.to, correction.at);
    double               slope = quadratic->system.slope(correction.at, step);
    for (std::size_t i = 0; i < step.weights.size(); ++i)
    {
      const WeightMemory::Slopes slopes = quadratic->examples.weights.get_memory().slopes(
          i, correction.to.weights[i], correction.at.elastic.weight_gradient[i]);
      slope += (step.weights[i] > 0. ? slopes.up : slopes.down) * step.weights[i];
    }
    if (std::abs(slope)
        <= rounding_of_energy * unit_energy(quadratic->body.fe_space, quadratic->body.material))
      return false;
    // frozen forces have no energy that could tell how long the step may be
    const bool has_energy = !quadratic->parameters.model.is_frozen();
    for (double length = 1.; length > 0.05; length *= 0.5)
    {
      Correction     trial  = correction;
      BorderedVector scaled = step;
      for (auto *part : { &scaled.positions, &scaled.weights })
        for (double &entry : *part)
          entry *= length;
      Vector moves = quadratic->system.displacement(trial.to, scaled);
      if (problem.constraints.handles.size() == 0)
        remove_rigid_motion(trial.to.positions, moves, problem.body.exchange());
      trial.moves += moves;
      trial.to.positions += moves;
      quadratic->examples.weights.add(scaled.weights, trial.to.weights);
      trial.at              = evaluate(trial);
      const double decrease = correction.at.potential - trial.at.potential;
      if (has_energy && !(decrease >= -1e-4 * length * slope))
        continue;
      correction = std::move(trial);
      // where the potential is not quadratic, as the tangent assumes, a further step improves the
      // estimate
      const double expected = -length * (1. - 0.5 * length) * slope;
      return has_energy
             && std::abs(decrease - expected) > 1e-3 * correction.at.elastic.energy_elastic;
    }
    return {};
  }

  SpaceErrorEstimator::Correction
  SpaceErrorEstimator::correct(const Evaluation &linear)
  {
    Correction correction = take_over(linear);
    Vector     forces     = correction.at.gradient; // loads and inertia, which stay as they are
    forces -= correction.at.elastic.gradient;
    std::optional<bool> goes_on = improve(correction);
    if (!goes_on)
      throw SolverFailure("no step of quadratic elements leads to less energy");
    for (unsigned int iteration = 1; iteration < 10 && goes_on.value_or(false); ++iteration)
      goes_on = improve(correction);
    correction.work = -(forces * correction.moves);
    return correction;
  }

  SpaceError
  SpaceErrorEstimator::estimate()
  {
    SpaceError error;
    try
    {
      if (quadratic == nullptr)
        quadratic
            = std::make_unique<Problem>(quadratic_scene(problem.parameters), *problem.body.inputs);
      const FESpace &fe_space = quadratic->body.fe_space;
      Evaluation     linear;
      problem.potential.leave_step(problem.state);
      problem.potential.evaluate(problem.state, RotationUse::update, linear);
      const Correction correction = correct(linear);
      Vector           u          = displacement(*quadratic, correction.from.positions);
      u += correction.moves;
      const ElasticEvaluation &corrected = correction.at.elastic;
      // corrections below the rounding of a body at rest are no error
      const double length
          = 1e-10 * problem.body.mesh.diameter() * std::sqrt(fe_space.total_volume());
      const double energy = rounding_of_energy * unit_energy(fe_space, problem.body.material);
      const auto   over   = [](const double part, const double whole, const double minimum)
      { return part > minimum ? part / std::max(whole, part) : 0.; };
      error.displacement = over(norm(fe_space, correction.moves), norm(fe_space, u), length);
      error.energy = over(std::abs(corrected.energy - linear.elastic.energy - correction.work),
                          std::max(corrected.energy_elastic, corrected.energy), energy);
      if (quadratic->examples.weights.n_unknown() > 0)
      {
        error.weights = 0.;
        for (std::size_t i = 0; i < correction.to.weights.size(); ++i)
          error.weights = std::max(*error.weights,
                                   std::abs(correction.to.weights[i] - correction.from.weights[i]));
      }
      error.energy_density
          = energy_densities(problem, *quadratic, correction.from.positions, correction.moves);
      if (!std::isfinite(error.displacement + error.energy + error.weights.value_or(0.)))
        throw SolverFailure("its numbers are not finite");
    }
    catch (const std::bad_alloc &)
    {
      quadratic.reset();
      error         = SpaceError();
      error.failure = "there is not enough memory for quadratic elements";
    }
    catch (const std::runtime_error &failure) // UserError or SolverFailure
    {
      error         = SpaceError();
      error.failure = failure.what();
    }
    return error;
  }
} // namespace Exemplar
