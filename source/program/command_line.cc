// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/free_cores.h>
#include <exemplar/base/launcher.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/mpi_session.h>
#include <exemplar/base/program_server.h>
#include <exemplar/base/standard_streams.h>
#include <exemplar/base/version.h>
#include <exemplar/base/whole_program.h>
#include <exemplar/mesh/mesh_file.h>
#include <exemplar/mesh/mesh_parameters.h>
#include <exemplar/program/argument_remedies.h>
#include <exemplar/program/commands.h>
#include <exemplar/program/interrupt.h>
#include <exemplar/program/joint_run.h>
#include <exemplar/program/number_option.h>
#include <exemplar/program/run_program.h>
#include <exemplar/study/study.h>
#include <exemplar/study/study_file.h>
#include <exemplar/verification/verification.h>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

namespace Exemplar
{
  namespace
  {
    /// Replace this process by exemplar-live, the program next to this one, with the same
    /// arguments; returns only by UserError.
    [[noreturn]] void
    become_live_program(char *argv[])
    {
      std::error_code             ignored;
      const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", ignored);
      const std::string           program = (own.parent_path() / "exemplar-live").string();
      execv(program.c_str(), argv);
      throw UserError(program
                      + " cannot be started, which exemplar live needs: " + std::strerror(errno)
                      + ". " + build_whole_program + "; or install it whole.");
    }

    /// All arguments of the command line.
    struct Arguments
    {
      RunOptions  run;
      std::string output;
      bool        validate = false, print = false;

      StudyOptions study;
      bool         print_study = false;

      std::vector<std::string> cases;
      bool                     list_cases = false;

      MeshCommandOptions mesh;
      PoseOptions        pose;
      ExportOptions      exported;
      ConvertOptions     converted;
    };

    /// The last part of --help.
    std::string
    footer(const std::string &example)
    {
      return "Examples:\n  $ " + example + R"(

Exit status:
  0    done
  1    the input or the command line is wrong, and nothing is written; verify: a case failed
  2    a solver failed, or memory or disk ran out; what was computed is on disk
  130  stopped by a signal; what was computed is on disk, and --resume goes on)";
    }

    void
    add_threads_option(CLI::App &app, unsigned int &n_threads)
    {
      add_number_option(app, "--threads", n_threads, 1U, 1024U,
                        "threads instead of one a core (one in each of several processes); results "
                        "do not depend on it");
    }

    void
    declare_scene(CLI::App &app, Arguments &arguments)
    {
      app.add_option("SCENE", arguments.run.scene_file, "scene file (.prm)");
      app.add_option("--set", arguments.run.overrides,
                     "'Section/Key=value' instead of the scene's; once for each key")
          ->allow_extra_args(false)
          ->option_text("TEXT");
      app.add_option("--output", arguments.output,
                     "directory of the results instead of Output/Directory");
      app.add_flag("--resume", arguments.run.resume,
                   "go on from the checkpoint in the output directory");
      add_number_option(app, "--resume-from", arguments.run.resume_from, 0U, 1000000000U,
                        "go on from the state of this step, also with an edited scene",
                        "It is the number of a step, as in the column step of statistics.csv; "
                        "--output names the run's directory. ");
      add_threads_option(app, arguments.run.n_threads);
      app.add_flag("--allow-commands", arguments.run.allow_commands,
                   "let a .geo run programs and write files: only for one that you trust");
      app.add_flag("--quiet", arguments.run.quiet, "print warnings and errors only");
      app.add_flag("--verbose", arguments.run.verbose, "print a line an iteration");
      app.add_flag("--validate", arguments.validate,
                   "check the scene or study and its files, compute nothing");
      app.add_flag("--print-parameters", arguments.print,
                   "every parameter, its default, range and meaning");
    }

    /// Add a command with its own options and none of those of scenes.
    CLI::App &
    add_command(CLI::App          &app,
                const std::string &name,
                const std::string &description,
                const std::string &example)
    {
      CLI::App *command = app.add_subcommand(name, description);
      command->footer(footer("exemplar " + name + " " + example));
      for (CLI::Option *of_scenes : app.get_options())
        command->excludes(of_scenes);
      return *command;
    }

    CLI::App &
    declare_study(CLI::App &app, Arguments &arguments)
    {
      CLI::App &command
          = add_command(app, "study", "run a scene with many settings: error against run time",
                        "prm/studies/solver_tolerance.prm --output study");
      command.add_option("STUDY", arguments.study.file, "study file (.prm)");
      command.add_option("--output", arguments.study.output, "directory of the results");
      command.add_flag("--quiet", arguments.study.quiet, "print warnings and errors only");
      command.add_flag("--validate", arguments.validate,
                       "check the study, its scene and their files, compute nothing");
      command.add_flag("--print-parameters", arguments.print_study,
                       "every key of a study file, its default, range and meaning");
      return command;
    }

