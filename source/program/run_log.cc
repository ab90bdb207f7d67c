// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/environment.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/version.h>
#include <exemplar/base/words.h>
#include <exemplar/program/joint_run.h>
#include <exemplar/program/run_log.h>
#include <exemplar/run/output/run_directory.h>
#include <exemplar/run/problem/body_measures.h>
#include <exemplar/run/problem/idle_review.h>

#include <fmt/core.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <ctime>
#include <iomanip>
#include <iostream>
#include <numeric>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <system_error>

namespace Exemplar
{
  namespace
  {
    std::string
    date_and_time()
    {
      const std::time_t    now = std::time(nullptr);
      std::tm              utc{};
      std::array<char, 32> text{};
      std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S UTC", gmtime_r(&now, &utc));
      return text.data();
    }

    std::string
    mesh_text(const Problem &problem)
    {
      const Exchange    &exchange = problem.body.exchange();
      const FESpace     &fe_space = problem.body.fe_space;
      const auto         n_nodes  = exchange.n_nodes(fe_space.n_nodes());
      const auto         n_free   = exchange.sum(problem.constraints.free_dofs.size());
      const unsigned int n_slopes = fe_space.is_shell() ? fe_space.shell().n_slopes() : 0;
      std::ostringstream text;
      text << "Mesh      " << printable(problem.body.mesh.get_name()) << ": "
           << problem.body.mesh.whole().n_cells << ' '
           << (fe_space.is_shell() ? "triangles"
                                   : traits_of(problem.parameters.model.element).cells)
           << ", " << n_nodes - n_slopes << " nodes"
           << (n_slopes > 0 ? fmt::format(" and {} slopes of edges", n_slopes) : "") << ", "
           << static_cast<unsigned int>(n_free) << " of " << 3 * n_nodes << " dofs free\n";
      return text.str();
    }

    /// Report on a mesh and poses made of surfaces; empty if none were.
    std::string
    made_text(const MadeOfSurfaces *made)
    {
      std::string text;
      if (made != nullptr)
        for (const std::string &line : lines_of(*made))
          text += "          " + message_text(line) + '\n';
      return text;
    }

    /// Number with four digits: "4000", "1e6"
    std::string
    plain(const double value)
    {
      std::ostringstream text;
      text << std::setprecision(4) << value;
      static const std::regex zeros("e\\+?(-?)0*");
      return std::regex_replace(text.str(), zeros, "e$1");
    }

    std::string
    range_text(const Range &range)
    {
      const std::string minimum = plain(range.minimum), maximum = plain(range.maximum);
      return minimum == maximum ? minimum : minimum + " to " + maximum;
    }

    /// The thickness of a shell, with a comma behind it; empty for others.
    std::string
    thickness_text(const Body &body)
    {
      if (!body.fe_space.is_shell())
        return "";
      Range thickness;
      for (const ShellTriangle &triangle : body.fe_space.shell().triangles())
        thickness.add(triangle.thickness);
      return range_text(thickness) + " m thick, ";
    }

    /// Measures of the body that reveal a wrong unit.
    std::string
    body_text(const Problem &problem)
    {
      const BodyMeasures measures = measure(problem.body);
      std::string text = "Body      " + plain(measures.size[0]) + " x " + plain(measures.size[1])
                         + " x " + plain(measures.size[2]) + " m, " + thickness_text(problem.body)
                         + plain(measures.mass) + " kg; E " + range_text(measures.young)
                         + " Pa, nu " + range_text(measures.poisson);
      const Loads *loads = problem.actions.loads.get();
      if (loads != nullptr && loads->has_gravity())
      {
        const auto  &g       = problem.parameters.loads.gravity;
        const double gravity = std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
        text += "; rho g L / E "
                + plain(measures.weight_over_stiffness(gravity) * measures.length());
      }
      return text + '\n';
    }

    std::string
    examples_text(const ExamplePoses &poses)
    {
      std::ostringstream text;
      text << "Examples  ";
      if (poses.size() > 0)
        text << poses.size() << ", importance " << poses.constants().importance << '\n';
      else
        text << "none\n";
      return text.str();
    }

    std::string
    solver_text(const Problem &problem)
    {
      const SolverParameters &solver      = problem.parameters.solver;
      const BlasInfo          blas        = blas_info();
      const unsigned int      n_processes = problem.body.exchange().n_processes();
      std::ostringstream      text;
      text << "Solver    " << method_name(solver.method) << ", "
           << problem.system.bordered().traits().name << ", "
           << counted(problem.time_axis.n_steps(), "step") << "; ";
      if (n_processes > 1)
        text << n_processes << " processes of ";
      text << counted(solver.n_threads, "thread") << "; BLAS " << blas.library << ' ' << blas.core
           << '\n';
      return text.str();
    }

    /// Number of cells below which one process is faster than several, measured in doc/parallel.md.
    unsigned int
    cells_of_one_process(const SceneKind scene)
    {
      return scene == SceneKind::dynamic ? 10000 : 50000;
    }

    std::string
    notes_text(const Problem &problem)
    {
      const unsigned int       bound = cells_of_one_process(problem.parameters.scene);
      std::vector<std::string> notes = idle_notes(problem);
      if (problem.body.exchange().n_processes() > 1 && problem.body.mesh.whole().n_cells < bound)
        notes.push_back(fmt::format(
            "with fewer than {} cells one process is faster: start without mpirun", bound));
      if (problem.parameters.scene == SceneKind::statics
          && problem.parameters.material.has("Relaxation time"))
        notes.push_back("static scenes have no time: the Relaxing share of stresses has gone");
      for (std::string &note : problem.parameters.material.describe_presets())
        notes.push_back(std::move(note));
      std::string text;
      for (const std::string &note : notes)
        text += "Note      " + note + '\n';
      return text;
    }

