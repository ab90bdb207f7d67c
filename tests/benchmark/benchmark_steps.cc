// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/environment.h>
#include <exemplar/base/errors.h>
#include <exemplar/run/output/diagnostics.h>
#include <exemplar/run/scene/scene_file.h>

#include "benchmark_unit.h"

#include <deal.II/base/utilities.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
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
        problem.clock.switch_to(Phase::evaluate);
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
          problem.resume_from(problem.state);
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
        SolveReport        step_report;
        const PhaseSeconds before   = problem.clock.read();
        const Duration     duration = duration_of(
            [&]
            {
              step_report = problem.advance();
              StepClock::Scope scope(problem.clock, Phase::output);
              diagnostics.add_step();
              written += diagnostics.row(problem.state, step_report).size();
            });
        const PhaseSeconds after = problem.clock.read();
        worst_status             = std::max(worst_status, step_report.status);
        iterations += step_report.iterations;
        if (!is_success(step_report.status))
          return false;
        steps.push_back(duration);
        for (unsigned int phase = 0; phase < n_phases; ++phase)
          seconds[phase] += after[phase] - before[phase];
        return true;
      }

      void
      measure_between_steps()
      {
        if (peak_kib == 0.)
          peak_kib = memory().VmHWM; // before there is a unit
        if (!options.no_unit)
          unit.measure(problem_of_unit());
        else
          peak_kib = memory().VmHWM;
      }

      /// The unit is that of the scene with cells, whatever its dilatation is.
      Problem &
      problem_of_unit()
      {
        if (problem.body.patches.size() == 0)
          return problem;
        if (with_cells == nullptr)
        {
          std::vector<std::string> overrides = options.overrides;
          overrides.emplace_back("Model/Dilatation=cells");
          with_cells.reset(new Problem(problem_of(options.scene_file, overrides)));
        }
        return *with_cells;
      }

      void
      add_scene(Json &json) const
      {
        json["scene"]    = std::filesystem::path(options.scene_file).stem().string();
        json["method"]   = method_name(problem.parameters.solver.method);
        json["examples"] = problem.examples.poses.size();
        json["cells"]    = problem.body.mesh.n_cells();
        json["dofs"]     = problem.constraints.free_dofs.size();
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
        for (const Phase phase :
             { Phase::evaluate, Phase::assemble, Phase::factorize, Phase::solve, Phase::output })
        {
          const unsigned int p             = static_cast<unsigned int>(phase);
          json["parts_ms"][phase_names[p]] = 1e3 * seconds[p] / n;
        }
        if (!options.no_unit)
          json["units"] = total.cpu / n / median(unit.both).cpu;
        json["iterations"]       = iterations;
        json["factorizations"]   = problem.system.n_factorizations();
        json["cells_per_second"] = n * problem.body.mesh.n_cells() / total.wall;
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
        json["bytes_per_cell"] = 1024. * (peak_kib - resident_before) / problem.body.mesh.n_cells();
      }

      void
      add_machine(Json &json)
      {
        const BlasInfo blas = blas_info();
        json["blas"]        = blas.library;
        json["blas_core"]   = blas.core;
        if (options.no_unit)
          return;
        const FactorSize size
            = factor_size(problem_of_unit().potential.get_tangent().get_pattern());
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
      Diagnostics                diagnostics{ problem };
      std::unique_ptr<Reference> reference;
      std::unique_ptr<Problem>   with_cells; ///< null unless the unit needs it
      Unit                       unit;
      std::vector<Duration>      steps;
      PhaseSeconds               seconds{};
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
  return Exemplar::run_benchmark("benchmark_steps", argv,
                                 [&] { return Exemplar::run(argc, argv); });
}