    CLI::App &
    declare_verify(CLI::App &app, Arguments &arguments)
    {
      CLI::App &command = add_command(
          app, "verify", "compute the reference cases and compare: pass or fail, a line a number",
          "uniaxial patch");
      command.add_option("NAME", arguments.cases, "cases to compute instead of all");
      command.add_flag("--list", arguments.list_cases,
                       "names, contents and sources of the cases; computes nothing");
      return command;
    }

    CLI::App &
    declare_mesh(CLI::App &app, Arguments &arguments)
    {
      CLI::App &command = add_command(app, "mesh", "fill a surface with tetrahedra",
                                      "--surface cow.obj --cells 5000 --output cow.msh");
      command
          .add_option("--surface", arguments.mesh.meshing.surface, "the surface (.obj .ply .stl)")
          ->required();
      add_number_option(command, "--cells", arguments.mesh.meshing.n_cells, min_n_cells,
                        max_n_cells, "how many tetrahedra, about");
      command.add_option("--output", arguments.mesh.output,
                         "the mesh (.msh); a table (.csv) beside");
      command.add_option("--list-faults", arguments.mesh.faults,
                         "write a table of all bad faces and vertices (.csv) instead of a mesh");
      command.add_flag("--repair", arguments.mesh.meshing.repair,
                       "mend holes, turned and intersecting faces; wrap what cannot be mended");
      command.add_option("--poses", arguments.mesh.meshing.poses,
                         "poses of the surface: sheets that cross at rest, as lips do, are kept "
                         "apart where they part in one");
      command.add_option("--materials", arguments.mesh.meshing.materials,
                         "points and the materials around them (.csv: x,y,z,id,name)");
      command.add_flag("--quiet", arguments.mesh.quiet, "print errors only");
      return command;
    }

    CLI::App &
    declare_pose(CLI::App &app, Arguments &arguments)
    {
      CLI::App &command = add_command(
          app, "pose", "carry poses of a surface onto its tetrahedra, as examples of scenes",
          "--mesh cow.msh --rest cow.obj --pose 'walk_*.obj' --output poses");
      PoseOptions &pose = arguments.pose;
      command.add_option("--mesh", pose.mesh, "tetrahedra inside the surface (.msh)")->required();
      command.add_option("--rest", pose.rest, "the surface at rest (.obj .ply .stl)")->required();
      command
          .add_option("--pose", pose.poses,
                      "its poses, in the same order of vertices; 'walk_*.obj' is a sequence")
          ->required();
      command.add_option("--output", pose.output, "directory of the results")->required();
      add_number_option(command, "--attach", pose.attach, 1e-3, 1e6,
                        "how strongly the surface holds, over the stiffness of the body")
          ->default_str(shortest_text(pose.attach));
      add_threads_option(command, pose.n_threads);
      command.add_flag("--quiet", pose.quiet, "print warnings and errors only");
      return command;
    }

    CLI::App &
    declare_export(CLI::App &app, Arguments &arguments)
    {
      CLI::App &command = add_command(
          app, "export", "write the frames of a finished run as a page of HTML, or as glTF",
          "output/cat --html cat.html");
      ExportOptions &exported = arguments.exported;
      command
          .add_option("OUTPUT", exported.runs,
                      "output directory of the run; of two runs: side by side in a page")
          ->required()
          ->expected(1, 2);
      command.add_option("--html", exported.html,
                         "the page to write; without it and --gltf a page beside the first run");
      command.add_option("--gltf", exported.gltf,
                         "the file to write (.glb): morph targets with keyed weights");
      add_number_option(command, "--shapes", exported.n_shapes, 0U, 1000U,
                        "targets of the glTF beside the examples, instead of as many as bring all "
                        "vertices within .5 % of the diagonal");
      command.add_flag("--normals", exported.with_normals,
                       "normals in the glTF, of all targets, too");
      return command;
    }

    CLI::App &
    declare_convert(CLI::App &app, Arguments &arguments)
    {
      CLI::App &command = add_command(app, "convert", "write a mesh in another format",
                                      "bracket.inp bracket.msh");
      command.add_option("IN", arguments.converted.input, "the mesh (" + mesh_extensions + ")")
          ->required();
      command
          .add_option("OUT", arguments.converted.output, "the file to write (.msh .mesh .vtu .inp)")
          ->required();
      return command;
    }

    int
    do_verify(const Arguments &arguments)
    {
      int status = 0;
      if (arguments.list_cases)
        list_verification_cases(JointRun::group());
      else
        status = verify(arguments.cases, JointRun::group());
      require_printed();
      return status;
    }

    /// Make a study whose runs are forked copies of this process, which has not started any library
    /// yet. Under mpirun there are no copies, which it would take for its own processes.
    void
    make_study(StudyOptions options)
    {
      if (!find_launch().program.empty())
        return run_study(options);
      ProgramServer server(
          [](const int argc, char *argv[])
          {
            const MpiSession mpi; // a copy does not reach the end of main()'s
            return run_program(argc, argv);
          });
      options.run_program
          = [&](const std::vector<std::string> &command, const std::filesystem::path &log,
                const double timeout, const std::function<bool()> &stop)
      { return server.run(command, log, timeout, stop); };
      run_study(options);
    }

