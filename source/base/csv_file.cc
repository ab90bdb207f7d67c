// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/csv_file.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/missing_file.h>
#include <exemplar/base/text_file.h>

#include <fmt/core.h>

#include <cstdlib>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    /// Spreadsheets separate cells by ; or tabs where the comma is the decimal sign.
    void
    require_commas(const CsvLine &first, const std::string &name)
    {
      for (const std::string &cell : first.cells)
        if (cell.find_first_of(";\t") < cell.size())
          throw UserError(fmt::format(
              "{}, line {}: the cells are separated by semicolons or tabs. Separate them by "
              "commas, and write numbers with a point.",
              name, first.number));
    }
  } // namespace

  std::vector<std::string>
  csv_cells(const std::string &line)
  {
    std::vector<std::string> cells(1);
    bool                     is_quoted = false;
    for (const char c : line)
      if (c == '"')
        is_quoted = !is_quoted;
      else if (c == ',' && !is_quoted)
        cells.emplace_back();
      else
        cells.back() += c;
    for (std::string &cell : cells)
    {
      const auto begin = cell.find_first_not_of(" \t\r"), end = cell.find_last_not_of(" \t\r");
      cell = begin < cell.size() ? cell.substr(begin, end - begin + 1) : "";
    }
    return cells;
  }

  bool
  is_number(const std::string &cell)
  {
    char *end = nullptr;
    std::strtod(cell.c_str(), &end);
    return !cell.empty() && end == cell.c_str() + cell.size();
  }

  std::vector<CsvLine>
  read_csv_file(const std::filesystem::path &file, const std::string &what)
  {
    const std::string name = file.string();
    std::string       reason;
    const auto        bytes = read_text_file(file, &reason);
    if (!bytes)
      throw UserError(name + ": cannot be opened (" + reason + "). Give the path of a " + what + "."
                      + missing_file_remedy(name));
    if (bytes->compare(0, 2, "\xFF\xFE") == 0 || bytes->compare(0, 2, "\xFE\xFF") == 0)
      throw UserError(name + ": the " + what + " is saved as UTF-16. Save it as UTF-8.");
    std::vector<CsvLine> lines;
    std::istringstream   in(*bytes);
    std::string          text;
    for (std::size_t number = 1; std::getline(in, text); ++number)
    {
      if (number == 1 && text.compare(0, 3, "\xEF\xBB\xBF") == 0)
        text.erase(0, 3); // byte order mark of UTF-8
      if (text.find_first_not_of(" \t\r") < text.size() && text[0] != '#')
        lines.push_back({ number, csv_cells(text) });
    }
    if (!lines.empty())
      require_commas(lines.front(), name);
    return lines;
  }
} // namespace Exemplar