    std::string
    times_text(const RunTotals &totals)
    {
      const PhaseSeconds &seconds = totals.seconds;
      const double        total   = std::accumulate(seconds.begin(), seconds.end(), 0.);
      std::ostringstream  text;
      text << "\nWhere the time went\n" << std::fixed;
      for (unsigned int phase = 0; phase < n_phases; ++phase)
        text << "  " << std::left << std::setw(12) << phase_names[phase] << std::right
             << std::setw(9) << std::setprecision(3) << seconds[phase] << " s " << std::setw(5)
             << std::setprecision(1) << 100. * seconds[phase] / total << " %\n";
      text << "  " << std::left << std::setw(12) << "total" << std::right << std::setw(9)
           << std::setprecision(3) << total << " s\n"
           << counted(totals.iterations, "iteration") << ", "
           << counted(totals.factorizations, "factorisation") << '\n';
      return text.str();
    }

    std::string
    errors_text(const SolverParameters &solver, const double residual, const SpaceError &space)
    {
      std::ostringstream text;
      text << "Errors\n  steps       residual up to " << std::setprecision(2) << residual;
      if (solver.method == Method::quasi_newton)
        text << ", positions to " << solver.step_tolerance << " of a step";
      text << "\n  space       " << std::fixed << std::setprecision(1);
      if (!space.failure.empty())
        text << "no estimate: " << space.failure;
      else
      {
        text << "displacement " << 100. * space.displacement << " %, energy " << 100. * space.energy
             << " %";
        if (space.weights)
          text << ", weights " << std::setprecision(3) << *space.weights;
      }
      text << '\n';
      return text.str();
    }
  } // namespace

  RunLog::RunLog(const bool quiet) : processes(JointRun::group()), quiet(quiet) {}

  void
  RunLog::say(const std::string &lines)
  {
    if (!quiet)
      processes.of_root(std::cout) << lines << std::flush;
    note(lines);
  }

  void
  RunLog::warn(const std::string &warning)
  {
    warnings.push_back(warning);
    const std::string line = "Warning: " + message_text(warning) + '\n';
    processes.of_root(std::cerr) << line << std::flush;
    note(line);
  }

  void
  RunLog::warn(const std::vector<std::string> &all)
  {
    for (const std::string &warning : all)
      warn(warning);
  }

  void
  RunLog::note(const std::string &lines)
  {
    waiting += lines;
    if (!file.is_open())
      return;
    errno = 0;
    file << waiting << std::flush;
    if (!file)
      throw std::runtime_error("Cannot write " + path.string() + ": "
                               + std::generic_category().message(errno) + ".");
    waiting.clear();
  }

  void
  RunLog::keep_in(const std::filesystem::path &new_path)
  {
    processes.at_root(
        [&]
        {
          path = new_path;
          const bool is_new
              = !std::filesystem::exists(path) || std::filesystem::file_size(path) == 0;
          file.open(path, std::ios::app);
          waiting.insert(0, (is_new ? RunDirectory::log_mark : "") + "\n" + date_and_time()
                                + ", exemplar " EXEMPLAR_VERSION " (" EXEMPLAR_GIT_REVISION ")\n");
          note("");
        });
  }

  std::string
  resumption_text(const Problem &problem)
  {
    std::string text = fmt::format("Resumed   after step {}\n", problem.state.step);
    if (problem.state.step == problem.time_axis.n_steps())
      text += std::string("          it was the last one, and nothing is left to do; ")
              + (problem.parameters.scene == SceneKind::dynamic
                     ? "a greater Time/End makes more steps\n"
                     : "more increments need a run from the start\n");
    return text;
  }

  std::string
  header_text(const Problem &problem)
  {
    return "Scene     " + printable(problem.parameters.name) + '\n' + mesh_text(problem)
           + made_text(problem.body.made.get()) + body_text(problem)
           + examples_text(problem.examples.poses) + solver_text(problem) + "Output    "
           + problem.parameters.output.directory + '\n' + notes_text(problem);
  }

  std::string
  closing_text(const Problem &problem, const RunWriter &writer)
  {
    const RunTotals &totals = writer.get_totals();
    std::string      text   = times_text(totals);
    if (const auto &space = writer.get_space_error())
      text += errors_text(problem.parameters.solver, totals.worst_residual, *space);
    return text;
  }

  std::string
  starts_text(const Problem &problem)
  {
    std::string text;
    for (const ExampleStart &start : problem.examples.starts)
      text += fmt::format("From {}: {}{}\n", start.from,
                          is_success(start.status) ? fmt::format("{:.6g} J", start.energy)
                                                   : status_name(start.status),
                          start.is_kept ? ", which is kept" : "");
    return text;
  }

  std::string
  progress_text(const SolveReport &report)
  {
    std::ostringstream text;
    text << counted(report.iterations, "iteration") << ", residual " << std::setprecision(2)
         << report.residual;
    return text.str();
  }

  std::string
  iteration_text(const Problem &problem, const SolveReport &report)
  {
    std::ostringstream line;
    line << "step " << problem.state.step + 1 << ", iteration " << report.iterations
         << std::scientific << std::setprecision(2) << ": residual " << report.residual;
    if (problem.examples.weights.n_unknown() > 0)
      line << ", weights' " << report.kkt_residual;
    if (report.step_length < 1.)
      line << ", step halved to " << report.step_length;
    if (report.convexity > 0.)
      line << ", tangent convex by " << report.convexity;
    line << '\n';
    return line.str();
  }
} // namespace Exemplar
