// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/declared_options.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/exemplar.h>
#include <exemplar/live/export_page.h>
#include <exemplar/live/server.h>
#include <exemplar/prm/assignments.h>

#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <deal.II/base/exceptions.h>
#include <deal.II/base/multithread_info.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <thread>
#include <unistd.h>

namespace Exemplar::Live
{
  namespace
  {
    /// Arguments of the command line.
    struct Arguments
    {
      std::string           record;
      std::optional<double> floor; ///< where it is along gravity's axis [m]
      std::string           up; ///< y or z, of scenes without gravity; empty: as the surface has it
      std::vector<std::string> shown, overrides, hosts; ///< shown: a scene, or outputs of runs
      ListenAt                 place;
      unsigned int             n_threads        = 1;
      bool                     until_input_ends = false;
    };

    /// The end of the text of --help.
    std::string
    footer(const std::string &example)
    {
      return "Examples:\n  $ exemplar " + example + R"(

Exit status:
  0    done
  1    the input or the command line is wrong, and nothing is written
  2    memory or disk ran out, or what a step needs; what was recorded is on disk
  130  stopped by a signal, as a server always is, or as --until-input-ends says)";
    }

    void
    declare_live(CLI::App &main, Arguments &arguments)
    {
      CLI::App &app
          = *main.add_subcommand("live", "pull the body of a scene with the mouse, in a browser");
      app.add_option("SCENE", arguments.shown,
                     "scene file (.prm), or one or two output directories of runs to play")
          ->required()
          ->expected(1, 2);
      app.add_option("--set", arguments.overrides,
                     "'Section/Key=value' instead of the scene's; repeatable")
          ->allow_extra_args(false);
      app.add_option("--port", arguments.place.port, "port; 0: one that is free")
          ->check(CLI::Range(0, 65535));
      app.add_option("--bind", arguments.place.address,
                     "address to listen at, or unix:PATH for a socket of the file system")
          ->capture_default_str();
      app.add_option("--allow-host", arguments.hosts, "name under which a proxy asks; repeatable")
          ->allow_extra_args(false);
      app.add_option("--record", arguments.record,
                     "directory in which the session is kept as a scene that plays it again");
      app.add_option(
          "--floor", arguments.floor,
          "a floor at this coordinate [m] along the axis of gravity, or that of --up; its "
          "friction is 0.5");
      app.add_option("--up", arguments.up,
                     "the axis that points up if there is no gravity: y (for what Blender has "
                     "written as .obj) or z "
                     "(for all else)")
          ->check(CLI::IsMember({ "y", "z" }));
      app.add_option("--threads", arguments.n_threads, "threads of the solver")
          ->check(CLI::Range(1, 1024))
          ->capture_default_str();
      app.add_flag("--until-input-ends", arguments.until_input_ends,
                   "end when standard input does, for programs that start a server");
      app.footer(footer("live prm/live/cat.prm --record session"));
    }

    /// Overrides, completed by defaults for keys that they do not have: a time step of 1/60 s,
    /// factorizations in the background, and a prediction for motions that are not smooth.
    std::vector<std::string>
    with_defaults(std::vector<std::string> overrides)
    {
      const auto given = overrides;
      for (const std::string setting :
           { "Time/Step=0.016666666666666666", "Solver/Background factor=true",
             "Solver/Prediction order=3" })
      {
        const std::string key = setting.substr(0, setting.find('=') + 1);
        if (std::none_of(given.begin(), given.end(),
                         [&](const std::string &other)
                         { return other.compare(0, key.size(), key) == 0; }))
          overrides.push_back(setting);
      }
      return overrides;
    }

    /// Overrides, and the scaled energy unless the scene or they choose one: with it a body that is dragged takes as
    /// much of a pose as the drag asks for, so that hands see the poses.
    std::vector<std::string>
    with_leading_examples(std::vector<std::string> overrides, const SceneFile &scene)
    {
      const std::string             key       = "Examples/Energy";
      const SceneParameters        &given     = scene.get_parameters();
      const std::string             begin     = key + "=";
      const std::vector<Assignment> in_file   = read_assignments(scene.get_text(), given.name);
      const bool                    is_chosen = find_assignment(in_file, key) != nullptr
                             || std::any_of(overrides.begin(), overrides.end(),
                                            [&](const std::string &other)
                                            { return other.compare(0, begin.size(), begin) == 0; });
      if (!is_chosen && given.examples.in_use() && given.examples.weights != WeightRule::prescribed)
        overrides.push_back(begin + name_of_energy(ExampleEnergy::scaled));
      return overrides;
    }

