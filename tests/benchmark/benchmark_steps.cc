// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/environment.h>
#include <exemplar/base/errors.h>
#include <exemplar/run/problem.h>
#include <exemplar/run/scene_file.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/multithread_info.h>
#include <deal.II/base/utilities.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cholmod.h>
#include <cmath>
#include <ctime>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

// Measures the steps of a scene. What a step costs is given as a ratio to the unit, one
// CHOLMOD factorisation and one solve of the scene's own matrix, which is measured
// between the steps, so that both see the same noise. Prints a JSON object.

namespace Exemplar
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    constexpr unsigned int steps_between_units = 10;
    constexpr double       large_error         = 1e-3;

    struct Options
    {
      std::string              scene_file;
      std::vector<std::string> overrides;
      unsigned int             steps     = std::numeric_limits<unsigned int>::max();
      bool                     reference = false;
      bool                     no_unit   = false;
    };

    /// Seconds, by the wall's clock and of this thread's processor time.
    struct Duration
    {
      double wall = 0.;
      double cpu  = 0.;

      Duration
      operator+(const Duration &other) const
      {
        return { wall + other.wall, cpu + other.cpu };
      }
    };

    double
    seconds_on(const clockid_t clock)
    {
      timespec time{};
      clock_gettime(clock, &time);
      return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    }

    template <typename Work>
    Duration
    duration_of(const Work &work)
    {
      const double wall = seconds_on(CLOCK_MONOTONIC), cpu = seconds_on(CLOCK_THREAD_CPUTIME_ID);
      work();
      return { seconds_on(CLOCK_MONOTONIC) - wall, seconds_on(CLOCK_THREAD_CPUTIME_ID) - cpu };
    }

    double
    median(std::vector<double> values)
    {
      std::sort(values.begin(), values.end());
      const std::size_t middle = values.size() / 2;
      return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
    }

    Duration
    median(const std::vector<Duration> &durations)
    {
      std::vector<double> wall, cpu;
      for (const Duration &duration : durations)
      {
        wall.push_back(duration.wall);
        cpu.push_back(duration.cpu);
      }
      return { median(wall), median(cpu) };
    }

    /// One factorisation and one solve of the scene's matrix.
    class Unit
    {
    public:
      /// At the problem's state; changes nothing there.
      void
      measure(Problem &problem)
      {
        if (!matrix)
        {
          matrix = make_cholmod_operator();
          matrix->reinit(problem.assembler.matrix_pattern());
          measure_once(problem); // touches the factor's memory for the first time
        }
        const Sample sample = measure_once(problem);
        assemble.push_back(sample.assemble);
        factorize.push_back(sample.factorize);
        solve.push_back(sample.solve);
        both.push_back(sample.factorize + sample.solve);
      }

      std::vector<Duration> assemble;
      std::vector<Duration> factorize;
      std::vector<Duration> solve;
      std::vector<Duration> both;

    private:
      struct Sample
      {
        Duration assemble;
        Duration factorize;
        Duration solve;
      };

      Sample
      measure_once(Problem &problem)
      {
        const State &state = problem.state;
        Sample       sample;
        sample.assemble = duration_of(
            [&]
            {
              problem.assembler.assemble_tangent(Tangent::convex, state.positions, state.weights,
                                                 matrix->values(), coupling);
            });
        sample.factorize = duration_of([&] { matrix->factorize(); });
        column.assign(problem.free_dofs.size(), 1.);
        sample.solve = duration_of([&] { matrix->solve(column); });
        return sample;
      }

      std::unique_ptr<SpdOperator> matrix;
      std::vector<double>          coupling;
      std::vector<double>          column;
    };

    /// Operations and bytes of the factor, which the operator does not tell.
    struct FactorSize
    {
      double flops = 0.;
      double bytes = 0.;
    };

    FactorSize
    factor_size(SymmetricPattern pattern)
    {
      cholmod_common common{};
      cholmod_start(&common);
      common.supernodal = CHOLMOD_AUTO;
      cholmod_sparse matrix{};
      matrix.nrow = matrix.ncol = pattern.n();
      matrix.nzmax              = pattern.row.size();
      matrix.p                  = pattern.column_start.data();
      matrix.i                  = pattern.row.data();
      matrix.stype              = -1;
      matrix.itype              = CHOLMOD_INT;
      matrix.xtype              = CHOLMOD_PATTERN;
      matrix.dtype              = CHOLMOD_DOUBLE;
      matrix.sorted = matrix.packed = 1;
      cholmod_factor *factor        = cholmod_analyze(&matrix, &common);
      FactorSize      size;
      if (factor != nullptr)
      {
        size.flops = common.fl;
        size.bytes = factor->is_super ? static_cast<double>(factor->xsize * sizeof(double)
                                                            + factor->ssize * sizeof(int))
                                      : common.lnz * (sizeof(double) + sizeof(int));
      }
      cholmod_free_factor(&factor, &common);
      cholmod_finish(&common);
      return size;
    }

    /// What the BLAS reaches at best.
    double
    dgemm_gflops()
    {
      constexpr unsigned int           n = 1500;
      dealii::LAPACKFullMatrix<double> A(n), B(n), C(n);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
        {
          A(i, j) = 1. / (1. + i + j);
          B(i, j) = i < j ? 1. : 0.5;
        }
      double least = std::numeric_limits<double>::infinity();
      for (unsigned int repetition = 0; repetition < 4; ++repetition)
        least = std::min(least, duration_of([&] { A.mmult(C, B); }).cpu);
      return 2e-9 * n * n * n / least;
    }

    /// What a core can read and write of the main memory.
    double
    triad_gb_s()
    {
      const std::size_t         n = 1 << 23; // thrice 64 MiB, more than caches hold
      const std::vector<double> b(n, 1.), c(n, 2.);
      std::vector<double>       a(n, 0.);
      double                    least = std::numeric_limits<double>::infinity();
      for (unsigned int repetition = 0; repetition < 5; ++repetition)
        least = std::min(least, duration_of(
                                    [&]
                                    {
                                      for (std::size_t i = 0; i < n; ++i)
                                        a[i] = b[i] + 0.5 * c[i];
                                    })
                                    .cpu);
      return a[n / 2] > 0. ? 3e-9 * sizeof(double) * n / least : 0.;
    }

    std::vector<std::string>
    overrides_of_reference(std::vector<std::string> overrides)
    {
      for (const char *assignment :
           { "Model/Gradient=consistent", "Solver/Method=newton", "Solver/Tolerance=1e-11",
             "Solver/Maximum iterations=100", "Solver/Linear solver=cholesky" })
        overrides.emplace_back(assignment);
      return overrides;
    }

    Problem
    problem_of(const std::string &file, const std::vector<std::string> &overrides = {})
    {
      const SceneFile scene(file, overrides);
      return { scene.get_parameters(), read_inputs(scene.get_parameters()) };
    }

    /// The same scene, each of its steps solved to the end from where the measured one starts.
    class Reference
    {
    public:
      explicit Reference(const Options &options)
          : problem(problem_of(options.scene_file, overrides_of_reference(options.overrides)))
      {
      }

      /// Compare the step from `before` that led to `reached`.
      void
      compare(const State &before, const State &reached)
      {
        problem.resume_from(before);
        if (!is_success(problem.advance().status))
        {
          ++failures;
          return;
        }
        dealii::Vector<double> error = reached.positions, way = before.positions;
        error -= problem.state.positions;
        way -= problem.state.positions;
        errors.push_back(error.linfty_norm() / way.linfty_norm());
      }

      std::vector<double> errors; ///< relative to the greatest way of a node in the step
      unsigned int        failures = 0;

    private:
      Problem problem;
    };

    /// Of this process, in bytes.
    dealii::Utilities::System::MemoryStats
    memory()
    {
      dealii::Utilities::System::MemoryStats stats{};
      dealii::Utilities::System::get_memory_stats(stats);
      return stats;
    }

    class Benchmark
    {
    public:
      explicit Benchmark(const Options &options)
          : options(options), resident_before(memory().VmRSS),
            problem(problem_of(options.scene_file, options.overrides))
      {
        if (options.reference)
          reference = std::make_unique<Reference>(options);
        problem.clock.switch_to(Part::evaluate);
      }

      /// Whether all steps succeeded.
      bool
      run()
      {
        const unsigned int n_steps = std::min(options.steps, problem.time_axis.n_steps());
        while (problem.state.step < n_steps)
        {
          const State before = reference ? problem.state : State();
          if (!measure_step())
            return false;
          if (reference)
            reference->compare(before, problem.state);
          if (problem.state.step % steps_between_units == 0 || problem.state.step == n_steps)
            measure_between_steps();
        }
        return true;
      }

      Json
      report()
      {
        if (unit.both.empty()) // a step has failed before
        {
          problem.equilibrium.start(problem.state);
          measure_between_steps();
        }
        Json json;
        add_scene(json);
        add_unit(json);
        add_steps(json);
        add_errors(json);
        add_memory(json);
        add_machine(json);
        return json;
      }

    private:
      bool
      measure_step()
      {
        SolveReport       step_report;
        const PartSeconds before   = problem.clock.read();
        const Duration    duration = duration_of(
            [&]
            {
              step_report = problem.advance();
              StepClock::Scope    scope(problem.clock, Part::output);
              const StatisticsRow row
                  = problem.diagnostics.row(problem.state, step_report, problem.equilibrium);
              written += row.size();
            });
        const PartSeconds after = problem.clock.read();
        worst_status            = std::max(worst_status, step_report.status);
        iterations += step_report.iterations;
        if (!is_success(step_report.status))
          return false;
        steps.push_back(duration);
        for (unsigned int part = 0; part < n_parts; ++part)
          seconds[part] += after[part] - before[part];
        return true;
      }

      void
      measure_between_steps()
      {
        if (peak_kib == 0.)
          peak_kib = memory().VmHWM; // before there is a unit
        if (!options.no_unit)
          unit.measure(problem);
        else
          peak_kib = memory().VmHWM;
      }

      void
      add_scene(Json &json) const
      {
        json["scene"]    = std::filesystem::path(options.scene_file).stem().string();
        json["method"]   = method_name(problem.parameters.solver.method);
        json["examples"] = problem.examples != nullptr ? problem.examples->size() : 0;
        json["cells"]    = problem.mesh.n_cells();
        json["dofs"]     = problem.free_dofs.size();
        json["steps"]    = steps.size();
        json["status"]   = status_name(worst_status);
        if (!is_success(worst_status))
          json["failed_step"] = problem.state.step + 1;
      }

      void
      add_unit(Json &json) const
      {
        if (options.no_unit)
          return;
        json["unit_ms"]      = 1e3 * median(unit.both).wall;
        json["unit_cpu_ms"]  = 1e3 * median(unit.both).cpu;
        json["factorize_ms"] = 1e3 * median(unit.factorize).wall;
        json["solve_ms"]     = 1e3 * median(unit.solve).wall;
        json["assemble_ms"]  = 1e3 * median(unit.assemble).wall;
      }

      void
      add_steps(Json &json) const
      {
        const double   n         = std::max<std::size_t>(steps.size(), 1);
        const Duration total     = std::accumulate(steps.begin(), steps.end(), Duration());
        json["mean_step_ms"]     = 1e3 * total.wall / n;
        json["mean_step_cpu_ms"] = 1e3 * total.cpu / n;
        for (const Part part :
             { Part::evaluate, Part::assemble, Part::factorize, Part::solve, Part::output })
        {
          const unsigned int p            = static_cast<unsigned int>(part);
          json["parts_ms"][part_names[p]] = 1e3 * seconds[p] / n;
        }
        if (!options.no_unit)
          json["units"] = total.cpu / n / median(unit.both).cpu;
        json["iterations"]       = iterations;
        json["factorizations"]   = problem.equilibrium.n_factorizations();
        json["cells_per_second"] = n * problem.mesh.n_cells() / total.wall;
      }

      void
      add_errors(Json &json) const
      {
        if (!reference)
          return;
        const std::vector<double> &errors = reference->errors;
        const double               n      = std::max<std::size_t>(errors.size(), 1);
        json["worst_error"]
            = errors.empty() ? Json() : Json(*std::max_element(errors.begin(), errors.end()));
        json["mean_error"] = std::accumulate(errors.begin(), errors.end(), 0.) / n;
        json["steps_above_1e-3"]
            = std::count_if(errors.begin(), errors.end(),
                            [](const double error) { return !(error <= large_error); });
        json["steps_without_reference"] = reference->failures;
      }

      void
      add_memory(Json &json) const
      {
        if (reference) // its memory cannot be told apart
          return;
        json["peak_memory_mib"] = peak_kib / 1024.;
        json["bytes_per_cell"]  = 1024. * (peak_kib - resident_before) / problem.mesh.n_cells();
      }

      void
      add_machine(Json &json) const
      {
        const BlasInfo blas = blas_info();
        json["blas"]        = blas.library;
        json["blas_core"]   = blas.core;
        if (options.no_unit)
          return;
        const FactorSize size  = factor_size(problem.assembler.matrix_pattern());
        json["factor_gflop"]   = 1e-9 * size.flops;
        json["factor_mib"]     = size.bytes / 1024. / 1024.;
        json["factor_gflop_s"] = 1e-9 * size.flops / median(unit.factorize).cpu;
        json["solve_gb_s"]     = 2e-9 * size.bytes / median(unit.solve).cpu; // there and back
        json["dgemm_gflops"]   = dgemm_gflops();
        json["triad_gb_s"]     = triad_gb_s();
      }

      const Options              options;
      const double               resident_before; ///< [KiB]
      Problem                    problem;
      std::unique_ptr<Reference> reference;
      Unit                       unit;
      std::vector<Duration>      steps;
      PartSeconds                seconds{};
      SolveStatus                worst_status = SolveStatus::initial;
      unsigned int               iterations   = 0;
      std::size_t                written      = 0; ///< so that no row is optimised away
      double                     peak_kib     = 0.;
    };

    int
    run(const int argc, char *argv[])
    {
      Options  options;
      CLI::App app("benchmark_steps: measure the steps of a scene, print JSON");
      app.add_option("SCENE", options.scene_file, "scene file (.prm)")->required();
      app.add_option("--set", options.overrides, "'Section/Key=value' instead of the scene's")
          ->allow_extra_args(false);
      app.add_option("--steps", options.steps, "so many of the scene's steps only")
          ->check(CLI::PositiveNumber);
      app.add_flag("--reference", options.reference,
                   "solve each step to the end, too, and report the error (slows the steps by "
                   "emptying the caches)");
      app.add_flag("--no-unit", options.no_unit,
                   "do not factorise beside the steps; then the memory is that of all steps");
      try
      {
        app.parse(argc, argv);
      }
      catch (const CLI::ParseError &error)
      {
        return app.exit(error) == 0 ? 0 : 1;
      }
      Benchmark  benchmark(options);
      const bool succeeded = benchmark.run();
      const Json report    = benchmark.report();
      std::cout << report.dump(2) << std::endl;
      if (!succeeded)
        std::cerr << "benchmark_steps: step " << report["failed_step"]
                  << " failed: " << report["status"] << std::endl;
      return succeeded ? 0 : 2;
    }
  } // namespace
} // namespace Exemplar

int
main(int argc, char *argv[])
{
  Exemplar::restart_with_right_core_type(argv);
  Exemplar::use_one_blas_thread();
  Exemplar::set_n_threads(1); // on one core
  dealii::MultithreadInfo::set_thread_limit(1);
  dealii::deal_II_exceptions::disable_abort_on_exception();
  try
  {
    return Exemplar::run(argc, argv);
  }
  catch (const std::exception &error)
  {
    std::cerr << "benchmark_steps: " << error.what() << std::endl;
    return dynamic_cast<const Exemplar::UserError *>(&error) != nullptr ? 1 : 2;
  }
}
