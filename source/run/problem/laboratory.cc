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

    /// Those of the scene, and then one's own, which `own` gets, too.
    PotentialTerms
    make_all_terms(const Problem                &problem,
                   const TimeIntegrator         *integrator,
                   std::vector<PotentialTerm *> &own)
    {
      PotentialTerms terms = problem.actions.make_terms(problem.body, integrator);
      for (const Problem::OwnTerm &term : problem.get_own_terms())
      {
        terms.push_back(term.make());
        own.push_back(terms.back().get());
      }
      return terms;
    }

    /// `to` remembers what `from` does.
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
  } // namespace

  Laboratory::Laboratory(Problem &problem)
      : problem(problem),
        weights(problem.parameters.examples,
                problem.examples.poses,
                unit_energy_of_examples(undivided(problem).fe_space, problem.body.material),
                problem.time_axis),
        integrator(copy_of(problem.actions.integrator)),
        free_dofs(problem.body.fe_space.n_dofs(), {}, problem.body.exchange()),
        potential({ laws_of_cells(problem.parameters, problem.body), problem.body.fe_space,
                    problem.body.material, problem.body.cell_material, problem.examples.poses,
                    weights, free_dofs, problem.parameters.solver.n_threads },
                  make_elastic_terms(problem.body, problem.examples),
                  make_all_terms(problem, integrator.get(), own_terms),
                  integrator.get())
  {
  }

  void
  Laboratory::follow_parameters()
  {
    if (!weights.are_prescribed())
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
    const auto &originals = problem.get_own_terms();
    for (std::size_t i = 0; i < own_terms.size(); ++i)
      copy_memory(*originals[i].term, *own_terms[i]);
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
    return evaluation;
  }

  void
  Laboratory::assemble(const Place &at, const Tangent kind)
  {
    evaluate(at); // which finds the rotations
    values.resize(potential.matrix_pattern().n_values());
    potential.assemble(at.positions, at.weights, kind == Tangent::convex ? 1. : 0., values,
                       columns);
  }

  void
  Laboratory::make_row_pattern()
  {
    const SymmetricPattern &lower          = potential.matrix_pattern();
    const auto              n              = static_cast<int>(lower.n());
    const auto              for_each_entry = [&](const auto &function)
    {
      // entries left of the diagonal ascend by the columns of `lower`, then those from it on do
      for (int column = 0; column < n; ++column)
        for (int entry = lower.column_start[column]; entry < lower.column_start[column + 1];
             ++entry)
          if (lower.row[entry] != column)
            function(lower.row[entry], column, entry);
      for (int column = 0; column < n; ++column)
        for (int entry = lower.column_start[column]; entry < lower.column_start[column + 1];
             ++entry)
          function(column, lower.row[entry], entry);
    };
    rows_version = lower.version;
    rows.row_start.assign(n + 1, 0);
    for_each_entry([&](const int row, int, int) { ++rows.row_start[row + 1]; });
    std::partial_sum(rows.row_start.begin(), rows.row_start.end(), rows.row_start.begin());
    rows.column.resize(rows.row_start[n]);
    source.resize(rows.row_start[n]);
    std::vector<int> next(rows.row_start.begin(), rows.row_start.end() - 1);
    for_each_entry(
        [&](const int row, const int column, const int entry)
        {
          rows.column[next[row]] = column;
          source[next[row]++]    = entry;
        });
  }

  RowMatrix
  Laboratory::hessian(const Place &at, const Tangent kind)
  {
    assemble(at, kind);
    if (rows.row_start.empty() || rows_version != potential.matrix_pattern().version)
      make_row_pattern();
    RowMatrix matrix = rows;
    matrix.value.resize(source.size());
    for (std::size_t i = 0; i < source.size(); ++i)
      matrix.value[i] = values[source[i]];
    return matrix;
  }

  void
  Laboratory::require_unknown_weights() const
  {
    if (weights.n_unknown() == 0)
      throw UserError(
          weights.are_prescribed()
              ? "Examples/Weights = prescribed: the weights are no unknowns, so that Phi has no "
                "derivative by them. Take Examples/Weights = simplex or free."
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

  dealii::FullMatrix<double>
  Laboratory::weight_compliance(const Place &at)
  {
    const unsigned int         n = weights.size();
    dealii::FullMatrix<double> compliance(n, n);
    if (weights.n_unknown() == 0)
      return compliance;
    const std::vector<double> slope   = evaluate(at).elastic.weight_gradient;
    const WeightForm         &form    = weights.weight_form();
    const bool                bounded = problem.parameters.examples.weights == WeightRule::simplex;
    std::vector<double>       lambda  = weights.residual(at.weights, slope).multipliers;
    std::vector<unsigned int> active;
    for (unsigned int i = 0; i < n; ++i)
    {
      const auto   slopes = weights.get_memory().slopes(i, at.weights[i], slope[i]);
      const double l      = lambda.empty() ? 0. : lambda[i / weights.n_per_region()];
      const bool   sticks = slopes.up > slopes.down && slopes.up + l > 0. && slopes.down + l < 0.;
      if (!(bounded && at.weights[i] <= 0.) && !sticks)
        active.push_back(i);
    }
    std::vector<unsigned int> sums; // regions with an active weight
    for (unsigned int r = 0; r < form.N.m(); ++r)
      if (std::any_of(active.begin(), active.end(),
                      [&](const unsigned int i) { return form.N(r, i) != 0.; }))
        sums.push_back(r);
    const unsigned int m = active.size(), size = m + sums.size();
    if (m == 0)
      return compliance;
    const double               unit = form.H.frobenius_norm(); // rows of sums as large as others
    dealii::FullMatrix<double> bordered(size, size);
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
      throw SolverFailure("The weights do not minimise the energy in one place alone: the examples "
                          "depend on each other. Give Examples/Weight penalty a number.");
    }
    for (unsigned int i = 0; i < m; ++i)
      for (unsigned int j = 0; j < m; ++j)
        compliance(active[i], active[j]) = bordered(i, j);
    return compliance;
  }

  CellMeans
  Laboratory::cell_means(const Place &at)
  {
    evaluate(at);
    ElasticPotential &elastic  = potential.get_cells();
    const FESpace    &fe_space = problem.body.fe_space;
    CellMeans         means;
    means.det_F = elastic.cell_results(at.positions, at.weights).det_F; // tells the cells all
    means.strains.resize(fe_space.n_cells());
    means.stresses.resize(fe_space.n_cells());
    const CellField &cells = elastic.get_field();
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      const unsigned int    cell = fe_space.cell_of(point);
      const double          part = fe_space.volume(point) / fe_space.cell_volume(cell);
      const Matrix3<double> R    = cells.rotation(point);
      const Matrix3<double> F    = fe_space.deformation_gradient(point, at.positions);
      cells.get_batches().with_cell(
          point, R, F,
          [&](auto state)
          {
            using Cell = std::decay_t<decltype(state)>;
            if constexpr (Cell::traits.knows_volume)
              state.add_volume_pressure(cells.volume_pressure(point));
            Matrix3<double> T
                = state.stress_towards(problem.examples.poses.strain(point, at.weights));
            for (int i = 0; i < 3; ++i)
              T[i][i] += cells.pressure(point);
            const Matrix3<double> turned = R * transposed(R * T); // T is symmetric
            means.strains[cell]          = combine(1., means.strains[cell], part, state.strain());
            means.stresses[cell]         = combine(1., means.stresses[cell], part, turned);
          });
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

  RowMatrix
  mass_matrix(const Problem &problem)
  {
    const FESpace        &fe_space = problem.body.fe_space;
    std::unique_ptr<Mass> made;
    if (problem.actions.mass == nullptr)
      made = std::make_unique<Mass>(fe_space, problem.body.material,
                                    problem.parameters.material.mass_matrix);
    const auto &nodal = (made != nullptr ? *made : *problem.actions.mass).nodal();
    RowMatrix   matrix;
    matrix.row_start.push_back(0);
    for (unsigned int dof = 0; dof < fe_space.n_dofs(); ++dof)
    {
      std::vector<std::pair<int, double>> row;
      for (auto entry = nodal.begin(dof / 3); entry != nodal.end(dof / 3); ++entry)
        row.emplace_back(3 * entry->column() + dof % 3, entry->value());
      std::sort(row.begin(), row.end()); // deal.II begins with the diagonal
      for (const auto &[column, value] : row)
      {
        matrix.column.push_back(column);
        matrix.value.push_back(value);
      }
      matrix.row_start.push_back(static_cast<int>(matrix.column.size()));
    }
    return matrix;
  }
} // namespace Exemplar
