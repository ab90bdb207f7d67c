// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/environment.h>
#include <exemplar/run/problem/problem.h>
#include <exemplar/run/scene/scene_file.h>

#include <deal.II/base/multithread_info.h>

#include <benchmark/benchmark.h>

#include "../unit/kernels/compared_kernels.h"

// The kernels of a step on the cat, a little deformed, one core; "ns" of a cell kernel are
// those of all cells, and items a second are cells.
// Usage: benchmark_kernels [SCENE.prm] [options of Google Benchmark]

namespace Exemplar
{
  namespace
  {
    Problem
    problem_of(const std::string &file, const std::vector<std::string> &overrides = {})
    {
      const SceneFile scene(file, overrides);
      return { scene.get_parameters(), read_inputs(scene.get_parameters()) };
    }

    struct Scene
    {
      explicit Scene(const std::string &file)
          : problem(problem_of(file)), batches(problem.body.fe_space,
                                               problem.body.material,
                                               CellLaw::corotational,
                                               ExampleConstants()),
            positions(problem.body.fe_space.rest_positions()),
            node_positions(4 * positions.size() / 3)
      {
        // strains and turns of some tenths, different in every cell
        for (unsigned int dof = 0; dof < positions.size(); ++dof)
          positions[dof] += 0.02 * std::sin(40. * positions[dof - dof % 3 + (dof + 1) % 3]);
        problem.cells().get_field().update_rotations(positions);
        task.cells = batches.arrays();
        for (unsigned int dof = 0; dof < positions.size(); ++dof)
          node_positions[dof / 3 * 4 + dof % 3] = positions[dof];
        task.positions = node_positions.data();
        forces.resize(node_positions.size());
      }

      Problem                       problem;
      CellBatches                   batches;
      dealii::Vector<double>        positions;
      dealii::AlignedVector<double> node_positions;
      CellTask                      task;
      dealii::AlignedVector<double> forces;
    };

    Scene *scene = nullptr;

    void
    report_cells(benchmark::State &state)
    {
      const double n = static_cast<double>(scene->task.cells.n_cells);
      state.counters["ns/cell"]
          = benchmark::Counter(1e-9 * n * static_cast<double>(state.iterations()),
                               benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    }

    void
    rotations(benchmark::State &state, const CellKernels *kernels)
    {
      for (auto _ : state)
        kernels->update_rotations(scene->task, 0, scene->task.cells.n_batches());
      report_cells(state);
    }

    void
    forces(benchmark::State &state, const CellKernels *kernels, const RotationUse rotations)
    {
      CellTask task     = scene->task;
      task.rotation_use = rotations;
      for (auto _ : state)
      {
        CellSums sums;
        kernels->evaluate(task, 0, task.cells.n_batches(), scene->forces.data(), nullptr, sums);
        benchmark::DoNotOptimize(sums);
      }
      report_cells(state);
    }

    void
    evaluation(benchmark::State &state)
    {
      ElasticEvaluation evaluation;
      for (auto _ : state)
        scene->problem.cells().evaluate(scene->positions, {}, evaluation, RotationUse::update);
      report_cells(state);
    }

    void
    assembly(benchmark::State &state, const Tangent tangent)
    {
      std::vector<double> values(scene->problem.potential.get_tangent().get_pattern().n_values()),
          columns;
      for (auto _ : state)
        scene->problem.cells().assemble_tangent(tangent, scene->positions, {}, values, columns);
      report_cells(state);
    }

    void
    node_rotations(benchmark::State &state)
    {
      std::vector<float> rotations;
      for (auto _ : state)
        scene->problem.cells().get_field().node_rotations(rotations);
      report_cells(state);
    }

    void
    inertia(benchmark::State &state)
    {
      ElasticSums               sums;
      const std::vector<double> no_weights;
      sums->gradient.reinit(scene->positions.size());
      sums->force_scale.reinit(scene->positions.size() / 3);
      scene->problem.potential.begin_step(scene->problem.state, 0.01);
      for (auto _ : state)
        scene->problem.potential.get_terms().front()->add({ scene->positions, no_weights }, sums);
    }

    std::unique_ptr<SpdOperator>
    make_matrix()
    {
      auto matrix = make_cholesky_operator();
      matrix->reinit(scene->problem.potential.get_tangent().get_pattern());
      std::vector<double> no_columns;
      scene->problem.potential.get_tangent().assemble(scene->positions, {}, 1., matrix->values(),
                                                      no_columns);
      return matrix;
    }

    void
    factorisation(benchmark::State &state)
    {
      const auto matrix = make_matrix();
      for (auto _ : state)
        matrix->factorize(scene->positions);
    }

    void
    solve(benchmark::State &state)
    {
      const auto matrix = make_matrix();
      matrix->factorize(scene->positions);
      std::vector<double> column(scene->problem.constraints.free_dofs.size() * state.range(0), 1.);
      for (auto _ : state)
        matrix->solve(column);
    }

    void
    solve_in_single_precision(benchmark::State &state)
    {
      const auto matrix = make_matrix();
      matrix->factorize(scene->positions);
      const auto          inverse = matrix->keep();
      std::vector<double> column(scene->problem.constraints.free_dofs.size(), 1.);
      for (auto _ : state)
        inverse->apply(column);
    }

    void
    copy_to_single_precision(benchmark::State &state)
    {
      const auto matrix = make_matrix();
      matrix->factorize(scene->positions);
      for (auto _ : state)
        matrix->keep();
    }
  } // namespace
} // namespace Exemplar

int
main(int argc, char *argv[])
{
  using namespace Exemplar;
  restart_with_right_core_type(argv);
  use_one_blas_thread();
  dealii::MultithreadInfo::set_thread_limit(1);
  benchmark::Initialize(&argc, argv);
  Scene the_scene(argc > 1 ? argv[1] : EXEMPLAR_SOURCE_DIR "/tests/benchmark/scenes/cat_grav.prm");
  scene = &the_scene;
  for (const CellKernels *kernels : Testing::scalar_and_all_kernels(Element::P1))
  {
    const std::string name = std::string("/") + kernels->name;
    benchmark::RegisterBenchmark(("rotations" + name).c_str(), rotations, kernels);
    benchmark::RegisterBenchmark(("forces" + name).c_str(), forces, kernels, RotationUse::keep);
    benchmark::RegisterBenchmark(("rotations_and_forces" + name).c_str(), forces, kernels,
                                 RotationUse::update);
    benchmark::RegisterBenchmark(("forces_without_storing_rotations" + name).c_str(), forces,
                                 kernels, RotationUse::find_and_forget);
  }
  benchmark::RegisterBenchmark("evaluation", evaluation);
  benchmark::RegisterBenchmark("assembly/convex", assembly, Tangent::convex);
  benchmark::RegisterBenchmark("assembly/exact", assembly, Tangent::exact);
  benchmark::RegisterBenchmark("node_rotations", node_rotations);
  benchmark::RegisterBenchmark("inertia", inertia);
  benchmark::RegisterBenchmark("factorisation", factorisation);
  benchmark::RegisterBenchmark("solve", solve)->Arg(1)->Arg(4);
  benchmark::RegisterBenchmark("solve_in_single_precision", solve_in_single_precision);
  benchmark::RegisterBenchmark("copy_to_single_precision", copy_to_single_precision);
  benchmark::RunSpecifiedBenchmarks();
}
