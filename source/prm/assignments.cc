// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/missing_file.h>
#include <exemplar/base/text_file.h>
#include <exemplar/prm/assignments.h>

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <sstream>

// Parser of scene files, down to assignments.

namespace Exemplar
{
  namespace
  {
    /// The text with runs of blanks replaced by one.
    std::string
    single_blanks(const std::string &text)
    {
      std::istringstream words(text);
      std::string        result, word;
      while (words >> word)
        result += (result.empty() ? "" : " ") + word;
      return result;
    }

    /// Sentence on bytes that no value may contain; empty if there are none.
    std::string
    what_is_no_text(const std::string &text)
    {
      const std::size_t at = find_unprintable(text);
      return at == std::string::npos ? ""
                                     : in_quotes(text.substr(at, 1))
                                           + " is no text: a byte that is not UTF-8, or a control "
                                             "character. Remove it, "
                                             "or save the text as UTF-8.";
    }

    bool
    starts_with_word(const std::string &line, const std::string &word)
    {
      return line.compare(0, word.size(), word) == 0
             && (line.size() == word.size()
                 || std::isspace(static_cast<unsigned char>(line[word.size()])));
    }

    /// Remedy for a line that cannot be parsed: its likely meaning.
    std::string
    remedy_of_line(const std::string &line)
    {
      static const std::regex word("(set|subsection|end)\\b.*", std::regex::icase);
      static const std::regex comment("(//|;|%|--|/\\*).*");
      static const std::regex section("(?:section|\\[)\\s*(.+?)\\s*\\]?", std::regex::icase);
      static const std::regex brace("([^=:]+?)\\s*\\{");
      static const std::regex value("([^=:]+?)\\s*[:=]\\s*(.*)");
      static const std::regex python("(import|from|def|class|print)\\b.*");
      static const std::regex continued("[^=:]*[;,]|[-+.0-9(].*");
      std::smatch             parts;
      if (line.size() > 200) // not hand-written, too long for regular expressions
        return "";
      if (std::regex_match(line, parts, word))
        return parts[1] == "end" ? " Write 'end' alone."
                                 : " These words are written in small letters.";
      if (std::regex_match(line, comment))
        return " A comment begins with #.";
      if (line.rfind("exemplar session", 0) == 0)
        return " This is a recorded session, not a scene: run the scene.prm beside it, or let a "
               "scene play it by "
               "Session/File.";
      static const std::regex wavefront("(v|vn|vt|f|o|g|mtllib) .*");
      if (std::regex_match(line, parts, wavefront))
        return " This looks like a surface (.obj), not like a scene: a scene names it by Mesh/File.";
      if (line == "$MeshFormat")
        return " This is a mesh of gmsh, not a scene: a scene names it by Mesh/File.";
      if (line.find(',') != std::string::npos && line.find_first_of(" =;:(") == std::string::npos)
        return " This looks like a table (.csv), not like a scene or a study.";
      if (line[0] == '{' || line[0] == '<' || line[0] == '$')
        return " This looks like a file of another kind, not like a scene or a study.";
      if (std::regex_match(line, python) && line.find('{') == std::string::npos)
        return " This looks like a script of Python, not like a scene: run it by python3.";
      if (starts_with_word(line, "include"))
        return " Scenes do not include others: copy its lines, or give values by --set.";
      if (line == "}")
        return " A subsection is closed by a line 'end'.";
      if (std::regex_match(line, parts, section) || std::regex_match(line, parts, brace))
        return " Did you mean 'subsection " + parts.str(1) + "', closed by a line 'end'?";
      if (std::regex_match(line, parts, value))
        return " Did you mean 'set " + parts.str(1) + " = " + parts.str(2) + "'?";
      if (std::regex_match(line, continued))
        return " Where it continues the line before, that one must end in a backslash.";
      return "";
    }