    void
    do_study(const Arguments &arguments)
    {
      if (arguments.validate)
        return validate_study(arguments.study.file);
      if (!arguments.print_study)
        return make_study(arguments.study);
      print_study_parameters();
      require_printed();
    }

    /// Throws UserError for commands that several processes cannot execute together.
    void
    refuse_processes(const std::string &command)
    {
      if (JointRun::group().n_processes > 1)
        throw UserError(command + " cannot be done by several processes. Call it without mpirun.");
    }

    void
    do_scene(const Arguments &arguments)
    {
      const auto &file = arguments.run.scene_file;
      require_scene(file);
      if (arguments.print)
      {
        print_parameters();
        require_printed();
      }
      else if (is_study(file))
      {
        if (!arguments.validate)
          throw UserError(file.string() + " is a study. Run it by: exemplar study "
                          + file.string());
        validate_study(file);
      }
      else if (arguments.validate)
        validate_scene(arguments.run);
      else
        run_scene(arguments.run);
    }
  } // namespace

  int
  run_command_line(const int argc, char *argv[])
  {
    if (argc > 1 && std::string(argv[1]) == "live")
      become_live_program(argv);
    Arguments arguments;
    // each of several processes uses one core
    arguments.run.n_threads  = JointRun::group().n_processes > 1 ? 1 : n_free_cores();
    arguments.pose.n_threads = arguments.run.n_threads;
    arguments.study.stop     = is_interrupted;
    CLI::App app("Elastic solids that deform the way their examples say", "exemplar");
    app.set_version_flag("--version", "exemplar " EXEMPLAR_VERSION " (" EXEMPLAR_GIT_REVISION
                                      ")" EXEMPLAR_LEFT_OUT);
    app.footer(footer("exemplar bar.prm --set Examples/Importance=0 --output plain"));
    app.require_subcommand(0, 1);
    declare_scene(app, arguments);
    const CLI::App &study_command   = declare_study(app, arguments);
    const CLI::App &verify_command  = declare_verify(app, arguments);
    const CLI::App &mesh_command    = declare_mesh(app, arguments);
    const CLI::App &pose_command    = declare_pose(app, arguments);
    const CLI::App &export_command  = declare_export(app, arguments);
    const CLI::App &convert_command = declare_convert(app, arguments);
    app.add_subcommand("live", "pull the body of a scene with the mouse, in a browser");
    try
    {
      app.parse(argc, argv);
      const bool is_scene = app.get_subcommands().empty();
      if (is_scene && !arguments.print && arguments.run.scene_file.empty())
        throw CLI::RequiredError("SCENE");
      if (mesh_command && mesh_command.count("--list-faults") == 0)
        for (const std::string option : { "--cells", "--output" })
          if (mesh_command.count(option) == 0)
            throw CLI::RequiredError(option);
      if (study_command && !arguments.print_study && arguments.study.file.empty())
        throw CLI::RequiredError("STUDY");
    }
    catch (const CLI::Success &request) // --help or --version
    {
      const ProcessGroup &group = JointRun::group();
      return app.exit(request, group.of_root(std::cout), group.of_root(std::cerr));
    }
    catch (const CLI::ParseError &error)
    {
      throw UserError(message_of_arguments(app, error, { argv + 1, argv + argc }));
    }
    for (const CLI::App *command :
         { &study_command, &mesh_command, &pose_command, &export_command, &convert_command })
      if (*command)
        refuse_processes("exemplar " + command->get_name());
    if (arguments.validate || arguments.print)
      refuse_processes(arguments.validate ? "--validate" : "--print-parameters");
    if (arguments.run.resume && arguments.run.resume_from)
      throw UserError("--resume goes on from the last checkpoint, --resume-from from the step that "
                      "it names: give one of them.");
    if (arguments.validate && (arguments.run.resume || arguments.run.resume_from))
      throw UserError(
          "--validate checks a scene from its beginning, and no checkpoint: leave out --resume.");
    if (arguments.run.quiet && arguments.run.verbose)
      throw UserError("--quiet prints less and --verbose prints more: give one of them.");
    if (arguments.output.empty() && app.get_option("--output")->count() > 0)
      throw UserError("--output is empty. Give the name of a directory; is a variable of the shell "
                      "not set?");
    if (!arguments.output.empty())
      arguments.run.overrides.push_back("Output/Directory=" + arguments.output);

    if (verify_command)
      return do_verify(arguments);
    if (study_command)
      do_study(arguments);
    else if (mesh_command)
      run_mesh_command(arguments.mesh);
    else if (pose_command)
      carry_poses(arguments.pose);
    else if (export_command)
      export_runs(arguments.exported);
    else if (convert_command)
      convert_mesh(arguments.converted);
    else
      do_scene(arguments);
    return 0;
  }
} // namespace Exemplar
