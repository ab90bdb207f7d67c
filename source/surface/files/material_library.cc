// SPDX-License-Identifier: GPL-3.0-or-later
// Format: Wavefront, "MTL material format", Advanced Visualizer manual, appendix B2.
#include <exemplar/base/number_text.h>
#include <exemplar/base/text_file.h>
#include <exemplar/base/words.h>
#include <exemplar/surface/files/material_library.h>

#include <algorithm>
#include <sstream>

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    /// A number from 0 to `most`; other words are 0.
    double
    number_up_to(const double most, const std::string &word)
    {
      const double number = parse_number(word);
      return std::isfinite(number) ? std::clamp(number, 0., most) : 0.;
    }

    std::array<double, 3>
    colour_in(std::istringstream &words, const std::array<double, 3> &otherwise)
    {
      std::array<std::string, 3> word;
      if (!(words >> word[0]) || !std::isfinite(parse_number(word[0])))
        return otherwise; // of a spectral file, for instance
      if (!(words >> word[1] >> word[2]))
        word[1] = word[2] = word[0];
      return { { number_up_to(1., word[0]), number_up_to(1., word[1]),
                 number_up_to(1., word[2]) } };
    }

    /// The file name of a map, which may hold blanks, behind its options.
    std::string
    name_of_map(std::string text)
    {
      const auto drop_word
          = [&] { text = trim(text.substr(std::min(text.find(' '), text.size()))); };
      text = trim(text);
      while (text.size() > 1 && text[0] == '-')
      {
        drop_word();
        for (std::string word = text.substr(0, text.find(' '));
             !word.empty() && (std::isfinite(parse_number(word)) || word == "on" || word == "off");
             word = text.substr(0, text.find(' ')))
          drop_word();
      }
      std::replace(text.begin(), text.end(), '\\', '/');
      return text;
    }

    void
    read_statement(const std::string &line, const fs::path &folder, SurfaceMaterial &material)
    {
      std::istringstream words(line);
      std::string        keyword, word;
      words >> keyword;
      if (keyword == "Kd")
        material.colour = colour_in(words, material.colour);
      else if (keyword == "Ke")
        material.emission = colour_in(words, material.emission);
      else if (keyword == "d" && words >> word)
        material.opacity = number_up_to(1., word);
      else if (keyword == "Tr" && words >> word)
        material.opacity = 1. - number_up_to(1., word);
      else if (keyword == "Ns" && words >> word)
        material.exponent = number_up_to(1000., word);
      else if (keyword == "map_Kd")
        if (const std::string name = name_of_map(line.substr(line.find("map_Kd") + 6));
            !name.empty())
          material.texture = folder / name;
    }

    void
    read_library(const fs::path &file, std::map<std::string, SurfaceMaterial> &materials)
    {
      std::istringstream lines(read_text_file(file).value_or(""));
      SurfaceMaterial   *current = nullptr;
      for (std::string line; std::getline(lines, line);)
      {
        line = trim(line);
        if (line.compare(0, 7, "newmtl ") == 0)
          current = &materials[trim(line.substr(7))];
        else if (current != nullptr)
          read_statement(line, file.parent_path(), *current);
      }
    }

    /// What stands behind the keyword of a statement; nothing for another keyword.
    std::optional<std::string>
    argument_of(const std::string &statement, const std::string &keyword)
    {
      if (statement.compare(0, keyword.size() + 1, keyword + ' ') != 0)
        return std::nullopt;
      return trim(statement.substr(keyword.size()));
    }
  } // namespace

  std::vector<std::string>
  material_names(const SurfaceMesh &surface)
  {
    std::vector<std::string> names(surface.faces.size());
    auto                     statement = surface.face_statements.begin();
    std::string              current;
    for (std::size_t face = 0; face < names.size(); ++face)
    {
      for (; statement != surface.face_statements.end() && statement->first <= face; ++statement)
        if (const auto name = argument_of(statement->second, "usemtl"))
          current = *name;
      names[face] = current;
    }
    return names;
  }

  MaterialLibraries
  read_material_libraries(const SurfaceMesh &surface, const std::vector<fs::path> &folders)
  {
    MaterialLibraries result;
    for (const auto &statement : surface.face_statements)
      if (const auto library = argument_of(statement.second, "mtllib"))
      {
        const auto folder = std::find_if(folders.begin(), folders.end(),
                                         [&](const fs::path &candidate)
                                         {
                                           std::error_code none;
                                           return fs::is_regular_file(candidate / *library, none);
                                         });
        if (folder != folders.end())
          read_library(*folder / *library, result.materials);
        else
          result.missing.push_back(*library);
      }
    return result;
  }
} // namespace Exemplar
