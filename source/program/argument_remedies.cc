// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/declared_options.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/mesh/mesh_file.h>
#include <exemplar/mesh/mesh_parameters.h>
#include <exemplar/program/argument_remedies.h>

#include <fmt/core.h>

#include <filesystem>

namespace Exemplar
{
  namespace
  {
    using Words = std::vector<std::string>;

    Words
    names_of_commands(const CLI::App &app)
    {
      Words names;
      for (const CLI::App *command : app.get_subcommands([](const CLI::App *) { return true; }))
        names.push_back(command->get_name());
      return names;
    }

    /// Usage line of a command.
    std::string
    usage(const std::string &command)
    {
      if (command == "mesh")
        return "exemplar mesh --surface FILE.obj --cells N --output FILE.msh";
      if (command == "pose")
        return "exemplar pose --mesh FILE.msh --rest FILE.obj --pose FILE.obj --output DIRECTORY";
      if (command == "study")
        return "exemplar study STUDY.prm";
      if (command == "export")
        return "exemplar export OUTPUT [OTHER_OUTPUT] [--html FILE.html], or exemplar export "
               "OUTPUT "
               "--gltf FILE.glb";
      if (command == "convert")
        return "exemplar convert IN.inp OUT.msh";
      return command.empty() ? "exemplar SCENE.prm" : "exemplar " + command;
    }

    /// The words of a command line, classified.
    struct Sorted
    {
      std::string command;              ///< empty: run of a scene
      Words       unknown;              ///< options that the command does not have
      Words       positional;           ///< words that belong to no option
      Words       options;              ///< known options
      bool        late_command = false; ///< the command is not the first word
      bool        split_set    = false; ///< a --set has no '=', as a blank has split it
    };

    bool
    is_option(const std::string &word)
    {
      return word.size() > 1 && word[0] == '-'
             && word.find_first_not_of("-+.0123456789eE") != std::string::npos;
    }

    const CLI::Option *
    find_option(const CLI::App &app, const std::string &name)
    {
      for (const CLI::Option *option : app.get_options())
        if (option->check_name(name))
          return option;
      return nullptr;
    }

    Sorted
    sorted(const CLI::App &app, const Words &words)
    {
      Sorted          result;
      const Words     commands = names_of_commands(app);
      const CLI::App *present  = &app;
      for (std::size_t i = 0; i < words.size(); ++i)
      {
        const std::string       &word   = words[i];
        const std::string        name   = word.substr(0, word.find('='));
        const CLI::Option *const option = is_option(word) ? find_option(*present, name) : nullptr;
        if (is_option(word) && option == nullptr)
        {
          result.unknown.push_back(name);
          while (i + 1 < words.size() && !is_option(words[i + 1]))
            ++i; // its values
        }
        else if (option != nullptr)
        {
          std::size_t n_values
              = name == word ? static_cast<std::size_t>(option->get_items_expected_max()) : 0;
          if (!option->get_allow_extra_args())
            n_values = std::min<std::size_t>(n_values, 1);
          for (; n_values > 0 && i + 1 < words.size() && !is_option(words[i + 1]); --n_values)
            ++i;
          result.split_set
              = result.split_set
                || (name == "--set"
                    && words[i].find('=', words[i] == word ? 6 : 0) == std::string::npos);
        }
        else if (result.command.empty() && std::count(commands.begin(), commands.end(), word) > 0)
        {
          result.command      = word;
          result.late_command = i > 0;
          present             = app.get_subcommand(word);
        }
        else
          result.positional.push_back(word);
      }
      result.options = declared_options(*present);
      return result;
    }

    /// What to do instead of giving a command an option of another command.
    struct Remedy
    {
      std::string command; ///< empty: run of a scene
      std::string option;
      std::string words;
    };

