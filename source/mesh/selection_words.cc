// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/nearest_word.h>
#include <exemplar/mesh/selection.h>
#include <exemplar/mesh/selection_words.h>
#include <exemplar/prm/assignments.h>
#include <exemplar/prm/key_table.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <regex>
#include <sstream>

namespace Exemplar
{
  const std::string selection_forms = "box x0 y0 z0 x1 y1 z1 | sphere x y z r | boundary ID | "
                                      "region ID | set ID | nodes FILE | vertex N "
                                      "[within D] | group NAME | map FILE [above X]";

  namespace
  {
    /// The standard form of a selection with brackets, commas or capitals.
    std::string
    usual_form(const std::string &kind, std::string rest)
    {
      for (char &c : rest)
        if (std::string("(),;:={}[]").find(c) != std::string::npos)
          c = ' ';
      std::istringstream in(rest);
      std::string        text = kind;
      for (std::string word; in >> word;)
        text += " " + word;
      return text;
    }

    std::vector<double>
    parse_numbers(const std::string &text, bool &are_all)
    {
      std::istringstream  in(text);
      std::vector<double> values;
      for (double value; in >> value;)
        values.push_back(value);
      are_all = in.eof();
      return values;
    }

    /// Advice on n numbers written with commas; empty for other texts.
    std::string
    remedy_of_numbers(const SelectionWords &words, const unsigned int n)
    {
      static const std::regex decimal_comma("(\\d),(\\d)");
      bool                    are_all = false;
      for (const std::string &rest :
           { words.rest, std::regex_replace(words.rest, decimal_comma, "$1.$2") })
        if (const std::string text = usual_form("", rest);
            parse_numbers(text, are_all).size() == n && are_all)
          return " Did you mean '" + words.kind + text + "'?";
      return "";
    }

    /// The box equivalent to an inequality; empty for other texts.
    std::string
    box_of(const std::string &text)
    {
      static const std::regex inequality("([xyz]) *([<>])=? *([-+.0-9eE]+)");
      std::smatch             parts;
      if (text.size() > 100 || !std::regex_match(text, parts, inequality))
        return "";
      std::array<std::string, 6> box{ { "-1e9", "-1e9", "-1e9", "1e9", "1e9", "1e9" } };
      const auto                 c            = static_cast<std::size_t>(parts.str(1)[0] - 'x');
      box.at(parts.str(2) == "<" ? c + 3 : c) = parts.str(3);
      std::string selection                   = "box";
      for (const std::string &bound : box)
        selection += " " + bound;
      return selection;
    }
  } // namespace

  SelectionWords
  split_selection(const std::string &text)
  {
    std::istringstream in(text);
    SelectionWords     words;
    in >> words.kind >> std::ws;
    std::getline(in, words.rest);
    return words;
  }

  std::vector<double>
  selection_numbers(const SelectionWords &words, const unsigned int n, const std::string &key)
  {
    bool       are_all = false;
    const auto values  = parse_numbers(words.rest, are_all);
    if (words.rest.find('|') != std::string::npos)
      throw UserError(key + " = '" + words.kind + " " + words.rest
                      + "': there is one selection alone, and | joins none. Make a subsection of "
                        "its own for each.");
    if (!are_all || values.size() != n)
      throw UserError(fmt::format("{} = '{} {}': '{}' takes {} numbers, separated by "
                                  "blanks, with points as decimal signs.{} Allowed: {}.",
                                  key, words.kind, words.rest, words.kind, n,
                                  remedy_of_numbers(words, n), selection_forms));
    return values;
  }

  std::string
  remedy_of_selection(const SelectionWords &words)
  {
    const std::string text = words.kind + " " + words.rest;
    if (const std::string box = box_of(trim(text)); !box.empty())
      return " A part of space is selected by a box around it. Did you mean '" + box + "'?";
    if (text.find_first_not_of("0123456789 ,") == std::string::npos)
      return " Node numbers stand in a file: 'nodes FILE' names it.";
    const std::size_t n_letters = std::min(
        words.kind.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"),
        words.kind.size());
    const std::string letters = words.kind.substr(0, n_letters);
    if (letters == "x" || letters == "y" || letters == "z")
      return " A part of space is selected by a box around it.";
    for (const auto &[other, kind] : { std::pair("physical", "boundary"),
                                       { "surface", "boundary" },
                                       { "face", "boundary" },
                                       { "volume", "region" },
                                       { "material", "region" },
                                       { "node", "nodes" } })
      if (is_near(letters, other))
        return " Did you mean '" + usual_form(kind, text.substr(n_letters)) + "'?";
    const std::string kind = nearest_word(letters, { "box", "sphere", "boundary", "region", "set",
                                                     "nodes", "vertex", "group", "map" });
    return kind.empty() ? "" : " Did you mean '" + usual_form(kind, text.substr(n_letters)) + "'?";
  }

  void
  Selection::declare(KeyTable &keys, const std::string &what)
  {
    keys.add(
        "Select", text,
        what + ": " + selection_forms
            + ". Boxes (inclusive) and spheres select by rest position [m]; an ID is a number, "
              "or the name of a physical group of the mesh file; a FILE of nodes lists node "
              "numbers of the mesh file. The others select nodes of the boundary by Mesh/Surface: "
              "nearest to its vertices N, from 1 in its file's order, or no farther from them than "
              "D [m] along the surface; on its group NAME; where a painted map, FILE.ply:ATTRIBUTE "
              "or FILE.csv, is above X, or below X; without either above 0.5.",
        " ");
  }

  std::string
  Selection::absolute(const std::string &text, const std::filesystem::path &directory)
  {
    const SelectionWords words = split_selection(text);
    if ((words.kind != "nodes" && words.kind != "map") || directory.empty())
      return text;
    return words.kind + " "
           + std::filesystem::absolute(directory / words.rest).lexically_normal().string();
  }

  bool
  Selection::is_boundary() const
  {
    return split_selection(text).kind == "boundary";
  }

  bool
  Selection::is_of_space() const
  {
    const std::string kind = split_selection(text).kind;
    return kind == "box" || kind == "sphere";
  }

  bool
  Selection::is_of_surface() const
  {
    const std::string kind = split_selection(text).kind;
    return kind == "vertex" || kind == "group" || kind == "map";
  }

  std::string
  Selection::map() const
  {
    const SelectionWords words = split_selection(text);
    return words.kind == "map" ? words.rest : "";
  }

  std::string
  Selection::file() const
  {
    const SelectionWords words = split_selection(text);
    return words.kind == "nodes" ? words.rest : "";
  }
} // namespace Exemplar
