// SPDX-License-Identifier: GPL-3.0-or-later
// Language: https://gmsh.info/doc/texinfo/gmsh.html, "Gmsh scripting language".
#include <exemplar/base/words.h>
#include <exemplar/mesh/geo_script.h>

#include <set>

namespace Exemplar
{
  namespace
  {
    using Tokens = std::vector<GeoToken>;

    /// Words that are refused wherever they stand.
    const std::set<std::string> refused_everywhere
        = { "ExternalProcess", "NonBlockingSystemCall", "OnelabRun", "S2N", "StringToName",
            "SystemCall" };

    /// Words that are refused as commands; variables and options may have these names.
    const std::set<std::string> refused_commands
        = { "CreateDir", "Open", "Plugin", "Print", "Save", "SendToServer", "System" };

    /// Words by which a script reads data that gmsh is not given.
    const std::set<std::string> readers
        = { "FileExists", "FileName", "GetEnv", "ListFromFile", "ShapeFromFile" };

    /// Whether the brackets that open at a token are followed by a >.
    bool
    writes_to_file(const Tokens &script, std::size_t i)
    {
      unsigned int depth = 0;
      for (; i < script.size(); ++i)
      {
        const std::string &text = script[i].text;
        if (script[i].kind != GeoToken::Kind::sign)
          continue;
        depth += text == "(" || text == "[" ? 1 : 0;
        if ((text == ")" || text == "]") && --depth == 0)
          break;
        if (text == ";" || depth == 0)
          return true; // not as expected: it may be anything
      }
      return geo_token(script, i + 1).text != ";";
    }

    /// Why the word at a place is refused; empty if it is not.
    std::string
    why_refused(const Tokens &script, const std::size_t i)
    {
      const std::string &word       = script[i].text;
      const std::string &option     = geo_token(script, i + 2).text;
      const bool         has_option = geo_token(script, i + 1).text == ".";
      if (word == "Save" && is_geo_command(script, i))
        return "the command Save writes a file. A scene needs none: remove this line";
      if (refused_everywhere.count(word) > 0
          || (refused_commands.count(word) > 0 && is_geo_command(script, i)))
        return "the command " + word + " runs a program or writes files";
      if (word == "Printf" && writes_to_file(script, i + 1))
        return "Printf writes to a file";
      if (word == "General" && has_option && ends_with(option, "FileName"))
        return "General." + option + " names a file that gmsh may write";
      if (word == "Solver" && has_option)
        return "Solver." + option + " is an option of programs that gmsh may run";
      if (readers.count(word) > 0)
        return word + " reads what exemplar does not know";
      return "";
    }
  } // namespace

  const GeoToken &
  geo_token(const Tokens &script, const std::size_t place)
  {
    static const GeoToken end{ GeoToken::Kind::sign, "", {}, false };
    return place < script.size() ? script[place] : end;
  }

  bool
  is_geo_command(const Tokens &script, const std::size_t place)
  {
    const GeoToken &next = geo_token(script, place + 1);
    const bool      is_option
        = next.text == "." || (place > 0 && geo_token(script, place - 1).text == ".");
    return !is_option
           && (next.kind != GeoToken::Kind::sign || next.text == "(" || next.text == "[");
  }

  void
  check_geo(const Tokens &script)
  {
    for (std::size_t i = 0; i < script.size(); ++i)
      if (script[i].kind == GeoToken::Kind::word)
        if (const std::string why = why_refused(script, i); !why.empty())
          refuse_geo(script[i].origin, why);
  }
} // namespace Exemplar
