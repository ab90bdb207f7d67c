// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/words.h>
#include <exemplar/mesh/geo_script.h>

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <set>

// Language: https://gmsh.info/doc/texinfo/gmsh.html, "Gmsh scripting language".

// Language: https://gmsh.info/doc/texinfo/gmsh.html, "Gmsh scripting language".

namespace Exemplar
{
  namespace
  {
    using WordSet = std::set<std::string>;
    using Kind    = GeoToken::Kind;

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
      Tokenizer(const std::string &text, const GeoOrigin &origin) : text(text), origin(origin) {}

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
          ++origin.line;
        const auto byte = static_cast<unsigned char>(c);
        if (std::iscntrl(byte) != 0 && std::isspace(byte) == 0)
          refuse_geo(origin, "it holds a control character");
        if (c == '/' && (peek(1) == '/' || peek(1) == '*'))
          skip_comment(peek(1) == '*');
        else if (c == '"' || c == '\'')
          read_string(c);
        else if (is_letter(c))
          add(Kind::word, end_of([](const char d) { return is_letter(d) || is_digit(d); }));
        else if (is_digit(c) || (c == '.' && is_digit(peek(1))))
          add(Kind::number, end_of_number());
        else if (std::isspace(byte) != 0)
          skip_to(at + 1);
        else
          add(Kind::sign, at + 1);
      }

      /// End of the characters for which `belongs` is true.
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
        tokens.push_back({ kind, text.substr(at, end - at), origin, after_gap });
        at        = end;
        after_gap = false;
      }

      /// Skip blanks and comments.
      void
      skip_to(const std::size_t end)
      {
        at        = end;
        after_gap = true;
      }

      std::size_t
      end_of_number() const
      {
        const auto digits_from = [this](std::size_t end)
        {
          while (end < text.size() && is_digit(text[end]))
            ++end;
          return end;
        };
        const std::size_t end = end_of([](const char c) { return is_digit(c) || c == '.'; });
        if (end == text.size() || std::tolower(text[end]) != 'e')
          return end;
        const bool has_sign
            = end + 1 < text.size() && (text[end + 1] == '+' || text[end + 1] == '-');
        const std::size_t exponent = end + (has_sign ? 2 : 1);
        return digits_from(exponent) > exponent ? digits_from(exponent) : end;
      }

      void
      skip_comment(const bool is_block)
      {
        const std::size_t found
            = is_block ? text.find("*/", at + 2) : text.find_first_of("\r\n", at);
        if (is_block && found == std::string::npos)
          refuse_geo(origin, "a comment begins here and does not end");
        const std::size_t end = std::min(found, text.size()) + (is_block ? 2 : 0);
        origin.line += static_cast<unsigned int>(
            std::count(text.begin() + static_cast<std::ptrdiff_t>(at),
                       text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
        skip_to(end);
      }

      void
      read_string(const char quote)
      {
        const std::size_t end = text.find_first_of(std::string("\r\n") + quote, at + 1);
        if (end == std::string::npos || text[end] != quote)
          refuse_geo(origin, "a string begins here and does not end on this line");
        if (end - at > 1000)
          refuse_geo(origin, "a string is longer than the 1023 bytes that gmsh reads");
        // gmsh looks for these words in strings, too, where it skips a part
        const std::string inside = text.substr(at + 1, end - at - 1);
        for (const GeoToken &token : Tokenizer(without_quotes(inside), origin).read())
          if (WordSet{ "EndIf", "EndFor", "Else", "ElseIf", "Return" }.count(token.text) > 0)
            refuse_geo(origin, "a string holds the word " + token.text
                                   + ", behind which gmsh may read commands");
        add(Kind::text, end + 1);
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
      GeoOrigin             origin; ///< origin of the next token
      std::size_t           at        = 0;
      bool                  after_gap = true;
      std::vector<GeoToken> tokens;
    };

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

  void
  refuse_geo(const GeoOrigin &origin, const std::string &what)
  {
    throw UserError(fmt::format("{}:{}: {}. A mesh that somebody else made may not run programs or "
                                "write files. If you trust it, give --allow-commands, or mesh it "
                                "yourself (gmsh -3 FILE) and set Mesh/File to the .msh.",
                                *origin.file, origin.line, what));
  }

  std::vector<GeoToken>
  tokens_of_geo(const std::string &text, const std::string &name)
  {
    return Tokenizer(text, { std::make_shared<const std::string>(name), 1 }).read();
  }

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
