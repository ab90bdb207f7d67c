// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/descriptor.h>
#include <exemplar/base/digest.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/missing_file.h>
#include <exemplar/mesh/geo_script.h>
#include <exemplar/mesh/geo_text.h>

#include <fmt/core.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <set>
#include <utility>

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    /// First bytes of the formats, without white space before them: with any, gmsh would take a
    /// .msh or .pos for a script.
    constexpr std::array<std::pair<const char *, const char *>, 10> beginnings{
      { { "ISO-10303-21;", ".step" },
        { "DBRep_DrawableShape", ".brep" },
        { "CASCADE Topology V", ".brep" },
        { "$MeshFormat", ".msh" },
        { "MeshVersionFormatted", ".mesh" },
        { "ply\n", ".ply" },
        { "ply\r", ".ply" },
        { "# vtk DataFile", ".vtk" },
        { "#VRML", ".wrl" },
        { "$PostFormat", ".pos" } }
    };

    bool
    begins_with(const std::string &bytes, const std::size_t at, const std::string &text)
    {
      return bytes.compare(at, text.size(), text) == 0;
    }

    /// Whether bytes are an STL: "solid" and soon a facet, or as many triangles as the header says.
    bool
    is_stl(const std::string &bytes)
    {
      constexpr std::size_t head = 84, triangle = 50;
      if (begins_with(bytes, 0, "solid")
          && bytes.substr(0, 1000).find("facet") != std::string::npos)
        return true;
      if (bytes.size() < head)
        return false;
      std::uint32_t n_triangles;
      std::memcpy(&n_triangles, bytes.data() + head - sizeof(n_triangles), sizeof(n_triangles));
      return bytes.size() == head + triangle * std::size_t(n_triangles);
    }

    /// Whether bytes are an IGES: columns 73 to 80 of the first line name the first line of the
    /// start section.
    bool
    is_iges(const std::string &bytes)
    {
      return bytes.size() > 80 && bytes[72] == 'S' && bytes.find_first_of("\r\n") >= 80
             && (begins_with(bytes, 73, "      1") || begins_with(bytes, 73, "0000001"));
    }

    /// Limits of a text, far beyond any intended: inclusions may double it again and again.
    constexpr std::size_t max_inclusions = 10000, max_levels = 100, max_tokens = 20000000;

    /// Identity of a file, independent of the path to it.
    using FileIdentity = std::pair<dev_t, ino_t>;

    /// Reads each file once, so that all see the same bytes.
    class FilesRead
    {
    public:
      /// Throws std::runtime_error with the reason.
      FileIdentity
      read(const fs::path &path)
      {
        const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
        struct stat      status;
        if (file.number < 0 || fstat(file.number, &status) != 0)
          throw std::runtime_error(std::strerror(errno));
        if (!S_ISREG(status.st_mode))
          throw std::runtime_error(S_ISDIR(status.st_mode) ? "it is a directory"
                                                           : "it is a device");
        const FileIdentity identity(status.st_dev, status.st_ino);
        if (bytes.count(identity) == 0)
          bytes[identity] = all_of(file.number);
        return identity;
      }

      const std::string &
      bytes_of(const FileIdentity &file) const
      {
        return bytes.at(file);
      }

    private:
      static std::string
      all_of(const int descriptor)
      {
        std::string       all;
        std::vector<char> block(1 << 16);
        for (ssize_t n; (n = ::read(descriptor, block.data(), block.size())) != 0;)
          if (n > 0)
            all.append(block.data(), static_cast<std::size_t>(n));
          else if (errno != EINTR)
            throw std::runtime_error("reading it fails");
        return all;
      }

      std::map<FileIdentity, std::string> bytes;
    };

    /// Assembles a script and all files that it takes in.
    class Assembly
    {
    public:
      void
      add_main(const fs::path &geo)
      {
        add_script(geo,
                   open_file(geo, "Mesh/File: ",
                             "Give a .msh or .geo file; relative names start from the .prm."),
                   {});
        add_options_of(geo, {});
      }

      std::vector<GeoToken>              script;
      std::map<std::string, std::string> data;

    private:
      /// The nested scripts being read.
      using Stack = std::set<FileIdentity>;

      void
      add_script(const fs::path &path, const FileIdentity &file, Stack within)
      {
        if (!within.insert(file).second || within.size() > max_levels)
          throw UserError(path.string()
                          + ": the file includes itself, in however many steps, or "
                            "inclusions are too deep.");
        const auto tokens = tokens_of_geo(files.bytes_of(file), path.string());
        for (std::size_t i = 0; i < tokens.size();)
          i = add_piece(tokens, i, path, within);
        if (script.size() > max_tokens)
          throw UserError(path.string() + ": with all that it includes, the script is too long.");
      }

      /// Add a piece of a script; returns where the next one begins.
      std::size_t
      add_piece(const std::vector<GeoToken> &tokens,
                const std::size_t            i,
                const fs::path              &path,
                const Stack                 &within)
      {
        const std::string &word = tokens[i].text;
        if (tokens[i].kind == GeoToken::Kind::word && is_geo_command(tokens, i))
        {
          if (word == "Include" || word == "Merge" || word == "MergeWithBoundingBox")
          {
            add_inclusion(tokens, i, path, within);
            return i + 3;
          }
          if (word == "ListFromFile" && geo_token(tokens, i + 2).kind == GeoToken::Kind::text
              && (geo_token(tokens, i + 3).text == ")" || geo_token(tokens, i + 3).text == "]"))
          {
            const FileIdentity file = open_named(tokens[i + 2], path);
            // a sign, not a word: what this one reads is known
            script.push_back({ GeoToken::Kind::sign, "ListFromFile", tokens[i].origin, true });
            script.push_back(tokens[i + 1]);
            add_name(tokens[i + 2], files.bytes_of(file), ".txt");
            return i + 3;
          }
        }
        script.push_back(tokens[i]);
        return i + 1;
      }

      void
      add_inclusion(const std::vector<GeoToken> &tokens,
                    const std::size_t            i,
                    const fs::path              &path,
                    const Stack                 &within)
      {
        const GeoToken &name = geo_token(tokens, i + 1);
        if (name.kind != GeoToken::Kind::text || geo_token(tokens, i + 2).text != ";")
          refuse_geo(tokens[i].origin, tokens[i].text
                                           + " takes a file whose name is not a plain text in "
                                             "quotes, so it is not known what it does");
        if (++n_inclusions > max_inclusions)
          refuse_geo(tokens[i].origin, "there are too many inclusions");
        const FileIdentity file     = open_named(name, path);
        const bool         is_merge = tokens[i].text != "Include";
        const std::string  format   = is_merge ? merged_format(files.bytes_of(file)) : "";
        if (format.empty())
          add_script(place_of(name, path), file, within);
        else
        {
          script.push_back(tokens[i]);
          add_name(name, files.bytes_of(file), format);
          script.push_back(tokens[i + 2]);
        }
        if (is_merge)
          add_options_of(place_of(name, path), within);
      }

      /// Add the options that gmsh takes from a file beside another one.
      void
      add_options_of(const fs::path &path, const Stack &within)
      {
        const fs::path options = path.string() + ".opt";
        if (fs::is_regular_file(options))
          add_script(options, open_file(options, "", ""), within);
      }

      static fs::path
      place_of(const GeoToken &name, const fs::path &path)
      {
        return path.parent_path() / name.text.substr(1, name.text.size() - 2);
      }

      FileIdentity
      open_named(const GeoToken &name, const fs::path &path)
      {
        return open_file(place_of(name, path),
                         fmt::format("{}:{}: ", *name.origin.file, name.origin.line),
                         "Names in a .geo are relative to it.");
      }

      FileIdentity
      open_file(const fs::path &path, const std::string &where, const std::string &remedy)
      {
        try
        {
          return files.read(path);
        }
        catch (const std::runtime_error &error)
        {
          throw UserError(where + path.string() + " cannot be opened (" + error.what() + "). "
                          + remedy + missing_file_remedy(path));
        }
      }

      /// Add the name of a copy instead of a file's own.
      void
      add_name(const GeoToken &name, const std::string &bytes, const std::string &extension)
      {
        const std::string copy = fmt::format("data_{}{}", data.size() + 1, extension);
        data[copy]             = bytes;
        script.push_back({ GeoToken::Kind::text, "\"" + copy + "\"", name.origin, true });
      }

      FilesRead   files;
      std::size_t n_inclusions = 0;
    };

    bool
    are_on_one_line(const GeoOrigin &a, const GeoOrigin &b)
    {
      return a.file == b.file && a.line == b.line;
    }

    /// Whether two tokens would merge without a blank.
    bool
    needs_gap(const GeoToken &before, const GeoToken &token)
    {
      return token.after_gap
             || (before.kind == GeoToken::Kind::number && token.kind != GeoToken::Kind::sign);
    }

    /// Write the script line by line, as gmsh's loops and macros jump to beginnings of lines.
    void
    write_script(const std::vector<GeoToken> &tokens, GeoText &text)
    {
      for (std::size_t i = 0; i < tokens.size(); ++i)
      {
        const bool begins_line = i == 0 || !are_on_one_line(tokens[i].origin, tokens[i - 1].origin);
        if (begins_line)
          text.origins.push_back(tokens[i].origin);
        if (i > 0 && (begins_line || needs_gap(tokens[i - 1], tokens[i])))
          text.script += begins_line ? '\n' : ' ';
        text.script += tokens[i].text;
      }
      text.script += '\n';
    }
  } // namespace

  std::string
  merged_format(const std::string &bytes)
  {
    if (is_stl(bytes))
      return ".stl";
    if (is_iges(bytes))
      return ".iges";
    if (begins_with(bytes, 0, "    -1\n") || begins_with(bytes, 0, "    -1\r\n"))
      return ".unv";
    for (const auto &[text, extension] : beginnings)
      if (begins_with(bytes, 0, text))
        return extension;
    return "";
  }

  std::string
  GeoText::digest() const
  {
    std::string all = sha256_of_text(script) + "\n";
    for (const auto &[name, bytes] : data)
      all += name + " " + sha256_of_text(bytes) + "\n";
    return sha256_of_text(all);
  }

  std::string
  GeoText::with_origins(const std::string &messages, const std::string &path) const
  {
    const std::string mark = "'" + path + "', line ";
    std::string       text;
    std::size_t       at = 0;
    for (std::size_t found; (found = messages.find(mark, at)) != std::string::npos;)
    {
      const std::size_t digits = found + mark.size();
      const std::size_t end
          = std::min(messages.find_first_not_of("0123456789", digits), messages.size());
      const auto line = std::strtoul(messages.c_str() + digits, nullptr, 10);
      text += messages.substr(at, found - at);
      if (line >= 1 && line <= origins.size())
        text += fmt::format("'{}', line {}", *origins[line - 1].file, origins[line - 1].line);
      else
        text += messages.substr(found, end - found);
      at = end;
    }
    return text + messages.substr(at);
  }

  GeoText
  make_geo_text(const fs::path &geo)
  {
    Assembly assembly;
    assembly.add_main(fs::absolute(geo));
    check_geo(assembly.script);
    GeoText text;
    text.data = std::move(assembly.data);
    write_script(assembly.script, text);
    return text;
  }
} // namespace Exemplar