    /// The axis, counted from 0, that points up in a scene without gravity: Blender turns y up when it writes an .obj.
    unsigned int
    axis_of_up(const std::string &asked, const std::string &surface)
    {
      std::string   first;
      std::ifstream file(surface);
      std::getline(file, first);
      const bool is_of_blender = first.compare(0, 9, "# Blender") == 0;
      return asked == "y" || (asked.empty() && is_of_blender) ? 1 : 2;
    }

    /// Overrides, and what makes a floor at this coordinate among a scene's obstacles. Throws UserError if that is
    /// not finite, or one of them has its name.
    std::vector<std::string>
    with_floor(std::vector<std::string> overrides,
               const SceneFile         &scene,
               const double             place,
               const unsigned int       axis_without_gravity)
    {
      if (!std::isfinite(place))
        throw UserError("--floor takes a finite coordinate [m], as --floor 0.");
      const std::array<double, 3> &gravity = scene.get_parameters().loads.gravity;
      const auto                   steep   = std::max_element(gravity.begin(), gravity.end(),
                                                              [](const double a, const double b)
                                                              { return std::abs(a) < std::abs(b); });
      const std::size_t axis = *steep == 0. ? axis_without_gravity : steep - gravity.begin();
      std::string       names;
      for (const ObstacleParameters &obstacle : scene.get_parameters().obstacles.named)
      {
        if (obstacle.name == "floor")
          throw UserError(
              "--floor: the scene has an obstacle of this name already. Leave --floor out, or "
              "rename that in Obstacles/Names.");
        names += obstacle.name + ", ";
      }
      std::array<double, 3> point{}, normal{};
      point[axis]       = place;
      normal[axis]      = *steep > 0. ? -1. : 1.;
      std::string shape = "plane";
      for (const auto &numbers : { point, normal })
        for (const double number : numbers)
          shape += " " + shortest_text(number);
      overrides.push_back("Obstacles/Names=" + names + "floor");
      overrides.push_back("Obstacles/floor/Shape=" + shape);
      overrides.push_back("Obstacles/floor/Friction=0.5");
      return overrides;
    }

    /// Ends a server when standard input ends: when the program that started it closes it, or is
    /// gone.
    class InputWatch
    {
    public:
      explicit InputWatch(boost::asio::io_context &context)
          : context(context), input(context, dup(STDIN_FILENO))
      {
        read_next();
      }

    private:
      void
      read_next()
      {
        input.async_read_some(boost::asio::buffer(bytes),
                              [this](const boost::system::error_code error, std::size_t)
                              {
                                if (error)
                                  context.stop();
                                else
                                  read_next();
                              });
      }

      boost::asio::io_context              &context;
      boost::asio::posix::stream_descriptor input;
      std::array<char, 64>                  bytes{};
    };

    /// The solver's thread; an error that ends it ends the server, too.
    class SolverThread
    {
    public:
      SolverThread(Simulation &simulation, Mailbox &mailbox, boost::asio::io_context &context)
          : mailbox(mailbox), thread(
                                  [&simulation, &context, this]
                                  {
                                    try
                                    {
                                      simulation.run();
                                    }
                                    catch (...)
                                    {
                                      error = std::current_exception();
                                      context.stop();
                                    }
                                  })
      {
      }

      SolverThread(const SolverThread &) = delete;
      SolverThread &
      operator=(const SolverThread &)
          = delete;

      ~SolverThread()
      {
        end();
      }

      void
      end()
      {
        mailbox.stop();
        if (thread.joinable())
          thread.join();
      }

      void
      rethrow() const
      {
        if (error)
          std::rethrow_exception(error);
      }

    private:
      Mailbox           &mailbox;
      std::exception_ptr error;
      std::thread        thread;
    };

    /// Serves the player of finished runs. Returns the exit status after a signal.
    int
    serve_runs(const Arguments &arguments)
    {
      if (!arguments.overrides.empty() || !arguments.record.empty())
        throw UserError(arguments.shown.front()
                        + " is a directory, of which nothing can be set or recorded. Leave out "
                          "--set and --record, or give a scene (.prm).");
      const Access access(arguments.hosts, host_of(arguments.place));
      const Site   site(page_of_runs(arguments.shown).html);
      Mailbox      mailbox;
      ServerLog    log;
      Audience     audience(mailbox, log);
      Server       server(arguments.place, access, site, audience);
      std::cout << server.invitation() << std::endl;
      server.run();
      return 130;
    }