    /// Reads the text of a .prm line by line and keeps track of the current subsection.
    class AssignmentReader
    {
    public:
      AssignmentReader(const std::string &file, const std::set<std::string> &sections)
          : file(file), sections(sections)
      {
      }

      std::vector<Assignment>
      read(const std::string &text)
      {
        const std::string  mark = "\xEF\xBB\xBF"; // byte-order mark of UTF-8
        std::istringstream in(text.compare(0, mark.size(), mark) == 0 ? text.substr(mark.size())
                                                                      : text);
        if (text.compare(0, 2, "\xFF\xFE") == 0 || text.compare(0, 2, "\xFE\xFF") == 0)
          throw UserError(file + ": the text is saved as UTF-16. Save it as UTF-8.");
        if (text.compare(0, 4, "PK\x03\x04") == 0 || text.compare(0, 2, "\x1F\x8B") == 0)
          throw UserError(file + ": is a packed file (zip or gzip), no text. Unpack it.");
        for (std::string line; std::getline(in, line);)
        {
          ++line_number;
          if (pending.empty())
            indentation = std::min(line.find_first_not_of(" \t"), line.size());
          line = trim(line.substr(0, line.find('#')));
          if (!line.empty() && line.back() == '\\')
            pending += line.substr(0, line.size() - 1) + " ";
          else
          {
            const std::string whole = trim(pending + line);
            pending.clear();
            if (!whole.empty())
              read_line(whole);
          }
        }
        if (!pending.empty())
          fail("the file ends in a backslash, which joins a line to the next. Remove it.");
        if (!subsections.empty())
          fail_unclosed();
        return std::move(assignments);
      }

    private:
      [[noreturn]] void
      fail(const std::string &what) const
      {
        throw UserError(place() + ": " + what);
      }

      std::string
      place() const
      {
        return fmt::format("{}:{}", file, line_number);
      }

      void
      read_line(const std::string &line)
      {
        if (const std::string what = what_is_no_text(line); !what.empty())
          fail(what);
        if (starts_with_word(line, "subsection"))
          begin_subsection(single_blanks(line.substr(10)));
        else if (line == "end")
          end_subsection();
        else if (starts_with_word(line, "set"))
          read_assignment(line.substr(3));
        else
          fail("'" + line
               + "' is not understood. A line is 'set KEY = VALUE', "
                 "'subsection NAME', 'end' or a comment starting with #."
               + remedy_of_line(line));
      }

      void
      begin_subsection(const std::string &name)
      {
        if (name.empty())
          fail("the subsection has no name. Write 'subsection NAME'.");
        if (name.find('/') != std::string::npos && name.compare(0, 7, "region ") != 0)
          fail("'" + name + "' is no name of a subsection. "
               + (open.empty()
                      ? "Write 'subsection " + name.substr(0, name.find('/'))
                            + "' and within it 'subsection " + name.substr(name.find('/') + 1)
                            + "', each closed by a line 'end'."
                      : "A name has letters, digits, blanks, - and _, but no /."));
        // without indentation, only names tell where a subsection lacks its end
        const bool is_outer = sections.count(name) > 0 || (!open.empty() && subsections[0] == name);
        if (!open.empty()
            && (indentation < open.back().indentation
                || (indentation == open.back().indentation && (indentation > 0 || is_outer))))
          suspect("subsection '" + name + "' begins");
        subsections.push_back(name);
        open.push_back({ line_number, indentation });
      }

      void
      end_subsection()
      {
        if (subsections.empty())
          fail("'end' without an open subsection. Remove the line.");
        if (indentation < open.back().indentation)
          suspect("an 'end' closes what stands further left");
        subsections.pop_back();
        open.pop_back();
      }

      /// Record that the innermost subsection should probably have been closed before this line.
      void
      suspect(const std::string &what)
      {
        if (!unclosed.empty())
          return;
        unclosed_line = open.back().line;
        unclosed = fmt::format("subsection '{}' is not closed before line {}, where {}. Write a "
                               "line 'end' before that line.",
                               subsections.back(), line_number, what);
      }

