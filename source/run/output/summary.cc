// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/environment.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/version.h>
#include <exemplar/run/output/summary.h>
#include <exemplar/run/output/weight_names.h>
#include <exemplar/run/problem/inventory.h>

#include <deal.II/base/config.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <numeric>

namespace Exemplar
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    Json
    support_nodes(const Problem &problem)
    {
      Json numbers = Json::array();
      for (const unsigned int node : problem.constraints.support->nodes)
        numbers.push_back(problem.body.mesh.contents_of_whole().node_numbers[node]);
      return numbers;
    }

    Json
    seconds_of(const PhaseSeconds &seconds)
    {
      Json json;
      json["total"] = std::accumulate(seconds.begin(), seconds.end(), 0.);
      for (unsigned int phase = 0; phase < n_phases; ++phase)
        json[phase_names[phase]] = seconds[phase];
      return json;
    }

    Json
    memory_of(const std::vector<PartOfProblem> &parts)
    {
      Json json;
      for (const PartOfProblem &part : parts)
        if (part.bytes)
          json[part.name] = std::round(static_cast<double>(*part.bytes) / 1048.576) / 1000.;
      return json;
    }

    Json
    errors_of(const SpaceError &error)
    {
      Json json;
      if (!error.failure.empty())
      {
        json["failure"] = error.failure;
        return json;
      }
      json["displacement"] = error.displacement;
      json["energy"]       = error.energy;
      if (error.weights)
        json["weights"] = *error.weights;
      return json;
    }

    Json
    functional_of(const FunctionalReport &report)
    {
      Json json{ { "name", report.name }, { "value", report.value } };
      if (report.correction)
        json["correction"] = *report.correction;
      else
        json["failure"] = report.failure;
      return json;
    }

    Json
    mesh_made(const MeshingReport &report)
    {
      Json json;
      for (const auto &[what, value] : report.table)
        json[what] = Json::parse(value, nullptr, false);
      json["notes"] = report.notes;
      return json;
    }

    /// Quality measures of poses, named as in poses.csv.
    Json
    poses_carried(const std::vector<MadeOfSurfaces::Pose> &poses)
    {
      Json json = Json::array();
      for (const auto &[file, quality] : poses)
        json.push_back({ { "pose", printable(file) },
                         { "inverted_cells", quality.n_inverted },
                         { "min_det_F", quality.min_det },
                         { "max_det_F", quality.max_det },
                         { "stretch_1", quality.stretch_1 },
                         { "stretch_99", quality.stretch_99 },
                         { "surface_error_mean", 100. * quality.mean_error },
                         { "surface_error_max", 100. * quality.max_error } });
      return json;
    }

    Json
    warnings_of(const std::vector<std::string> &warnings)
    {
      Json json = Json::array();
      for (const std::string &warning : warnings)
        json.push_back(message_text(warning));
      return json;
    }

    /// Names of the parts in use, or of those not in use.
    Json
    names_of(const std::vector<PartOfProblem> &parts, const bool is_there)
    {
      Json names = Json::array();
      for (const PartOfProblem &part : parts)
        if (part.is_there == is_there)
          names.push_back(part.name);
      return names;
    }
    /// Numbers to which all processes that share a body contribute.
    struct SharedNumbers
    {
      explicit SharedNumbers(const Problem &problem) : SharedNumbers(problem, peak_memory_mib()) {}

      SharedNumbers(const Problem &problem, const double peak)
          : exchange(problem.body.exchange()),
            n_nodes(exchange.n_nodes(problem.body.fe_space.n_nodes())),
            n_free(static_cast<unsigned int>(
                exchange.sum(static_cast<double>(problem.constraints.free_dofs.size())))),
            own_peak(peak), sum_of_peaks(exchange.sum(peak)),
            peaks(exchange.collect({ static_cast<std::size_t>(peak) })),
            conditioning(problem.conditioning()), parts(inventory(problem))
      {
      }

      const Exchange                  &exchange;
      const unsigned int               n_nodes, n_free;
      const double                     own_peak, sum_of_peaks; ///< memory [MiB]
      const std::vector<std::size_t>   peaks;                  ///< of each process
      const Conditioning               conditioning;
      const std::vector<PartOfProblem> parts;
    };

    void
    add_program(const Problem &problem, const SharedNumbers &numbers, Json &json)
    {
      const BlasInfo blas  = blas_info();
      json["program"]      = "exemplar";
      json["version"]      = EXEMPLAR_VERSION;
      json["git"]          = EXEMPLAR_GIT_REVISION;
      json["deal_ii"]      = DEAL_II_PACKAGE_VERSION;
      json["blas"]         = blas.library;
      json["blas_core"]    = blas.core;
      json["blas_threads"] = blas.threads;
      json["processes"]    = numbers.exchange.n_processes();
      json["threads"]      = problem.parameters.solver.n_threads;
    }

    void
    add_body(const Problem       &problem,
             const SharedNumbers &numbers,
             const std::string   &mesh_sha256,
             Json                &json)
    {
      const Body &body    = problem.body;
      json["scene"]       = printable(problem.parameters.name);
      json["mesh"]        = printable(body.mesh.get_name());
      json["mesh_sha256"] = mesh_sha256;
      json["cells"]       = body.mesh.whole().n_cells;
      json["element"]     = traits_of(body.fe_space.element()).name;
      json["nodes"]
          = numbers.n_nodes - (body.fe_space.is_shell() ? body.fe_space.shell().n_slopes() : 0);
      json["dofs"]             = 3 * numbers.n_nodes;
      json["constrained_dofs"] = 3 * numbers.n_nodes - numbers.n_free;
      if (problem.constraints.support)
        json["support_nodes"] = support_nodes(problem);
      if (problem.actions.body_contacts != nullptr)
        json["pairs_left_out"] = problem.actions.body_contacts->n_left_out;
      if (body.made != nullptr && !body.made->mesh.table.empty())
        json["mesh_made"] = mesh_made(body.made->mesh);
      if (body.made != nullptr && !body.made->poses.empty())
        json["poses_carried"] = poses_carried(body.made->poses);
      if (body.geo_walls)
        json["geo_confinement"] = *body.geo_walls;
    }

    /// Whole numbers, ascending, as text: "0-3 7 9-12".
    std::string
    ranges_of(const std::vector<unsigned int> &numbers)
    {
      std::string text;
      for (std::size_t i = 0, next = 0; i < numbers.size(); i = next)
      {
        for (next = i + 1; next < numbers.size() && numbers[next] == numbers[next - 1] + 1;)
          ++next;
        text += (i > 0 ? " " : "") + std::to_string(numbers[i]);
        text += next - i > 1 ? "-" + std::to_string(numbers[next - 1]) : "";
      }
      return text;
    }

    /// Names of handles and examples, and numbers of held nodes in frames, for pages that show the
    /// run.
    void
    add_names(const Problem &problem, Json &json)
    {
      const ExamplePoses &poses = problem.examples.poses;
      // numbers of weights are indices of this list: keys are added to the rest pose, their 0
      if (problem.examples.weights.are_additive())
        json["example_names"].push_back("rest pose");
      for (unsigned int i = 0; i < poses.size(); ++i)
        json["example_names"].push_back(printable(short_name_of_pose(poses, i)));
      if (problem.body.exchange().n_processes() > 1)
        return; // each has its own part of the nodes
      const Handles    &handles = problem.constraints.handles;
      const std::size_t n_of_scene
          = std::min<std::size_t>(problem.parameters.handles.size(), handles.size());
      for (unsigned int handle = 0; handle < n_of_scene; ++handle) // without handles of a session
        json["handles"].push_back({ { "name", printable(handles.name(handle)) },
                                    { "nodes", ranges_of(handles.nodes(handle)) } });
    }

    /// The regions that were found, in the order of their numbers, which begin at 1.
    void
    add_weight_regions(const std::vector<WeightRegion> &regions, Json &json)
    {
      for (std::size_t i = 0; i < regions.size(); ++i)
      {
        const WeightRegion &region = regions[i];
        json["weight_regions"].push_back(
            { { "region", i + 1 },
              { "cells", region.n_cells },
              { "volume", region.volume },
              { "centre", { region.centre[0], region.centre[1], region.centre[2] } },
              { "example", printable(region.example) } });
      }
    }

    void
    add_memory(const Problem &problem, const SharedNumbers &numbers, Json &json)
    {
      json["peak_memory_mib"]              = numbers.own_peak;
      json["peak_memory_mib_of_processes"] = numbers.peaks;
      json["bytes_per_cell"]
          = std::round(1048576. * numbers.sum_of_peaks / problem.body.mesh.whole().n_cells);
      json["memory_mib"] = memory_of(numbers.parts);
    }
  } // namespace

  void
  write_summary(Problem                        &problem,
                const RunTotals                &totals,
                const LastEstimates            &last,
                const std::string              &mesh_sha256,
                const std::string              &status,
                const std::vector<std::string> &warnings,
                const std::filesystem::path    &file)
  {
    const SharedNumbers numbers(problem);
    at_root(numbers.exchange,
            [&]
            {
              Json json;
              add_program(problem, numbers, json);
              add_body(problem, numbers, mesh_sha256, json);
              add_names(problem, json);
              add_weight_regions(problem.body.weight_regions, json);
              json["linear_solver"]  = problem.system.bordered().traits().name;
              json["examples"]       = problem.examples.poses.size();
              json["steps"]          = problem.state.step;
              json["iterations"]     = totals.iterations;
              json["factorizations"] = totals.factorizations;
              json["status"]         = status;
              json["warnings"]       = warnings_of(warnings);
              json["worst_residual"] = totals.worst_residual;
              for (const ExampleStart &start : problem.examples.starts)
                json["starts"].push_back({ { "from", printable(start.from) },
                                           { "status", status_name(start.status) },
                                           { "energy", start.energy },
                                           { "kept", start.is_kept } });
              if (last.space_error)
                json["space_error"] = errors_of(*last.space_error);
              if (last.functional)
                json["functional"] = functional_of(*last.functional);
              for (const SceneEdit &edit : totals.edits)
                json["edits"].push_back({ { "step", edit.step }, { "scene_before", edit.before } });
              if (numbers.conditioning.matrix > 0.)
                json["condition_matrix"] = numbers.conditioning.matrix; // null: not definite
              if (numbers.conditioning.schur > 0.)
                json["condition_schur"] = numbers.conditioning.schur;
              json["seconds"] = seconds_of(totals.seconds);
              add_memory(problem, numbers, json);
              json["used"]     = names_of(numbers.parts, true);
              json["left_out"] = names_of(numbers.parts, false);

              AtomicFile atomic_file(file);
              atomic_file.stream()
                  << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
              atomic_file.commit();
            });
  }
} // namespace Exemplar