    /// Serves a simulation. Returns the exit status after a signal.
    int
    serve_scene(const Arguments &arguments)
    {
      if (arguments.shown.size() > 1)
        throw UserError("exemplar live takes one scene, or one or two output directories of runs.");
      std::vector<std::string> overrides = with_defaults(arguments.overrides);
      const SceneFile          given(arguments.shown.front(), overrides);
      const unsigned int       axis
          = axis_of_up(arguments.up, given.get_parameters().mesh.surface_file());
      overrides = with_leading_examples(std::move(overrides), given);
      if (arguments.floor)
        overrides = with_floor(overrides, given, *arguments.floor, axis);
      const SceneFile scene(arguments.shown.front(), overrides);
      const Access    access(arguments.hosts, host_of(arguments.place));
      Site            site;
      Stage           stage(scene, arguments.record, arguments.n_threads);
      Mailbox         mailbox;
      ServerLog       log;
      Audience        audience(mailbox, log);
      Server          server(arguments.place, access, site, audience);
      auto           &context = server.get_context();
      const Outbox    outbox  = {
            [&](Bytes frame)
            { boost::asio::post(context, [&audience, frame] { audience.show(frame); }); },
        [&](std::string text)
        { boost::asio::post(context, [&audience, text] { audience.tell(text); }); },
        [&](Welcome welcome)
        { boost::asio::post(context, [&audience, welcome] { audience.welcome_again(welcome); }); },
        [&](Welcome welcome, std::vector<Bytes> binaries)
        {
          boost::asio::post(context, [&audience, welcome, binaries]
                            { audience.show_obstacles(welcome, binaries); });
        }
      };
      Simulation simulation(stage, mailbox, outbox,
                            up_of(scene.get_parameters().loads.gravity, axis));
      audience.set_welcome(simulation.welcome());
      site.set_surface(simulation.drawn_surface());
      for (const std::string &warning : stage.get_problem().warnings())
        std::cerr << "Warning: " << warning << std::endl;
      if (const auto earlier = stage.begin(); !earlier.empty())
        std::cerr << "The earlier recording is played by " << message_text(earlier.string())
                  << " from now on." << std::endl;
      std::cout << server.invitation() << std::endl;
      std::optional<InputWatch> watch;
      if (arguments.until_input_ends)
        watch.emplace(context);
      SolverThread solver(simulation, mailbox, context);
      server.run();
      solver.end();
      solver.rethrow();
      return 130;
    }

    /// CLI11's message, with own words for unknown options; without the full stop.
    std::string
    in_own_words(const CLI::App &app, const CLI::ParseError &error)
    {
      const std::vector<std::string> unknown = app.remaining(true);
      if (unknown.empty())
        return error.what();
      const std::string option  = unknown.front().substr(0, unknown.front().find('='));
      const std::string message = in_quotes(option) + " is not understood by exemplar live";
      if (option == "--output" || option == "--session")
        return message
               + ". What is done is recorded by --record DIRECTORY, as a scene that exemplar runs";
      if (option == "--validate" || option == "--resume" || option == "--html")
        return message
               + ". Without the word live: exemplar SCENE.prm --validate or --resume; exemplar "
                 "export OUTPUT --html FILE.html";
      const std::string nearest
          = suggested_option(option, declared_options(*app.get_subcommand("live")));
      return nearest.empty() ? message : message + ". Did you mean '" + nearest + "'?";
    }

    int
    serve(const Arguments &arguments)
    {
      std::error_code none;
      const bool      is_run = std::filesystem::is_directory(arguments.shown.front(), none);
      return is_run ? serve_runs(arguments) : serve_scene(arguments);
    }
  } // namespace

  /// Returns the exit status.
  static int
  run_live(const int argc, char *argv[])
  {
    Arguments arguments;
    CLI::App  app("What exemplar shows in a browser", "exemplar");
    app.require_subcommand(1);
    declare_live(app, arguments);
    try
    {
      app.parse(argc, argv);
      return serve(arguments);
    }
    catch (const CLI::Success &request)
    {
      return app.exit(request);
    }
    catch (const CLI::ParseError &error)
    {
      std::cerr << "exemplar: " << in_own_words(app, error)
                << ". exemplar live --help lists the options." << std::endl;
      return 1;
    }
    catch (const UserError &error)
    {
      std::cerr << "exemplar: " << error.what() << std::endl;
      return 1;
    }
    catch (const std::filesystem::filesystem_error &error)
    {
      std::cerr << "exemplar: " << trouble_with_path(error) << "." << std::endl;
      return 2;
    }
    catch (const std::exception &error)
    {
      std::cerr << "exemplar: " << error.what() << std::endl;
      return 2;
    }
  }
} // namespace Exemplar::Live

int
main(int argc, char *argv[])
{
  Exemplar::restart_with_right_core_type(argv);
  Exemplar::use_one_blas_thread();
  dealii::MultithreadInfo::set_thread_limit(1);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  dealii::deal_II_exceptions::disable_abort_on_exception();
  const Exemplar::MpiSession mpi;
  return Exemplar::Live::run_live(argc, argv);
}