      [[noreturn]] void
      fail_unclosed()
      {
        line_number = unclosed.empty() ? open.back().line : unclosed_line;
        fail(unclosed.empty() ? "subsection '" + subsections.back()
                                    + "' is not closed before the file ends. Close it with a line "
                                      "'end'."
                              : unclosed);
      }

      void
      read_assignment(const std::string &text)
      {
        const auto equals = text.find('=');
        if (equals == std::string::npos)
          fail("'set" + text + "' has no '='. Write 'set KEY = VALUE'."
               + (text.find(':') == std::string::npos ? "" : " A ':' does not stand for '='."));
        Assignment assignment{ subsections, single_blanks(text.substr(0, equals)),
                               trim(text.substr(equals + 1)), place() };
        const auto [first, is_new] = places.emplace(assignment.path(), place());
        if (!is_new)
          fail(assignment.path() + " is set twice; first at " + first->second
               + ". Keep one of the two lines.");
        assignments.push_back(std::move(assignment));
      }

      /// The first line of an open subsection.
      struct Beginning
      {
        unsigned int line;
        std::size_t  indentation; ///< number of leading blanks
      };

      const std::string                  file;
      const std::set<std::string>        sections;
      unsigned int                       line_number = 0;
      std::size_t                        indentation = 0; ///< of the current line
      std::vector<Beginning>             open;            ///< of each of `subsections`
      std::string                        unclosed; ///< the first that seems to lack its end
      unsigned int                       unclosed_line = 0;
      std::string                        pending; ///< lines that ended in a backslash
      std::vector<std::string>           subsections;
      std::vector<Assignment>            assignments;
      std::map<std::string, std::string> places;
    };
  } // namespace

  std::string
  Assignment::path() const
  {
    std::string path;
    for (const std::string &subsection : subsections)
      path += subsection + "/";
    return path + key;
  }

  std::string
  read_prm(const std::filesystem::path &file)
  {
    std::string reason;
    if (auto text = read_text_file(file, &reason))
      return std::move(*text);
    throw UserError(file.string() + ": cannot be read (" + reason
                    + "). Give the name of an existing .prm file." + missing_file_remedy(file));
  }

  std::vector<Assignment>
  read_assignments(const std::string           &prm_text,
                   const std::string           &file,
                   const std::set<std::string> &sections)
  {
    return AssignmentReader(file, sections).read(prm_text);
  }

  Assignment
  parse_assignment(const std::string &text, const std::string &place)
  {
    if (const std::string what = what_is_no_text(text); !what.empty())
      throw UserError(place + " '" + text + "': " + what);
    const std::string remedy = " Write 'Section/Key=value'.";
    const auto        equals = text.find('=');
    if (equals == std::string::npos)
      throw UserError(place + " '" + text + "' has no '='." + remedy);
    std::vector<std::string> path = split_trimmed(text.substr(0, equals), '/');
    if (path.empty() || path.back().empty())
      throw UserError(place + " '" + text + "' names no key." + remedy);
    const std::string key = path.back();
    path.pop_back();
    return { path, key, trim(text.substr(equals + 1)), place };
  }

  Assignment
  parse_override(const std::string &text)
  {
    return parse_assignment(text, "--set");
  }

  const Assignment *
  find_assignment(const std::vector<Assignment> &assignments, const std::string &path)
  {
    const auto last = std::find_if(assignments.rbegin(), assignments.rend(),
                                   [&](const auto &a) { return a.path() == path; });
    return last == assignments.rend() ? nullptr : &*last;
  }

  bool
  is_study(const std::filesystem::path &file)
  try
  {
    return find_assignment(read_assignments(read_prm(file), file.string()), "Vary") != nullptr;
  }
  catch (const UserError &)
  {
    return false; // reported later by a reader that knows the sections
  }
} // namespace Exemplar
