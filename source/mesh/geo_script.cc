// SPDX-License-Identifier: GPL-3.0-or-later
// Language: https://gmsh.info/doc/texinfo/gmsh.html, "Gmsh scripting language".
#include <exemplar/base/digest.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/missing_file.h>
#include <exemplar/base/text_file.h>
#include <exemplar/mesh/geo_script.h>

#include <algorithm>
#include <cctype>
#include <set>

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    using WordSet = std::set<std::string>;
    using Kind    = GeoToken::Kind;

    /// Words that are refused wherever they stand.
    const WordSet refused_everywhere
        = { "ExternalProcess", "NonBlockingSystemCall", "OnelabRun", "S2N", "StringToName",
            "SystemCall" };

    /// Words that are refused as commands; variables and options may have these names.
    const WordSet refused_commands
        = { "CreateDir", "Open", "Plugin", "Print", "Save", "SendToServer", "System" };

    const WordSet inclusions = { "Include", "Merge", "MergeWithBoundingBox" };

    /// Words by which a script reads what is not known here.
    const WordSet readers = { "FileExists", "FileName", "GetEnv", "ListFromFile", "ShapeFromFile" };

    /// Formats that gmsh knows by the name and reads as data. Files of other names may be scripts.
    const WordSet data_formats
        = { ".brep", ".iges", ".igs", ".mesh", ".obj", ".off", ".ply", ".step",
            ".stl",  ".stp",  ".unv", ".vtk",  ".wrl", ".bdf", ".nas", ".p3d" };

    [[noreturn]] void
    refuse(const std::string &file, const unsigned int line, const std::string &what)
    {
      throw UserError(file + ":" + std::to_string(line) + ": " + what
                      + ". A mesh that somebody else made may not run programs or write files. If "
                        "you trust it, give --allow-commands, or mesh it yourself (gmsh -3 FILE) "
                        "and set Mesh/File to the .msh.");
    }

    std::string
    read_geo(const fs::path &file)
    {
      std::string reason;
      if (auto text = read_text_file(file, &reason))
        return *text;
      throw UserError("Mesh/File: " + file.string() + " cannot be opened (" + reason
                      + "). Give a .msh or .geo file; relative names start from the .prm."
                      + missing_file_remedy(file));
    }

    bool
    is_letter(const char c)
    {
      return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
    }

    bool
    is_digit(const char c)
    {
      return c >= '0' && c <= '9';
    }

    class Tokenizer
    {
    public:
      Tokenizer(const std::string &text, const std::string &name) : text(text), name(name) {}

      std::vector<GeoToken>
      read()
      {
        while (at < text.size())
          read_token();
        return std::move(tokens);
      }

    private:
      char
      peek(const std::size_t offset = 0) const
      {
        return at + offset < text.size() ? text[at + offset] : '\n';
      }

      void
      read_token()
      {
        const char c = peek();
        if (c == '\n' || (c == '\r' && peek(1) != '\n'))
          ++line;
        const auto byte = static_cast<unsigned char>(c);
        if (std::iscntrl(byte) != 0 && std::isspace(byte) == 0)
          refuse(name, line, "it holds a control character");
        if (c == '/' && (peek(1) == '/' || peek(1) == '*'))
          skip_comment(peek(1) == '*');
        else if (c == '"' || c == '\'')
          read_string(c);
        else if (is_letter(c))
          add(Kind::word, end_of([](const char d) { return is_letter(d) || is_digit(d); }));
        else if (is_digit(c) || (c == '.' && is_digit(peek(1))))
          skip_number();
        else if (std::isspace(byte) != 0)
          ++at;
        else
          add(Kind::sign, at + 1);
      }

      /// Where characters end for which `belongs` is true.
      template <typename Belongs>
      std::size_t
      end_of(const Belongs &belongs) const
      {
        std::size_t end = at;
        while (end < text.size() && belongs(text[end]))
          ++end;
        return end;
      }

      void
      add(const Kind kind, const std::size_t end)
      {
        tokens.push_back({ kind, text.substr(at, end - at), line });
        at = end;
      }

      void
      skip_number()
      {
        at = end_of([](const char c) { return is_digit(c) || c == '.'; });
        if (std::tolower(peek()) == 'e'
            && (is_digit(peek(1)) || ((peek(1) == '+' || peek(1) == '-') && is_digit(peek(2)))))
        {
          at += 2;
          at = end_of(is_digit);
        }
      }

      void
      skip_comment(const bool is_block)
      {
        const std::size_t found
            = is_block ? text.find("*/", at + 2) : text.find_first_of("\r\n", at);
        if (is_block && found == std::string::npos)
          refuse(name, line, "a comment begins here and does not end");
        const std::size_t end = std::min(found, text.size()) + (is_block ? 2 : 0);
        line += static_cast<unsigned int>(
            std::count(text.begin() + static_cast<std::ptrdiff_t>(at),
                       text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
        at = end;
      }

      void
      read_string(const char quote)
      {
        const std::size_t end = text.find_first_of(std::string("\r\n") + quote, at + 1);
        if (end == std::string::npos || text[end] != quote)
          refuse(name, line, "a string begins here and does not end on this line");
        ++at;
        if (end - at > 1000)
          refuse(name, line, "a string is longer than the 1023 bytes that gmsh reads");
        // where gmsh skips a part, it looks for these words in strings, too
        const std::string inside = text.substr(at, end - at);
        for (const GeoToken &token : Tokenizer(without_quotes(inside), name).read())
          if (WordSet{ "EndIf", "EndFor", "Else", "ElseIf", "Return" }.count(token.text) > 0)
            refuse(name, line,
                   "a string holds the word " + token.text
                       + ", behind which gmsh may read commands");
        add(Kind::text, end);
        ++at;
      }

      static std::string
      without_quotes(std::string inside)
      {
        for (char &c : inside)
          if (c == '"' || c == '\'' || c == '/')
            c = ' ';
        return inside;
      }

      const std::string    &text;
      const std::string    &name;
      std::size_t           at   = 0;
      unsigned int          line = 1;
      std::vector<GeoToken> tokens;
    };

    /// Checks a script and what it includes, each file once.
    class Checker
    {
    public:
      GeoInputs
      check(const fs::path &geo)
      {
        check_script(geo, read_geo(geo));
        return inputs;
      }

    private:
      void
      check_script(const fs::path &path, const std::string &text)
      {
        if (!seen.insert(path.lexically_normal()).second)
          return;
        inputs.digests += sha256_of_text(text) + "\n";
        file   = path;
        tokens = tokens_of_geo(text, path.string());
        std::vector<std::pair<fs::path, bool>> others; // and whether each is a script for sure
        for (std::size_t i = 0; i < tokens.size(); ++i)
          if (tokens[i].kind == Kind::word)
            check_word(i, others);
        // options that gmsh reads unasked
        others.emplace_back(path.string() + ".opt", true);
        for (const auto &[other, is_script] : others)
          check_other(other, is_script);
      }

      void
      check_other(const fs::path &path, const bool is_script)
      {
        if (!fs::is_regular_file(path))
          return; // gmsh will say so, if it is asked for
        if (!is_script && data_formats.count(path.extension().string()) > 0)
        {
          inputs.digests += sha256(path) + "\n";
          return check_other(path.string() + ".opt", true);
        }
        const std::string text = read_geo(path);
        if (!is_script && text.rfind("$MeshFormat", 0) == 0)
          inputs.digests += sha256_of_text(text) + "\n";
        else
          check_script(path, text);
      }

      const GeoToken &
      token(const std::size_t i) const
      {
        static const GeoToken end{ Kind::sign, "", 0 };
        return i < tokens.size() ? tokens[i] : end;
      }

      void
      check_word(const std::size_t i, std::vector<std::pair<fs::path, bool>> &others)
      {
        const std::string &word      = tokens[i].text;
        const GeoToken    &next      = token(i + 1);
        const bool         is_option = next.text == "." || (i > 0 && token(i - 1).text == ".");
        const bool         is_command
            = !is_option && (next.kind != Kind::sign || next.text == "(" || next.text == "[");
        const auto refuse_word
            = [&](const std::string &what) { refuse(file.string(), tokens[i].line, what); };
        if (refused_everywhere.count(word) > 0 || (refused_commands.count(word) > 0 && is_command))
          refuse_word("the command " + word + " runs a program or writes files");
        if (word == "Printf" && writes_to_file(i + 1))
          refuse_word("Printf writes to a file");
        if (word == "General" && next.text == "." && ends_with(token(i + 2).text, "FileName"))
          refuse_word("General." + token(i + 2).text + " names a file that gmsh may write");
        if (inclusions.count(word) > 0 && is_command)
        {
          if (next.kind != Kind::text || token(i + 2).text != ";")
            refuse_word(word
                        + " takes a file whose name is not a plain text in quotes, so it is "
                          "not known what it does");
          others.emplace_back(file.parent_path() / next.text, word == "Include");
        }
        inputs.all_known = inputs.all_known && readers.count(word) == 0;
      }

      /// Whether the brackets that open at a token are followed by a >.
      bool
      writes_to_file(std::size_t i) const
      {
        unsigned int depth = 0;
        for (; i < tokens.size(); ++i)
        {
          if (tokens[i].kind != Kind::sign)
            continue;
          depth += tokens[i].text == "(" || tokens[i].text == "[" ? 1 : 0;
          if ((tokens[i].text == ")" || tokens[i].text == "]") && --depth == 0)
            break;
          if (tokens[i].text == ";" || depth == 0)
            return true; // not as expected: it may be anything
        }
        return token(i + 1).text != ";";
      }

      static bool
      ends_with(const std::string &text, const std::string &end)
      {
        return text.size() >= end.size()
               && text.compare(text.size() - end.size(), end.size(), end) == 0;
      }

      GeoInputs             inputs;
      std::set<fs::path>    seen;
      fs::path              file;   ///< the one that is being checked
      std::vector<GeoToken> tokens; ///< its tokens
    };
  } // namespace

  std::vector<GeoToken>
  tokens_of_geo(const std::string &text, const std::string &name)
  {
    return Tokenizer(text, name).read();
  }

  GeoInputs
  check_geo(const fs::path &geo)
  {
    return Checker().check(fs::absolute(geo));
  }
} // namespace Exemplar