    const std::vector<Remedy> remedies = {
      { "study", "--set", "Keys of all runs stand in the study: set Base = Section/Key=value." },
      { "study", "--threads", "The study says it: set Threads = 2." },
      { "study", "--resume", "A study goes on by itself: give the same command without it." },
      { "verify", "--output", "It writes nothing but what it prints." },
      { "verify", "--case", "Names of cases stand alone: exemplar verify uniaxial patch." },
      { "mesh", "--scale", "Lengths are changed in the scene, by Mesh/Scale." },
      { "mesh", "--threads", "Cells are filled in by one thread." },
      { "pose", "--cells", "Cells are made before, by exemplar mesh --cells N." },
      { "export", "--output", "What is written is named by --html FILE.html or --gltf FILE.glb." },
      { "", "--session", "A recorded session is played by --set Session/File=FILE." },
      { "", "--record",
        "What is done by hand is recorded by exemplar live SCENE.prm --record DIRECTORY." },
      { "", "--mesh", "A scene's mesh is given by --set Mesh/File=FILE." },
      { "", "--surface", "A scene's surface is given by --set Mesh/File=FILE." },
      { "", "--cells", "The number of cells is given by --set Mesh/Cells=N." },
    };

    /// Remedy for an option, with {} replaced by the command's file; empty if there is none.
    std::string
    remedy_of(const std::string &option, const Sorted &line)
    {
      const std::string file
          = line.positional.empty() ? "STUDY.prm" : printable(line.positional[0]);
      for (const Remedy &remedy : remedies)
        if (remedy.command == line.command && remedy.option == option)
          return fmt::format(fmt::runtime(remedy.words), file);
      return "";
    }

    std::string
    unknown_option(const Sorted &line)
    {
      const std::string &unknown = line.unknown.front();
      const std::string  nearest = suggested_option(unknown, line.options);
      std::string        message = (line.command.empty() ? "A run" : "exemplar " + line.command)
                            + " has no option " + in_quotes(unknown) + ".";
      if (const std::string remedy = remedy_of(unknown, line); !remedy.empty())
        return message + " " + remedy;
      if (!nearest.empty())
        message += " Did you mean '" + nearest + "'?";
      else if (line.command.empty())
        message += " Values of a scene are given by --set Section/Key=value.";
      return message;
    }

    /// Message if the first word is neither a scene nor a command; empty otherwise.
    std::string
    unknown_command(const Sorted &line, const Words &commands)
    {
      const std::string first = line.positional.empty() ? "" : line.positional[0];
      std::error_code   ignored; // the name may be too long for a file
      if (!line.command.empty() || first.empty() || first.find('.') != std::string::npos
          || std::filesystem::exists(first, ignored))
        return "";
      const bool is_option = std::count(line.options.begin(), line.options.end(), "--" + first) > 0;
      const std::string nearest = is_option ? "--" + first : nearest_word(first, commands);
      return "There is no command " + in_quotes(first) + "."
             + (nearest.empty() ? " A scene is run without one: exemplar SCENE.prm."
                                : " Did you mean '" + nearest + "'?");
    }

    bool
    is_mesh_name(const std::filesystem::path &file)
    {
      const std::string extension = file.extension().string();
      return is_mesh_file(file) || extension == ".geo" || is_surface_file(file.string());
    }

    /// Message on a second word where one scene is expected.
    std::string
    second_scene(const Sorted &line)
    {
      const std::string &first = line.positional[0], &second = line.positional[1];
      if (line.split_set)
        return in_quotes(second)
               + " stands alone. A value with blanks needs quotes, and no blanks around the '=': "
                 "--set \"Section/Key=value\".";
      if (second.find('=') != std::string::npos)
        return in_quotes(second) + " stands alone. Values of a scene are given by --set \""
               + printable(second) + "\".";
      std::error_code ignored;
      if (std::filesystem::is_directory(second, ignored))
        return in_quotes(second)
               + " is a directory and stands alone. That of the results is given by --output \""
               + printable(second) + "\".";
      if (is_mesh_name(second))
        return in_quotes(second) + " is no scene. A scene's mesh is given by --set \"Mesh/File="
               + printable(second) + "\".";
      return "Two scenes are given, " + in_quotes(first) + " and " + in_quotes(second)
             + ". A run has one; exemplar study runs one with many settings.";
    }

