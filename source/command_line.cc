// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/command_line.h>
#include <exemplar/drivers.h>
#include <exemplar/environment.h>
#include <exemplar/errors.h>
#include <exemplar/study.h>
#include <exemplar/study_file.h>
#include <exemplar/verification.h>
#include <exemplar/version.h>

#include <CLI/CLI.hpp>

namespace Exemplar
{
  int
  run_command_line(const int argc, char *argv[])
  {
    RunOptions   options;
    std::string  output;
    bool         validate = false, print = false;
    unsigned int threads = n_threads();

    CLI::App app("exemplar: elastic solids that deform the way their examples say");
    app.set_version_flag("--version", "exemplar " EXEMPLAR_VERSION " (" EXEMPLAR_GIT_REVISION ")");
    app.add_option("SCENE", options.scene_file, "scene file (.prm)");
    app.add_option("--set", options.overrides,
                   "'Section/Key=value' instead of the scene's; repeatable")
        ->allow_extra_args(false);
    app.add_option("--output", output, "directory of the results instead of Output/Directory");
    app.add_flag("--resume", options.resume, "go on from the checkpoint in the output directory");
    app.add_option("--threads", threads,
                   "threads instead of one a core; results do not depend on it")
        ->check(CLI::Range(1, 1024));
    app.add_flag("--quiet", options.quiet, "print warnings and errors only");
    app.add_flag("--verbose", options.verbose, "print a line an iteration");
    app.add_flag("--validate", validate, "check the scene or study and its files, compute nothing");
    app.add_flag("--print-parameters", print, "every parameter, its default, range and meaning");

    StudyOptions study;
    bool         print_study = false;
    CLI::App    *studying
        = app.add_subcommand("study", "run a scene with many settings: error against run time");
    for (CLI::Option *of_scenes : app.get_options())
      studying->excludes(of_scenes);
    studying->add_option("STUDY", study.file, "study file (.prm)");
    studying->add_option("--output", study.output, "directory of the results");
    studying->add_flag("--quiet", study.quiet, "print warnings and errors only");
    studying->add_flag("--print-parameters", print_study,
                       "every key of a study file, its default, range and meaning");

    std::vector<std::string> cases;
    bool                     list         = false;
    CLI::App                *verification = app.add_subcommand(
                       "verify", "compute the reference cases and compare: pass or fail, a line a number");
    for (CLI::Option *of_scenes : app.get_options())
      verification->excludes(of_scenes);
    verification->add_option("NAME", cases, "cases to compute instead of all");
    verification->add_flag("--list", list,
                           "names, contents and sources of the cases; computes nothing");
    try
    {
      app.parse(argc, argv);
      if (!print && !*verification && !*studying && options.scene_file.empty())
        throw CLI::RequiredError("SCENE");
      if (*studying && !print_study && study.file.empty())
        throw CLI::RequiredError("STUDY");
    }
    catch (const CLI::Success &request) // --help or --version
    {
      return app.exit(request);
    }
    catch (const CLI::ParseError &error)
    {
      throw UserError(std::string(error.what()) + ". exemplar --help lists what is allowed.");
    }
    set_n_threads(threads);
    if (!output.empty())
      options.overrides.push_back("Output/Directory=" + output);

    if (*verification)
    {
      if (!list)
        return verify(cases);
      list_verification_cases();
    }
    else if (*studying)
      print_study ? print_study_parameters() : run_study(study);
    else if (print)
      print_parameters();
    else if (validate)
      is_study(options.scene_file) ? validate_study(options.scene_file) : validate_scene(options);
    else if (is_study(options.scene_file))
      throw UserError(options.scene_file.string() + " is a study. Run it by: exemplar study "
                      + options.scene_file.string());
    else
      run_scene(options);
    return 0;
  }
} // namespace Exemplar
