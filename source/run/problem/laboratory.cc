// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/problem/problem.h>

#include <algorithm>
#include <numeric>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    Matrix3<double>
    transposed(const Matrix3<double> &A)
    {
      Matrix3<double> I{};
      for (int i = 0; i < 3; ++i)
        I[i][i] = 1.;
      return transpose_times(A, I);
    }

    std::unique_ptr<TimeIntegrator>
    copy_of(const std::unique_ptr<TimeIntegrator> &integrator)
    {
      return integrator == nullptr ? nullptr : std::make_unique<TimeIntegrator>(*integrator);
    }

    /// The terms of the scene, and then user-defined ones, which are also appended to `own`.
    PotentialTerms
    make_all_terms(const Problem                &problem,
                   ElasticPotential             &cells,
                   const TimeIntegrator         *integrator,
                   std::vector<PotentialTerm *> &own)
    {
      PotentialTerms terms = problem.actions.make_terms(problem.body, &cells, integrator);
      for (const OwnTerm &term : problem.actions.own_terms)
      {
        terms.push_back(term.make());
        own.push_back(terms.back().get());
      }
      return terms;
    }

    /// Copy the state of a term to another of the same kind.
    void
    copy_memory(const PotentialTerm &from, PotentialTerm &to)
    {
      std::stringstream bytes;
      {
        boost::archive::binary_oarchive archive(bytes);
        from.save(archive);
      }
      boost::archive::binary_iarchive archive(bytes);
      to.load(archive);
    }

    const Body &
    undivided(const Problem &problem)
    {
      if (problem.body.exchange().n_processes() > 1)
        throw UserError("Energies, forces and matrices at any place are for one process: start the "
                        "program without mpirun.");
      return problem.body;
    }

    /// The inverse of H for active weights, bordered by the sums of their regions; its first rows
    /// and columns are those of the weights.
    dealii::FullMatrix<double>
    bordered_inverse(const WeightForm &form, const std::vector<unsigned int> &active)
    {
      std::vector<unsigned int> sums;
      for (unsigned int r = 0; r < form.N.m(); ++r)
        if (std::any_of(active.begin(), active.end(),
                        [&](const unsigned int i) { return form.N(r, i) != 0.; }))
          sums.push_back(r);
      const unsigned int         m    = active.size();
      const double               unit = form.H.frobenius_norm(); // scale of the bordering rows
      dealii::FullMatrix<double> bordered(m + sums.size(), m + sums.size());
      for (unsigned int i = 0; i < m; ++i)
      {
        for (unsigned int j = 0; j < m; ++j)
          bordered(i, j) = form.H(active[i], active[j]);
        for (unsigned int r = 0; r < sums.size(); ++r)
          bordered(i, m + r) = bordered(m + r, i) = unit * form.N(sums[r], active[i]);
      }
      try
      {
        bordered.gauss_jordan();
      }
      catch (const dealii::ExceptionBase &)
      {
        throw SolverFailure(
            "The weights do not minimise the energy in one place alone: the "
            "examples depend on each other. Give Examples/Weight penalty a number.");
      }
      return bordered;
    }
  } // namespace

  Laboratory::Laboratory(Problem &problem)
      : problem(problem),
        weights(problem.parameters.examples,
                problem.examples.poses,
                unit_energy_of_examples(undivided(problem).fe_space, problem.body.material),
                problem.time_axis),
        integrator(copy_of(problem.actions.integrator)),
        free_dofs(problem.body.fe_space.n_dofs(), {}, problem.body.exchange()),
        cells(elastic_parts(
            problem.parameters, problem.body, problem.examples.poses, weights, free_dofs)),
        potential(cells,
                  weights,
                  free_dofs,
                  make_all_terms(problem, cells, integrator.get(), own_terms),
                  integrator.get())
  {
  }

  void
  Laboratory::follow_parameters()
  {
    weights.set_parameters(problem.parameters.examples,
                           unit_energy_of_examples(problem.body.fe_space, problem.body.material));
    potential.follow_parameters();
  }

  Place
  Laboratory::here() const
  {
    return { problem.state.positions, problem.state.weights };
  }

  void
  Laboratory::stand()
  {
    StepInterval step{ problem.state.time, 0. };
    if (integrator != nullptr)
    {
      step = next_step(problem);
      integrator->set_damping(problem.parameters.time.mass_damping,
                              problem.parameters.time.stiffness_damping);
    }
    const auto &originals = problem.actions.own_terms;
    for (std::size_t i = 0; i < own_terms.size(); ++i)
      copy_memory(*originals[i].term, *own_terms[i]);
    potential.get_tangent().follow_couplings();
    potential.begin_step(problem.state, step.size);
    State at   = {};
    at.weights = problem.state.weights;
    potential.set_time(step.end, at);
  }

  const Evaluation &
  Laboratory::evaluate(const Place &at)
  {
    stand();
    State state;
    state.positions = at.positions;
    state.weights   = at.weights;
    potential.evaluate(state, RotationUse::update, evaluation);
    potential.renew(state, evaluation, true);
    return evaluation;
  }

  void
  Laboratory::assemble(const Place &at, const Tangent kind)
  {
    evaluate(at); // finds the rotations
    potential.get_tangent().follow_gaps(at.positions, PotentialTangent::Terms::all);
    values.resize(potential.get_tangent().get_pattern().n_values());
    potential.get_tangent().assemble(at.positions, at.weights, kind == Tangent::convex ? 1. : 0.,
                                     values, columns);
  }

  RowMatrix
  Laboratory::hessian(const Place &at, const Tangent kind)
  {
    assemble(at, kind);
    return rows.with(potential.get_tangent().get_pattern(), values);
  }

  void
  Laboratory::require_unknown_weights() const
  {
    if (weights.n_unknown() == 0)
      throw UserError(
          weights.are_prescribed()
              ? "Examples/Weights = prescribed: the weights are no unknowns, so that Phi has no "
                "derivative by them. Take Examples/Weights = simplex, additive or free."
              : "The scene has no examples, hence no weights. Give Examples/Poses and an "
                "Importance above 0.");
  }

  std::vector<double>
  Laboratory::weight_gradient(const Place &at)
  {
    require_unknown_weights();
    return evaluate(at).elastic.weight_gradient;
  }

  std::vector<double>
  Laboratory::coupling(const Place &at, const Tangent kind)
  {
    require_unknown_weights();
    assemble(at, kind);
    const std::size_t   n       = free_dofs.n_dofs();
    const auto         &coupled = weights.weight_form().coupled;
    std::vector<double> all(n * weights.size(), 0.);
    for (std::size_t i = 0; i < coupled.size(); ++i)
      std::copy_n(columns.begin() + i * n, n, all.begin() + coupled[i] * n);
    return all;
  }

  dealii::FullMatrix<double>
  Laboratory::weight_hessian()
  {
    require_unknown_weights();
    stand();
    return weights.weight_form().H;
  }

  std::vector<unsigned int>
  Laboratory::weights_in_motion(const Place &at)
  {
    const std::vector<double> slope  = evaluate(at).elastic.weight_gradient;
    const std::vector<double> lambda = weights.residual(at.weights, slope).multipliers;
    std::vector<unsigned int> active;
    for (unsigned int i = 0; i < weights.size(); ++i)
    {
      const auto   slopes = weights.get_memory().slopes(i, at.weights[i], slope[i]);
      const double l      = lambda.empty() ? 0. : lambda[i / weights.n_per_region()];
      const bool   sticks = slopes.up > slopes.down && slopes.up + l > 0. && slopes.down + l < 0.;
      if (weights.is_off_bounds(at.weights[i]) && !sticks)
        active.push_back(i);
    }
    return active;
  }

  dealii::FullMatrix<double>
  Laboratory::weight_compliance(const Place &at)
  {
    dealii::FullMatrix<double> compliance(weights.size(), weights.size());
    if (weights.n_unknown() == 0)
      return compliance;
    const std::vector<unsigned int> active = weights_in_motion(at);
    if (active.empty())
      return compliance;
    const auto inverse = bordered_inverse(weights.weight_form(), active);
    for (unsigned int i = 0; i < active.size(); ++i)
      for (unsigned int j = 0; j < active.size(); ++j)
        compliance(active[i], active[j]) = inverse(i, j);
    return compliance;
  }

  CellMeans
  Laboratory::cell_means(const Place &at)
  {
    evaluate(at);
    const FESpace &fe_space = problem.body.fe_space;
    CellMeans      means;
    means.det_F = cells.cell_results(at.positions, at.weights).det_F; // updates cells, too
    means.strains.resize(fe_space.n_cells());
    means.stresses.resize(fe_space.n_cells());
    const CellField &field = cells.get_field();
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      const unsigned int cell = fe_space.cell_of(point);
      const double       part = fe_space.volume(point) / fe_space.cell_volume(cell);
      const CellLaw      law  = field.get_batches().law(point);
      LawInput<double>   in
          = field.law_input(point, fe_space.deformation_gradient(point, at.positions));
      in.target         = problem.examples.poses.strain(point, at.weights);
      Matrix3<double> T = law_functions<double>(law).stress(in);
      for (int i = 0; i < 3; ++i)
        T[i][i] += in.pressure;
      const Matrix3<double> turned = in.R * transposed(in.R * T); // T is symmetric
      means.strains[cell]  = combine(1., means.strains[cell], part, model_strain(law, in.R, in.F));
      means.stresses[cell] = combine(1., means.stresses[cell], part, turned);
    }
    return means;
  }

  std::vector<Matrix3<double>>
  Laboratory::example_strains() const
  {
    const FESpace               &fe_space = problem.body.fe_space;
    const ExamplePoses          &poses    = problem.examples.poses;
    const unsigned int           n        = fe_space.n_cells();
    std::vector<Matrix3<double>> all(std::size_t(n) * poses.size());
    for (unsigned int i = 0; i < poses.size(); ++i)
      for (unsigned int point = 0; point < fe_space.n_points(); ++point)
      {
        const unsigned int cell = fe_space.cell_of(point);
        Matrix3<double>   &mean = all[std::size_t(i) * n + cell];
        mean = combine(1., mean, fe_space.volume(point) / fe_space.cell_volume(cell),
                       poses.strain(point, i));
      }
    return all;
  }
} // namespace Exemplar