    std::string
    wrong_word(const Sorted &line)
    {
      if (line.late_command)
        return "The command stands first, its options behind it: exemplar " + line.command + " ...";
      const std::string &word = line.positional.back();
      if (line.command.empty())
        return line.positional.size() > 1 ? second_scene(line) : "";
      if (line.command == "study")
        return line.positional.size() > 1
                   ? "Two studies are given; " + in_quotes(word) + " is one too many."
                   : "";
      if (line.command == "verify" || (line.command == "export" && line.positional.size() < 3))
        return "";
      if (line.command == "export")
        return "A page shows one run, or two side by side; " + in_quotes(word)
               + " is one too many.";
      if (line.command == "convert")
        return line.positional.size() > 2
                   ? "One mesh is read and one written; " + in_quotes(word) + " is one too many."
                   : "";
      return in_quotes(word) + " stands without an option. Write: " + usage(line.command) + "."
             + (line.command == "mesh" && is_surface_file(word)
                    ? " Poses of the surface are given by --poses."
                    : "");
    }

    /// CLI11's messages, rephrased where needed.
    std::string
    in_own_words(const CLI::ParseError &error, const Sorted &line)
    {
      const std::string what  = error.what();
      const std::string begin = "Could not convert: ";
      if (what.rfind(begin, 0) == 0)
        return what.substr(begin.size()) + " is not understood. A whole number is needed, with all "
               + "its digits and nothing else";
      if (what.rfind("--set: 1 required", 0) == 0)
        return "--set has nothing behind it. Write --set \"Section/Key=value\"";
      if (what.find("At Most 1 required") != std::string::npos)
        return what.substr(0, what.find(':')) + " is given twice. Give it once";
      if (dynamic_cast<const CLI::RequiredError *>(&error) != nullptr)
        return what + ": " + usage(line.command);
      return what;
    }
  } // namespace

  std::string
  message_of_arguments(const CLI::App &app, const CLI::ParseError &error, const Words &words)
  {
    const Sorted      line    = sorted(app, words);
    std::string       message = unknown_command(line, names_of_commands(app));
    const std::string help
        = "exemplar " + (line.command.empty() ? "" : line.command + " ") + "--help";
    if (message.empty() && !line.unknown.empty())
      message = unknown_option(line);
    else if (message.empty() && (line.late_command || !line.positional.empty()))
      message = wrong_word(line);
    if (message.empty())
      message = in_own_words(error, line) + ".";
    return message + " " + help + " lists what is allowed.";
  }

  void
  require_scene(const std::filesystem::path &file)
  {
    std::error_code ignored;
    const auto      is_there
        = [&](const std::filesystem::path &path) { return std::filesystem::exists(path, ignored); };
    if (!file.empty() && is_there(file / "parameters.prm"))
      throw UserError(file.string() + " is the directory of a run. Its scene is run by: exemplar "
                      + (file / "parameters.prm").string() + ".");
    if (!file.empty() && !file.has_extension() && !is_there(file)
        && !is_there(file.string() + ".prm"))
      throw UserError(
          in_quotes(file.string())
          + " is neither a scene nor a command. A scene is run by: exemplar "
            "SCENE.prm; exemplar --help lists commands and options."
          + (file.has_parent_path()
                 ? " A key is set by --set \"" + printable(file.string())
                       + "=value\"; --print-parameters stands alone and prints all keys."
                 : ""));
    if (is_mesh_name(file))
      throw UserError(file.string()
                      + " is a mesh or a surface, not a scene. Write a scene (.prm) "
                        "that names it, by 'set File = "
                      + file.filename().string() + "' in subsection Mesh, and run that.");
  }
} // namespace Exemplar
